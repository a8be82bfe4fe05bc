"""How weak the motors may be: what a board needs from its start, and what the climb needs from the best start on the same holds."""

from ...planning.problem.problems import pose_problem
from ...types import Json
from ...units import DEGREE, INCH, OZ_IN
from ..result import Compared, StudyResult, Table, Value
from . import STUDY
from .boards import BOARDS, MODEL, NEVER_HANGS, TOLD
from .calm_start import Calm, calm_of, calmest_item, start_torque
from .proofs import Proof, prove_all, run_all
from .torque_front import NUDGE, limit


def find_least_torques() -> StudyResult:
    """Least torques of the five boards, the start fixed and free."""
    fixed = prove_all([{"name": board, "overrides": MODEL, "minimize": ("torque", "length")} for board in BOARDS])
    calms = [calm_of(told) for told in run_all(calmest_item, [{"board": board} for board in BOARDS])]
    items: list[Json] = [
        {"name": board, "overrides": (*calm.proof.overrides, limit(calm.proof.torque or 0.0, nudge))}
        for board, calm in zip(BOARDS, calms, strict=True)
        for nudge in (NUDGE, -NUDGE)
    ]
    sides = prove_all(items)
    rows = [_row(board, fixed[k], calms[k], *sides[2 * k : 2 * k + 2]) for k, board in enumerate(BOARDS)]
    held = all(proof.feasible == (k % 2 == 0) for k, proof in enumerate(sides)) and all(
        proof.valid for proof in (*fixed, *(calm.proof for calm in calms))
    )
    return StudyResult(
        paper=STUDY,
        result="least-torque",
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


def _row(board: str, fixed: Proof, calm: Calm, above: Proof, below: Proof) -> tuple[Value, ...]:
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
