"""The rules that every proof of this study is for, and one exact search as plain data, so that worker processes can do it."""

import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final

import numpy as np

from ...errors import StartError
from ...families.climber.planning.task import LimbedTask
from ...families.climber.statics.checks import DEFAULT_HARD
from ...jobs import Outcome, map_items
from ...planning.exact.planner import plan_exact
from ...planning.problem.problem import Replay
from ...planning.problem.problems import pose_problem
from ...types import Json
from ..bevly_1997.printed_plans import limbed_task

BOARDS: Final = ("ladder", "modified-ladder", "h", "across", "circle")
MODEL: Final = (
    "step.length=1in",
    "step.angle=15deg",
    "rules.support=strict",
    "rules.max_hangs=0",
    "rules.clearance=6in",
)
"""Steps of 1 in and 15 deg, swings of limbs checked, no hangs, body 6 in off the pegs."""
KEPT: Final = "rules.branch=kept"
"""A limb keeps the side of its elbow while it holds, as a real one does."""
HARD_HOOKS: Final = f"rules.hard=[{', '.join(repr(name) for name in (*DEFAULT_HARD, 'hook'))}]".replace("'", '"')
"""The check `hook` forbids actions, too."""
NEVER_HANGS: Final = (
    "Without hangs all stances lie on one lattice of poses, so they are finitely many and can all be seen."
)
TOLD: Final = (
    "Proofs are for the rules of the task: body moves of 1 in and 15 deg, the swing of a leg checked (strict), no hangs, "
    "body 6 in off the pegs, the thesis's force rule; limbs may pass through each other and through pegs.",
    "LIBRA is the robot file's: the hook of leg 1 mirrors leg 2's, the second link of leg 3 is 15.5 cm; starts are inferred.",
)


def cone(degrees: float) -> str:
    """The rule that end effectors take forces within so many degrees of their grab direction."""
    return f"rules.hook_cone={degrees:g}deg"


MOST_STANCES: Final = 4_000_000
CORES: Final = os.cpu_count() or 1
"""Processes that work side by side."""
NO_START: Final = "no start"
"""In place of a planner's status: the start stance itself breaks a hard check."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Proof:
    """What exact search says of a task."""

    task: str
    overrides: tuple[str, ...]
    status: str
    """`optimal`, `infeasible`, `bounded`, or `NO_START`."""
    reason: str
    length: int | None = None
    """Actions; None without a plan."""
    torque: float | None = None
    """Largest joint torque, the start stance included [N m]."""
    energy: float | None = None
    """[J]"""
    stances: int = 0
    """Different stances seen."""
    valid: bool | None = None
    """Whether the plan, replayed without the planner, holds at every step and meets every goal; None without a plan."""
    codes: tuple[int, ...] = ()
    """The plan; without one, the way to the furthest stance."""
    at_least: int | None = None
    """Proved: no plan has fewer actions."""

    @property
    def feasible(self) -> bool:
        """Whether there is a plan; a search that ended early is an error of this study's limits, not an answer."""
        assert self.status in ("optimal", "infeasible", NO_START), f"{self.task}: {self.reason}"
        return self.status == "optimal"

    @property
    def told(self) -> str:
        """The answer in a few words."""
        if self.status == "optimal":
            return f"{self.length} actions"
        return "the start is not allowed" if self.status == NO_START else f"none, proved over {self.stances} stances"

    def load(self) -> LimbedTask:
        """The task that it is about."""
        return limbed_task(self.task, self.overrides)

    def replay(self) -> Replay:
        """Every stance and margin of the plan."""
        return pose_problem(self.load(), threads=1).problem.replay(np.array(self.codes, np.int32))


def prove(
    name: str,
    overrides: Sequence[str],
    *,
    minimize: Sequence[str] = ("length",),
    most: int = MOST_STANCES,
    seconds: float | None = None,
) -> Proof:
    """Search a task whole.

    Args:
        name: Of the task.
        overrides: Texts "key=value" that change it.
        minimize: Costs in lexicographic order.
        most: Stances that are kept at most.
        seconds: Most time [s].
    """
    asked: dict[str, Any] = {"task": name, "overrides": tuple(overrides)}
    try:
        result = plan_exact(
            limbed_task(name, overrides), threads=1, max_stances=most, minimize=minimize, seconds=seconds
        )
    except StartError as error:
        return Proof(**asked, status=NO_START, reason=str(error))
    seen: dict[str, Any] = {
        "status": result.status,
        "reason": result.reason,
        "stances": result.stances,
        "codes": tuple(result.plan.codes(result.task, name).tolist()),
        "at_least": result.lower_bound,
    }
    if not result.costs:
        return Proof(**asked, **seen)
    verdict = result.check()
    return Proof(
        **asked,
        **seen,
        length=result.length,
        torque=result.costs["torque"],
        energy=result.costs["energy"],
        valid=verdict.ok and verdict.reached,
    )


def prove_item(item: Json) -> Json:
    """`prove` in a worker: its arguments in, the fields of `Proof` out."""
    return asdict(prove(**item))


def prove_all(items: Sequence[Json]) -> list[Proof]:
    """Many searches, side by side.

    Args:
        items: Arguments of `prove`, as plain data.
    """
    return [proof_of(result) for result in run_all(prove_item, items)]


def proof_of(told: Json) -> Proof:
    """A proof from plain data."""
    return Proof(**told | {"overrides": tuple(told["overrides"]), "codes": tuple(told["codes"])})


def run_all(function: Any, items: Sequence[Json]) -> list[Json]:
    """Items over one process a core; an item that fails is a broken promise of this study."""
    prove("ladder", MODEL, most=1)  # compiles the kernels here, once, and not in every worker at the same time
    return [_result(outcome) for outcome in map_items(function, items, workers=CORES)]


def _result(outcome: Outcome) -> Json:
    assert outcome.result is not None, outcome.error
    return outcome.result
