"""Figures 2.17 and 2.18: the planner's H plan loads the joints less than the hand-made one."""

from pathlib import Path

from ...planning.genetic.planner import plan_genetic
from ...units import DEGREE, INCH, OZ_IN
from ..result import Compared, Figure, StudyResult
from . import PAPER
from .printed_plans import ABOUT_1900
from .replayed import H_START, INFERRED, limbed_task, replay_printed

LIMIT = 1500.0
"""A factor of safety of two from the actuators' 3000 oz-in [oz-in]."""


def compare_h_torques() -> StudyResult:
    """Largest torques of the two printed H plans, and a plan of ours under half the actuators' limit."""
    hand, theirs = replay_printed("h-hand"), replay_printed("h-ga", H_START)
    by_hand, by_planner = hand.verdict.max_torque / OZ_IN, theirs.verdict.max_torque / OZ_IN
    torques = hand.replay.stances["torque"]
    at = int(torques[1:].argmax()) + 1
    pose = hand.verdict.per_step[at - 1].pose
    limited = limbed_task("h", (f"motor.torque_limit={LIMIT:g}oz-in",))
    ours = plan_genetic(limited, threads=1)
    checked = ours.check()

    def curves(path: Path) -> None:
        from ...viewing.plan_curves import draw_torques

        draw_torques(hand.task, {"by hand (D.2)": hand.replay, "by the planner (2.4)": theirs.replay}, path)

    def worst(path: Path) -> None:
        from ...viewing.pictures import draw_stance

        draw_stance(hand.task, hand.replay, at, path)

    low, high = ABOUT_1900
    held = by_planner < LIMIT and low <= by_hand < high and checked.ok and ours.status == "found"
    return StudyResult(
        paper=PAPER,
        result="h-torques",
        claim="Figures 2.17 and 2.18: the hand-made H plan needs about 1900 oz-in; asked for a factor of safety of two, "
        "the planner finds another that needs less than 1500.",
        verdict="holds" if held else "differs",
        compared=(
            Compared("largest torque of the hand-made plan [oz-in]", by_hand, "about 1900"),
            Compared("first step of it", at),
            Compared("body there [in, in, deg]", f"{pose[0] / INCH:.1f}, {pose[1] / INCH:.1f}, {pose[2] / DEGREE:.0f}"),
            Compared("largest torque of the printed planner's plan [oz-in]", by_planner, "less than 1500"),
            Compared("our plan under 1500 oz-in: status", ours.status),
            Compared("our plan under 1500 oz-in: actions", ours.length, 120),
            Compared("our plan under 1500 oz-in: largest torque [oz-in]", checked.max_torque / OZ_IN, "less than 1500"),
        ),
        deviations=(
            *INFERRED,
            "The verdict asks of the hand-made plan a largest torque that rounds to 1900 oz-in, of the printed planner's one below "
            "1500, and a plan of ours below 1500.",
            "The curves of figure 2.18 are not in the text that we have; the two limits are.",
            'Our own plan comes from the profile "default", polished for length, with 1500 oz-in as the hard limit; hangs are allowed.',
        ),
        figures=(
            Figure("torques", "Largest joint torque of every step of the two printed plans (figure 2.18).", curves),
            Figure("worst", "The hand-made plan where it needs most torque (figure 2.17).", worst),
        ),
    )
