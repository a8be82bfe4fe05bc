"""Tables 2.3, 2.4 and D.1 to D.4: the six printed plans carried out, their torques (figures 2.17, 2.18) and their hooks."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from ...families.climber.planning.task import LimbedTask, limbed
from ...planning.genetic.planner import plan_genetic
from ...planning.problem.plan_source import OpenedPlan, open_plan
from ...planning.problem.problem import Replay
from ...planning.problem.problems import plan_family
from ...planning.problem.verdict import Verdict as PlanVerdict
from ...tasks import load_task
from ...units import DEGREE, INCH, OZ_IN
from ...viewing.pictures import draw_route, draw_stance
from ...viewing.plan_curves import draw_torques
from ..result import Cells, Compared, Figure, StudyResult, Table, Verdict

H_START: Final = ("start.y=6.2in",)
"""The start that the printed pegs of Table 2.4 fit best."""
START: Final = "The start of the plan is not printed; it is inferred from the plan and the board."
MIRRORED: Final = (
    "The hook of leg 1 is -90 deg, mirroring leg 2's; +90 deg is printed for both, and leg 1 could carry no weight so."
)
LEG_3: Final = (
    "The second link of leg 3 is taken as 15.5 cm; 15.0 cm is printed, which is too short for two of the printed plans."
)
CLEARANCE: Final = "The least distance of the body from a peg is not printed: 6 in is ours."
OPPOSED: Final = "Legs 1 and 2 always count as one on each side of the body, so that they share the weight vertically."
INFERRED: Final = (START, MIRRORED, LEG_3, OPPOSED, CLEARANCE)


@dataclass(frozen=True, slots=True)
class Replayed:
    """A printed plan, the verdict up to its first violation, and every stance."""

    opened: OpenedPlan
    verdict: PlanVerdict
    replay: Replay

    @property
    def task(self) -> LimbedTask:
        """The task that it is for."""
        return limbed(self.opened.task, self.opened.label)


def replay_printed(name: str, overrides: Sequence[str] = ()) -> Replayed:
    """Carry out a printed plan.

    Args:
        name: Its name, such as "h-hand".
        overrides: Texts "key=value" that change its task.
    """
    opened = open_plan(name, None, overrides)
    codes = opened.plan.codes(opened.task, opened.label)
    replay = plan_family(opened.task).problem(opened.task).replay(codes)
    return Replayed(opened, opened.check(), replay)


def limbed_task(name: str, overrides: Sequence[str] = ()) -> LimbedTask:
    """A limbed robot's task by name."""
    return limbed(load_task(name, overrides), name)


ABOUT_1900: Final = (1850.0, 1950.0)
"""What rounds to the 1900 oz-in that section 2.5.3 gives [oz-in]."""


@dataclass(frozen=True, slots=True)
class Printed:
    """What is printed of one plan."""

    file: str
    claim: str
    length: int
    """Actions that are printed."""
    holds: int
    """Actions up to the goal that must hold for the claim to hold."""
    overrides: tuple[str, ...] = ()
    torque: str | None = None
    """Largest torque that the text gives."""
    torque_range: tuple[float, float] | None = None
    """From where to below where the largest torque is to be by the text [oz-in]."""
    deviations: tuple[str, ...] = ()


PRINTED: Final[dict[str, Printed]] = {
    "ladder-plan": Printed("ladder-hand", "Table D.1: a hand-made plan of 63 actions climbs the ladder.", 63, 63),
    "h-hand-plan": Printed(
        "h-hand",
        "Table D.2, section 2.5.3: a hand-made plan of 69 actions does the H task; its largest torque is about 1900 oz-in.",
        69,
        69,
        torque="about 1900",
        torque_range=ABOUT_1900,
        deviations=(
            '"Approximately 1900 oz-in" is printed to the hundred; the verdict is holds if all actions hold and the largest torque rounds '
            "to that. Until 23 November 2026 anything below 2000 did; the number was known when the rule was made sharper.",
            "At step 20 both supporting legs hold pegs on one vertical line; we take the push-pull split there.",
        ),
    ),
    "h-planner-plan": Printed(
        "h-ga",
        "Table 2.4: the planner's plan of 120 actions does the H task with less than 1500 oz-in.",
        120,
        119,
        overrides=H_START,
        torque="less than 1500",
        torque_range=(0.0, 1500.0),
        deviations=(
            "The start is taken at y = 6.2 in, where all printed pegs fit the rule; with the other plan's 6.0 in one does not.",
            "The goal is met before action 120; that action then stretches leg 3 by 0.05 in more than it is long.",
        ),
    ),
    "modified-ladder-plan": Printed(
        "modified-ladder-ga",
        "Table 2.3, figure 2.15: the planner's plan of 60 actions passes the four missing pegs by rotating the body.",
        60,
        60,
        deviations=("The printed plan ends at y = 45 in; our task asks for 60 in, so its goal is not met.",),
    ),
    "across-plan": Printed("across-hand", "Table D.3: a hand-made plan of 214 actions walks across.", 214, 214),
    "circle-plan": Printed(
        "circle-hand",
        "Table D.4: a hand-made plan of 201 actions goes once round the circle.",
        201,
        201,
        deviations=("At step 114 a leg takes a peg that another holds; this counts as a warning.",),
    ),
}
"""Result -> what is printed."""


def judge_plan(printed: Printed, steps: int, torque: float) -> Verdict:
    """Holds if as many actions hold as are to, and the largest torque is as printed.

    Args:
        printed: What is printed of the plan.
        steps: Actions that hold.
        torque: Largest of all joints [oz-in].
    """
    low, high = printed.torque_range or (0.0, math.inf)
    return "holds" if steps >= printed.holds and low <= torque < high else "differs"


def repeat_plan(result: str) -> StudyResult:
    """Carry out one printed plan and compare."""
    printed = PRINTED[result]
    done = replay_printed(printed.file, printed.overrides)
    verdict = done.verdict
    torque = verdict.max_torque / OZ_IN
    compared = [
        Compared("actions that hold", verdict.steps, printed.holds),
        Compared("actions", verdict.length, printed.length),
        Compared("largest torque [oz-in]", torque, printed.torque),
        Compared("steps of the largest torque", _largest(done)),
        Compared("actions up to the last goal met", _goal_step(done)),
    ]
    if (agree := verdict.nearest_agree()) is not None:
        compared += [Compared("printed pegs that the rule for N9k takes too", agree[0], agree[1])]
    compared += [
        Compared(f"warnings of check '{name}' at steps", ", ".join(map(str, steps)))
        for name, steps in verdict.warnings().items()
    ]
    if verdict.first_violation is not None:
        compared.append(
            Compared("first violation", f"step {verdict.first_violation.step}: {verdict.first_violation.reason}")
        )
    return StudyResult(
        claim=printed.claim,
        verdict=judge_plan(printed, verdict.steps, torque),
        compared=tuple(compared),
        deviations=(*INFERRED, *printed.deviations),
        table=_steps(done),
        figures=_figures(done),
    )


def _goal_step(done: Replayed) -> int | None:
    goals = len(done.task.goals)
    met = [step for step, stance in enumerate(done.replay.stances) if stance["stage"] >= goals]
    return met[0] if met else None


def _largest(done: Replayed) -> str:
    most = done.verdict.max_torque * (1.0 - 1e-9)
    return ", ".join(str(row.step) for row in done.verdict.per_step if row.ok and (row.max_torque or 0.0) >= most)


def _steps(done: Replayed) -> Table:
    rows = tuple(
        (
            row.step,
            row.asked,
            row.hold,
            "ok" if row.ok else row.reason,
            None if row.max_torque is None else row.max_torque / OZ_IN,
            ", ".join(row.reported),
        )
        for row in done.verdict.per_step
    )
    return Table(("step", "action", "peg", "verdict", "largest torque [oz-in]", "warnings"), rows)


def _figures(done: Replayed) -> tuple[Figure, ...]:
    return (
        Figure("route", "The plan from start to end.", lambda path: draw_route(done.task, done.replay, path)),
        Figure(
            "torques",
            "Largest joint torque of every step.",
            lambda path: draw_torques(done.task, {done.opened.plan.planner: done.replay}, path),
        ),
    )


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
    low, high = ABOUT_1900
    held = by_planner < LIMIT and low <= by_hand < high and checked.ok and ours.status == "found"
    return StudyResult(
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
            Figure(
                "torques",
                "Largest joint torque of every step of the two printed plans (figure 2.18).",
                lambda path: draw_torques(
                    hand.task, {"by hand (D.2)": hand.replay, "by the planner (2.4)": theirs.replay}, path
                ),
            ),
            Figure(
                "worst",
                "The hand-made plan where it needs most torque (figure 2.17).",
                lambda path: draw_stance(hand.task, hand.replay, at, path),
            ),
        ),
    )


PLANS: Final[dict[str, tuple[str, tuple[str, ...]]]] = {
    "Table D.1, ladder": ("ladder-hand", ()),
    "Table D.2, H by hand": ("h-hand", ()),
    "Table 2.4, H by the planner": ("h-ga", H_START),
    "Table 2.3, modified ladder": ("modified-ladder-ga", ()),
    "Table D.3, across": ("across-hand", ()),
    "Table D.4, circle": ("circle-hand", ()),
}
"""Label -> plan and what its task needs."""


def check_hooks() -> StudyResult:
    """Count the steps that no force split could carry if hooks can only pull."""
    rows: list[Cells] = []
    after = 0
    for label, (name, overrides) in PLANS.items():
        counts = []
        for support in ("atomic", "strict"):
            verdict = replay_printed(name, (*overrides, f"rules.support={support}")).verdict
            failing = [row.step for row in verdict.per_step if row.ok and "hook" in row.reported]
            counts.append(failing)
        after += len(counts[0])
        rows.append((label, verdict.steps, len(counts[0]), len(counts[1]), ", ".join(map(str, counts[0]))))
    return StudyResult(
        claim="Section 2.3: the planner's simulation assumes that a leg can hold a peg in any orientation. "
        "The robot's hooks can only pull, so plans made this way should be possible with hooks as well.",
        verdict="differs" if after else "holds",
        compared=tuple(
            Compared(f"{row[0]}: steps that hooks cannot carry, of {row[1]}, stance after the step", row[2])
            for row in rows
        )
        + tuple(Compared(f"{row[0]}: the same with the swing of the leg", row[3]) for row in rows),
        deviations=(
            *INFERRED,
            "The thesis makes no such check; the claim as a test of its plans is ours.",
            "A hook takes any pull within 90 deg of its grab direction; either side of the elbow may be used.",
            "The swing of a leg adds a step of Table D.2 where the robot hangs on one leg in between.",
        ),
        table=Table(("plan", "steps", "after the step", "with the swing", "steps that fail (after)"), tuple(rows)),
    )
