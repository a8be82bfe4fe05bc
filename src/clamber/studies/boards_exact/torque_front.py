"""Length against torque on H: every plan that no other beats, and the smallest torque limit, proved from both sides."""

from pathlib import Path
from typing import Final

from ...families.climber.planning.task import LimbedTask
from ...planning.exact.front import plan_front
from ...planning.problem.verdict import check_plan
from ...units import OZ_IN
from ..bevly_1997.replayed import limbed_task
from ..result import Compared, Figure, StudyResult, Table, Value
from . import STUDY
from .boards import MODEL, NEVER_HANGS, TOLD
from .calm_start import start_torque
from .proofs import prove

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
    rows: tuple[tuple[Value, ...], ...] = tuple(
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

    def curve(path: Path) -> None:
        from ...viewing.plan_curves import draw_front

        draw_front(front, path)

    return StudyResult(
        paper=STUDY,
        result="h-torque-front",
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
        figures=(Figure("front", "The complete front of H: what more actions give in torque.", curve),),
    )


def _level(task: LimbedTask) -> float:
    """Shoulder torque of the first limb at the start if it carries half the weight, straight down [N m]."""
    limb = task.robot.limbs[0]
    peg = task.world.by_number(task.start.holds[limb.name])
    return task.robot.weight / 2.0 * abs(peg.x - task.start.x - limb.port_x)
