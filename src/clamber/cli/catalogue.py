"""Names and titles of what `clamber list` shows."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Final

from ..extensions import outside_titles
from ..files import data_names, read_toml

PACKAGE: Final = Path(__file__).parents[1]
GROUND_SCHEMA: Final = "clamber-ground-1"


def _shipped(folder: str) -> list[tuple[str, str]]:
    """Name and title of the data files of a folder of the package."""
    data = PACKAGE / folder / "data"
    return _titled(data, data_names(data))


def _worlds(kind: str) -> list[tuple[str, str]]:
    """Those of one kind: boards, or grounds."""
    data = PACKAGE / "worlds" / "data"
    grounds = {name for name in data_names(data) if read_toml(data / f"{name}.toml").data["schema"] == GROUND_SCHEMA}
    return _titled(data, (name for name in data_names(data) if (name in grounds) == (kind == "grounds")))


def _titled(data: Path, names: Iterable[str]) -> list[tuple[str, str]]:
    return [(name, str(read_toml(data / f"{name}.toml").data.get("title", ""))) for name in names]


def _plans() -> list[tuple[str, str]]:
    data = PACKAGE / "actions" / "data"
    plans = {name: read_toml(data / f"{name}.toml").data for name in data_names(data)}
    return [(name, f"{said['n_steps']} actions for {said['task']}: {said['source']}") for name, said in plans.items()]


def _planners() -> list[tuple[str, str]]:
    from ..planning.planner_titles import PLANNER_TITLES

    return list(PLANNER_TITLES.items())


def _controllers() -> list[tuple[str, str]]:
    from ..control.law_titles import LAW_TITLES

    return list(LAW_TITLES.items())


def _checks() -> list[tuple[str, str]]:
    from ..families.climber.statics.checks import LIMBED_CHECKS
    from ..families.walker.statics.checks import WALKER_CHECKS

    return [(check.name, f"[{check.unit}] {check.meaning}") for check in (*LIMBED_CHECKS, *WALKER_CHECKS)]


def _plants() -> list[tuple[str, str]]:
    from ..sim.plant_titles import PLANT_TITLES

    return list(PLANT_TITLES.items())


def _studies() -> list[tuple[str, str]]:
    from ..studies.titles import RESULTS

    return [(paper, ", ".join(results)) for paper, results in RESULTS.items()]


ENTRIES: Final[dict[str, Callable[[], list[tuple[str, str]]]]] = {
    "robots": lambda: [*_shipped("robots"), *outside_titles("robots")],
    "boards": lambda: _worlds("boards"),
    "grounds": lambda: _worlds("grounds"),
    "tasks": lambda: _shipped("tasks"),
    "walks": lambda: _shipped("tasks/walks"),
    "plans": _plans,
    "planners": lambda: [*_planners(), *outside_titles("planners")],
    "checks": lambda: [*_checks(), *outside_titles("checks")],
    "controllers": lambda: [*_controllers(), *outside_titles("controllers")],
    "plants": lambda: [*_plants(), *outside_titles("plants")],
    "studies": _studies,
}


def entries(kind: str) -> list[tuple[str, str]]:
    """Name and title of everything of one kind."""
    return ENTRIES[kind]()
