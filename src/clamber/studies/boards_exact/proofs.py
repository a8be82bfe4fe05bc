"""The optimum of every board, the rules that every proof is for, and one exact search as plain data, so that worker processes can do it."""

import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final

import numpy as np

from ...errors import StartError
from ...families.climber.planning.task import LimbedTask
from ...families.climber.statics.checks import DEFAULT_HARD
from ...jobs import map_items, read_result
from ...planning.exact.planner import plan_exact
from ...planning.problem.problem import Replay
from ...planning.problem.problems import pose_problem
from ...types import Json
from ...units import OZ_IN
from ...viewing.pictures import draw_route
from ..bevly_1997.printed_plans import H_START, limbed_task, replay_printed
from ..result import Cells, Compared, Figure, StudyResult, Table, Value

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
    return [read_result(Proof, told) for told in run_all(prove_item, items)]


def run_all(function: Any, items: Sequence[Json]) -> list[Json]:
    """Items over one process a core; an item that fails is a broken promise of this study."""
    prove("ladder", MODEL, most=1)  # compiles the kernels here, once, and not in every worker at the same time
    told = []
    for outcome in map_items(function, items, workers=CORES):
        assert outcome.result is not None, outcome.error
        told.append(outcome.result)
    return told


PRINTED: Final[dict[str, tuple[str, str, tuple[str, ...]]]] = {
    "ladder": ("ladder-hand", "Table D.1, by hand, 3 in steps", ()),
    "modified-ladder": ("modified-ladder-ga", "Table 2.3, genetic, ends at 45 of 60 in", ()),
    "h": ("h-ga", "Table 2.4, genetic", H_START),
    "across": ("across-hand", "Table D.3, by hand", ()),
    "circle": ("circle-hand", "Table D.4, by hand", ()),
}
"""Board -> the printed plan, what it is, and what its task needs."""
COARSE: Final = ("step.length=3in", *MODEL[1:])
BARE_H: Final = (
    *COARSE,
    "subgoals=[]",
    'goal={name="upper right",x_min="44.9in",x_max="45.1in",y_min="47.9in",y_max="48.1in"}',
)
"""H in 3 in steps, without sub-goals, its goal within 0.1 in."""
ORDERS: Final = (("length",), ("length", "torque"), ("torque", "length"))


def prove_optima() -> StudyResult:
    """Best plans of the five boards, by length and by torque."""
    items: list[Json] = [{"name": board, "overrides": MODEL, "minimize": order} for board in BOARDS for order in ORDERS]
    items += [{"name": "ladder", "overrides": COARSE}, {"name": "h", "overrides": BARE_H}]
    proofs = prove_all(items)
    *_, ladder, bare = proofs
    rows: list[Cells] = []
    by_board: dict[str, tuple[Proof, ...]] = {}
    for k, board in enumerate(BOARDS):
        short, gentle, easy = by_board[board] = tuple(proofs[len(ORDERS) * k : len(ORDERS) * (k + 1)])
        file, what, overrides = PRINTED[board]
        printed = replay_printed(file, overrides).verdict
        rows.append(
            (board, short.length, short.stances, *_loads(gentle), easy.length, *_loads(easy), printed.length, what)
        )
    proved = all(proof.feasible and proof.valid for proof in proofs)
    shown = by_board["h"][1]
    return StudyResult(
        claim="The shortest plan of every board, proved by exact search and replayed without it; "
        "of the shortest, the one that loads the joints least; and of those that load them least, the shortest.",
        verdict="holds" if proved else "differs",
        compared=(
            *(Compared(f"{row[0]}: shortest plan [actions]", row[1], f"{row[8]} ({row[9]})") for row in rows),
            Compared("ladder, 3 in steps: shortest plan [actions]", ladder.length, "63 (Table D.1, by hand)"),
            Compared("h, 3 in steps, goal within 0.1 in, no sub-goals: shortest plan [actions]", bare.length, "69 (Table D.2, by hand)"),
            Compared("plans that hold when replayed, and meet every goal", sum(bool(proof.valid) for proof in proofs), None),
            Compared("plans", len(proofs)),
        ),
        deviations=(
            *TOLD,
            NEVER_HANGS,
            "Column 'printed' is a plan of the thesis, not a claim that it is shortest; printed plans may hang, and some end elsewhere.",
            "Torque is the largest of any joint and stance, the start included; energy is holding power times an assumed second an action.",
        ),
        table=Table(
            (
                "board", "shortest [actions]", "stances seen", "least torque at that length [oz-in]", "its energy [J]",
                "shortest of least torque [actions]", "least torque [oz-in]", "its energy [J]", "printed plan [actions]", "which",
            ),
            tuple(rows),
        ),
        figures=(
            Figure("h-route", "H: of the shortest plans the one of least torque.",
                   lambda path: draw_route(shown.load(), shown.replay(), path)),
        ),
    )  # fmt: skip


def _loads(proof: Proof) -> tuple[Value, Value]:
    return (None, None) if proof.torque is None else (proof.torque / OZ_IN, proof.energy)
