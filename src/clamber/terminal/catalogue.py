"""Names and titles of what `clamber list` shows."""

from collections.abc import Callable
from typing import Any, Final

from ..extensions import outside_titles
from ..family import BUILT_IN, family_named
from ..files import data_names, read_toml
from ..tasks.robots import shipped

PLANT_TITLES: Final[dict[str, str]] = {
    "mujoco": "A batch of equal limbs in MuJoCo, with the sensors and motors of `flaws`. A `Plant`.",
    "ode": "A batch of equal limbs by the ODE of `ode_steps`, with the sensors and motors of `flaws`. A `Plant`.",
}
"""Plant -> the first line of its docstring."""
LAW_TITLES: Final[dict[str, str]] = {
    "jacobian-transpose": "spring and damper at the tip, J^T F (Bevly 1997, 3.2)",
    "operational-space": "computed torque of the tip's motion (Khatib 1985; 3.13)",
    "resolved-rate": "joint speeds that the error asks for (Whitney 1969; 3.2.3)",
    "resolved-rate-plain": "joint speeds of the aim summed up, no error of the tip",
    "admittance": "a felt force moves the aim (Whitney 1977; 3.2.4)",
    "joint-pd": "each joint held at the angle of inverse kinematics",
    "scct": "simplified Cartesian computed torque, K' J^-1 F (3.16)",
    "implicit-admittance": "SCCT as a speed for a joint servo (3.25)",
    "hybrid": "force by J^T in some directions, SCCT in the others (3.5)",
    "implicit-force": "force by a place inside a surface of known stiffness (3.5)",
}
"""Law -> what it does, with where Bevly's thesis has it."""

BOARD_SCHEMA: Final = "clamber-board-1"
GROUND_SCHEMA: Final = "clamber-ground-1"
WORLD_SCHEMA: Final = "clamber-world-1"


def _documents(kind: str) -> dict[str, dict[str, Any]]:
    """Name -> document of the files of a kind that come with the families."""
    files = {name: data / f"{name}.toml" for data in shipped(kind) for name in data_names(data)}
    return {name: read_toml(files[name]).data for name in sorted(files)}


def _shipped(kind: str, schema: str | None = None) -> list[tuple[str, str]]:
    """Name and title of the files of a kind, and of one schema if it is named."""
    return [
        (name, str(said.get("title", "")))
        for name, said in _documents(kind).items()
        if schema in (None, said["schema"])
    ]


def _plans() -> list[tuple[str, str]]:
    return [
        (name, f"{said['n_steps']} actions for {said['task']}: {said['source']}")
        for name, said in _documents("plans").items()
    ]


def _planners() -> list[tuple[str, str]]:
    from ..planning.planners import PLANNERS

    return [(name, planner.title) for name, planner in PLANNERS.items()]


def _checks() -> list[tuple[str, str]]:
    checks = (check for family in BUILT_IN for check in family_named(family).checks)
    return [(check.name, f"[{check.unit}] {check.meaning}") for check in checks]


def _families() -> list[tuple[str, str]]:
    return [(name, family_named(name).title) for name in BUILT_IN]


ENTRIES: Final[dict[str, Callable[[], list[tuple[str, str]]]]] = {
    "families": lambda: [*_families(), *outside_titles("families")],
    "robots": lambda: [*_shipped("robots"), *outside_titles("robots")],
    "boards": lambda: _shipped("worlds", BOARD_SCHEMA),
    "grounds": lambda: _shipped("worlds", GROUND_SCHEMA),
    "worlds": lambda: _shipped("worlds", WORLD_SCHEMA),
    "tasks": lambda: _shipped("tasks"),
    "walks": lambda: _shipped("walks"),
    "plans": _plans,
    "planners": lambda: [*_planners(), *outside_titles("planners")],
    "checks": lambda: [*_checks(), *outside_titles("checks")],
    "controllers": lambda: [*LAW_TITLES.items(), *outside_titles("controllers")],
    "plants": lambda: [*PLANT_TITLES.items(), *outside_titles("plants")],
}
