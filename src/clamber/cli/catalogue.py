"""Names and titles of what `clamber list` shows."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Final

from ..files import data_names, read_toml


def _shipped(folder: str) -> list[tuple[str, str]]:
    """Name and title of the data files of a folder of the package."""
    from .. import robots, tasks

    data = {"robots": robots, "tasks": tasks}[folder].library.DATA
    return _titled(data, data_names(data))


def _worlds(kind: str) -> list[tuple[str, str]]:
    """Those of one kind: boards, or grounds."""
    from .. import worlds
    from ..worlds.library import DATA

    return _titled(DATA, worlds.ground_names() if kind == "grounds" else worlds.board_names())


def _walks() -> list[tuple[str, str]]:
    from ..tasks.walks.library import DATA, walk_names

    return _titled(DATA, walk_names())


def _titled(data: Path, names: Iterable[str]) -> list[tuple[str, str]]:
    return [(name, str(read_toml(data / f"{name}.toml").data.get("title", ""))) for name in names]


def _plans() -> list[tuple[str, str]]:
    from ..actions.plan_source import DATA, plan_names
    from ..actions.thesis_plan import load_thesis_plan

    plans = {name: load_thesis_plan(DATA / f"{name}.toml") for name in plan_names()}
    return [(name, f"{plan.n_steps} actions for {plan.task}: {plan.source}") for name, plan in plans.items()]


def _planners() -> list[tuple[str, str]]:
    from ..planning.planners import PLANNERS

    return [(name, _first_line(planner)) for name, planner in PLANNERS.items()]


def _controllers() -> list[tuple[str, str]]:
    from ..control.law_titles import LAW_TITLES

    return list(LAW_TITLES.items())


def _plants() -> list[tuple[str, str]]:
    from ..sim.plants import PLANTS

    return [(name, _first_line(plant)) for name, plant in PLANTS.items()]


def _studies() -> list[tuple[str, str]]:
    from ..studies.library import STUDIES

    return [(paper, ", ".join(results)) for paper, results in STUDIES.items()]


def _first_line(thing: object) -> str:
    return (thing.__doc__ or "").strip().partition("\n")[0]


ENTRIES: Final[dict[str, Callable[[], list[tuple[str, str]]]]] = {
    "robots": lambda: _shipped("robots"),
    "boards": lambda: _worlds("boards"),
    "grounds": lambda: _worlds("grounds"),
    "tasks": lambda: _shipped("tasks"),
    "walks": _walks,
    "plans": _plans,
    "planners": _planners,
    "controllers": _controllers,
    "plants": _plants,
    "studies": _studies,
}


def entries(kind: str) -> list[tuple[str, str]]:
    """Name and title of everything of one kind."""
    return ENTRIES[kind]()
