"""How weak the motors may be: from a board's start, from the best start on the same holds, and length against torque on H."""

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Final, TypeAlias

import numpy as np

from ...errors import StartError
from ...families.climber.planning.task import LimbedTask
from ...jobs import read_result
from ...planning.exact.front import plan_front
from ...planning.problem.problems import pose_problem
from ...planning.problem.verdict import check_plan
from ...types import Json
from ...units import DEGREE, INCH, OZ_IN
from ...viewing.plan_curves import draw_front
from ..bevly_1997.printed_plans import limbed_task
from ..result import Cells, Compared, Figure, StudyResult, Table
from .proofs import BOARDS, MODEL, NEVER_HANGS, TOLD, Proof, prove, prove_all, run_all

MOVES: Final = 'rules.allowed=["+x","-x","+y","-y","+theta","-theta"]'
"""Only the body moves."""

Place: TypeAlias = tuple[str, int, int, int]
"""Limb that moved last, and the body's steps in x, y and angle from the task's start."""


@dataclass(frozen=True, slots=True)
class Calm:
    """The start of least need, and the proof of what is needed from there."""

    proof: Proof
    start_torque: float
    """Largest joint torque of that start stance itself [N m]."""
    calmest: float
    """The least that any of the start stances has [N m], whatever it leads to."""
    places: int
    """Start stances compared."""
    searches: int
    """Whole searches that this took."""


def calmest(board: str) -> Calm:
    """Find the start of least need.

    Body moves can be undone, so starts that moves join under a limit can all do the same under it. Of each such group one start is
    searched whole; what it needs is the next, lower limit, until no start is left below the limit.
    """
    loads = places_on_start_holds(board)
    left = dict(loads)
    best: tuple[Proof, Place] | None = None
    searches = 0
    while left:
        place = min(left, key=lambda key: (left[key], key))
        proof = prove(board, (*MODEL, *start_at(board, place)), minimize=("torque",))
        searches += 1
        assert proof.feasible and proof.torque is not None, f"{board}: {proof.reason}"
        group = joined(place, left)
        if best is None or best[0].torque is None or proof.torque < best[0].torque:
            best = proof, place
        under = best[0].torque or 0.0
        left = {key: load for key, load in left.items() if key not in group and load < under * (1.0 - 1e-9)}
    assert best is not None, f"{board}: its own start is a place"
    shortest = prove(board, best[0].overrides, minimize=("torque", "length"))
    return Calm(shortest, loads[best[1]], min(loads.values()), len(loads), searches)


def places_on_start_holds(board: str) -> dict[Place, float]:
    """Every start that holds on the holds of the task's start, with its largest joint torque [N m]."""
    loads: dict[Place, float] = {}
    for limb in limbed_task(board).robot.limb_names:
        try:
            problem = pose_problem(limbed_task(board, (*MODEL, MOVES, f"start.in_use={limb}")), threads=1).problem
        except StartError:  # with this limb idle the others can't carry
            continue
        step = limbed_task(board, MODEL).step
        turn = round(2.0 * np.pi / step.angle)
        origin = problem.start[0]
        layer = problem.start
        while len(layer):
            fresh = []
            peaks = problem.measured(layer)[:, problem.features.index("peak")]
            for k, stance in enumerate(layer):
                place = (
                    limb,
                    round((stance["x"] - origin["x"]) / step.length),
                    round((stance["y"] - origin["y"]) / step.length),
                    round((stance["angle"] - origin["angle"]) / step.angle) % turn,
                )
                if place not in loads:
                    loads[place] = float(peaks[k])
                    fresh.append(k)
            layer = problem.expand(layer[fresh]).stance if fresh else layer[:0]
    return loads


def start_torque(board: str) -> float:
    """Largest joint torque of the task's start stance [N m]."""
    problem = pose_problem(limbed_task(board, MODEL), threads=1).problem
    return float(problem.measured(problem.start)[0, problem.features.index("peak")])


def start_at(board: str, place: Place) -> tuple[str, ...]:
    """The overrides that start a task at a place."""
    task = limbed_task(board, MODEL)
    limb, x, y, angle = place
    return (
        f"start.in_use={limb}",
        f"start.x={task.start.x + x * task.step.length!r} m",
        f"start.y={task.start.y + y * task.step.length!r} m",
        f"start.theta={task.start.theta + angle * task.step.angle!r} rad",
    )


def joined(place: Place, among: Iterable[Place]) -> set[Place]:
    """The places that single body moves join to one, itself included."""
    turn = round(2.0 * np.pi / limbed_task("ladder", MODEL).step.angle)
    left, edge, group = set(among), [place], {place}
    while edge:
        limb, x, y, angle = edge.pop()
        for dx, dy, da in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)):
            near = (limb, x + dx, y + dy, (angle + da) % turn)
            if near in left and near not in group:
                group.add(near)
                edge.append(near)
    return group


def calmest_item(item: Json) -> Json:
    """`calmest` in a worker."""
    return asdict(calmest(item["board"]))


BOARD: Final = "h"
NUDGE: Final = 1e-6
"""How far above and below the least torque the limit is set, as a part of it [-]."""


def limit(torque: float, nudge: float) -> str:
    """The rule that no joint may bear more than a torque [N m], nudged by a part of it."""
    return f"motor.torque_limit={torque * (1.0 + nudge)!r} N m"


def trade_length_for_torque() -> StudyResult:
    """The complete front of H, and how little torque is enough."""
    task = limbed_task(BOARD, MODEL)
    front = plan_front(task, ("length", "torque"), threads=1)
    verdicts = [check_plan(task, trade.plan) for trade in front.trades]
    rows: tuple[Cells, ...] = tuple(
        (
            trade.length,
            trade.costs["torque"] / OZ_IN,
            trade.costs["energy"],
            "valid" if verdict.ok and verdict.reached else "not valid",
        )
        for trade, verdict in zip(front.trades, verdicts, strict=True)
    )
    easiest = prove(BOARD, MODEL, minimize=("torque",))
    assert easiest.torque is not None, easiest.reason
    above, below = (prove(BOARD, (*MODEL, limit(easiest.torque, nudge))) for nudge in (NUDGE, -NUDGE))
    replayed = all(row[3] == "valid" for row in rows)
    held = above.feasible and not below.feasible
    return StudyResult(
        claim="On H a longer plan can do with weaker motors. These are all plans that no other beats in both length and torque, "
        "and the smallest torque limit under which H can be climbed is that of the last of them.",
        verdict="holds" if front.complete and replayed and held else "differs",
        compared=(
            Compared("plans on the front", len(rows)),
            Compared("stances seen", front.stances),
            Compared("plans that hold when replayed, and meet every goal", sum(row[3] == "valid" for row in rows)),
            Compared("shortest plan [actions]", rows[0][0], "120 (Table 2.4)"),
            Compared("its largest torque [oz-in]", rows[0][1], "less than 1500 (Table 2.4)"),
            Compared("least torque of all plans [oz-in]", rows[-1][1]),
            Compared("shortest plan of least torque [actions]", rows[-1][0]),
            Compared("torque of the start stance itself [oz-in]", start_torque(BOARD) / OZ_IN),
            Compared("half the weight times the way from a port to its peg at the start [oz-in]", _level(task) / OZ_IN),
            Compared("limit one part in a million above the least", above.told),
            Compared("limit one part in a million below the least", below.told),
        ),
        deviations=(
            *TOLD,
            NEVER_HANGS,
            "The least torque is that of the start stance, which counts: under a lower limit the robot can't even stand at its start, "
            "and that is the whole proof from below. It is half the weight on the horizontal way from port to peg, as whenever the body is "
            "level in the middle of two columns. The result least-torque frees the start: on H the climb itself needs no less.",
        ),
        table=Table(("length [actions]", "largest torque [oz-in]", "energy [J]", "replay"), rows),
        figures=(
            Figure(
                "front",
                "The complete front of H: what more actions give in torque.",
                lambda path: draw_front(front, path),
            ),
        ),
    )


def _level(task: LimbedTask) -> float:
    """Shoulder torque of the first limb at the start if it carries half the weight, straight down [N m]."""
    limb = task.robot.limbs[0]
    peg = task.world.by_number(task.start.holds[limb.name])
    return task.robot.weight / 2.0 * abs(peg.x - task.start.x - limb.port_x)


def find_least_torques() -> StudyResult:
    """Least torques of the five boards, the start fixed and free."""
    fixed = prove_all([{"name": board, "overrides": MODEL, "minimize": ("torque", "length")} for board in BOARDS])
    calms = [read_result(Calm, told) for told in run_all(calmest_item, [{"board": board} for board in BOARDS])]
    items: list[Json] = [
        {"name": board, "overrides": (*calm.proof.overrides, limit(calm.proof.torque or 0.0, nudge))}
        for board, calm in zip(BOARDS, calms, strict=True)
        for nudge in (NUDGE, -NUDGE)
    ]
    sides = prove_all(items)
    rows = [_torque_row(board, fixed[k], calms[k], *sides[2 * k : 2 * k + 2]) for k, board in enumerate(BOARDS)]
    held = all(proof.feasible == (k % 2 == 0) for k, proof in enumerate(sides)) and all(
        proof.valid for proof in (*fixed, *(calm.proof for calm in calms))
    )
    return StudyResult(
        claim="The smallest torque limit under which each board can be climbed: from the task's start, whose own torque counts, "
        "and from whatever stance on the start's holds suits the climb best.",
        verdict="holds" if held else "differs",
        compared=(
            *(Compared(f"{row[0]}: least torque from the task's start [oz-in]", row[2]) for row in rows),
            *(Compared(f"{row[0]}: least torque from the best start on its holds [oz-in]", row[4]) for row in rows),
        ),
        deviations=(
            *TOLD,
            NEVER_HANGS,
            "A best start is one on the holds of the task's start that body moves lead to from it, in steps of 1 in and 15 deg, "
            "whichever limb moved last. Starts that body moves join under a limit can do the same under it, so one of each such group "
            "is searched whole, until no group is left whose stances need less than the best known.",
            "Above and below: a limit a millionth higher leaves a plan, the same lower leaves none from that start. Where the best "
            "start's own torque is the largest, 'below' fails at the start; calmer stances on those holds, as the table has them, "
            "lead on only by way of ones that need as much.",
        ),
        table=Table(
            (
                "board", "the start itself [oz-in]", "least from it [oz-in]", "actions",
                "least from the best start [oz-in]",
                "that start itself [oz-in]", "calmest stance on its holds [oz-in]", "it stands at [in, in, deg]",
                "actions from it", "largest at steps", "starts compared", "above", "below",
            ),
            tuple(rows),
        ),
    )  # fmt: skip


def _torque_row(board: str, fixed: Proof, calm: Calm, above: Proof, below: Proof) -> Cells:
    start = calm.proof.load().start
    degrees = (start.theta / DEGREE + 180.0) % 360.0 - 180.0
    return (
        board,
        start_torque(board) / OZ_IN,
        (fixed.torque or 0.0) / OZ_IN,
        fixed.length,
        (calm.proof.torque or 0.0) / OZ_IN,
        calm.start_torque / OZ_IN,
        calm.calmest / OZ_IN,
        f"{start.x / INCH:.0f}, {start.y / INCH:.0f}, {degrees:.0f}; {start.in_use} moved last",
        calm.proof.length,
        _steps(calm.proof),
        calm.places,
        above.told,
        below.told,
    )


def _steps(proof: Proof) -> str:
    """Steps at which a plan's torque is largest; 0 is the start."""
    problem = pose_problem(proof.load(), threads=1).problem
    peaks = problem.measured(proof.replay().stances)[:, problem.features.index("peak")]
    steps = [k for k, peak in enumerate(peaks.tolist()) if peak >= (proof.torque or 0.0) * (1.0 - 1e-9)]
    return ", ".join(map(str, steps[:4])) + (", ..." if len(steps) > 4 else "")
