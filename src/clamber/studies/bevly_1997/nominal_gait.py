"""Figure 2.14: the five-module gait 191, 392, 291, 300, 3 repeated up the ladder."""

from typing import Final

import numpy as np

from ...families.climber.planning.plans import thesis_code
from ...families.climber.planning.task import LimbedTask
from ...planning.problem.problem import Replay
from ...planning.problem.problems import plan_family
from ...units import INCH, OZ_IN
from ...viewing.pictures import draw_route
from ..result import Cells, Compared, Figure, StudyResult, Table
from .printed_plans import INFERRED, limbed_task, replay_printed

GAIT: Final = (191, 392, 291, 300, 3)
CYCLES: Final = 40
STEPS: Final = (1, 2, 3, 6)
"""Lengths of a body move that are tried [in]."""
RUNG: Final = 6
"""Distance of two rungs [in]; with a step as long, one cycle climbs one rung."""


def repeat_gait(length: int, support: str) -> tuple[LimbedTask, Replay, int | None]:
    """The gait repeated with a step length [in] until the goal or the first violation; the actions to the goal, if met."""
    task = limbed_task("ladder", (f"step.length={length}in", f"rules.support={support}"))
    codes = np.array([thesis_code(task, number) for number in GAIT * CYCLES], np.int32)
    problem = plan_family(task).problem(task)
    replay = problem.replay(codes)
    met = np.flatnonzero(replay.stances["stage"] >= len(task.goals))
    if not len(met):
        return task, replay, None
    return task, problem.replay(codes[: met[0]]), int(met[0])


def climb_with_gait() -> StudyResult:
    """How far the gait climbs, by step length and by what is checked while a leg swings."""
    rows: list[Cells] = []
    for support in ("atomic", "strict"):
        for length in STEPS:
            task, replay, met = repeat_gait(length, support)
            torque = float(replay.stances["torque"].max()) / OZ_IN
            top = float(replay.stances["y"].max()) / INCH
            why = "goal met"
            if met is None:
                last = int(replay.reasons[-1])
                why = f"step {len(replay.reasons)}: {plan_family(task).checks[last].name}"
            rows.append((support, length, met, top, torque, why))
    task, replay, met = repeat_gait(RUNG, "atomic")
    rungs = float(replay.stances["y"][len(GAIT)] - replay.stances["y"][0]) / (RUNG * INCH)
    power = float(replay.stances["power"][1:].mean())
    hand = replay_printed("ladder-hand")
    at_hand = float(hand.replay.stances["power"][1:].mean())
    torques = float(replay.stances["torque"].max()) / OZ_IN
    return StudyResult(
        claim="Figure 2.14: the gait 191, 392, 291, 300, 3 climbs the ladder; it is not the only one, but one with low torques.",
        verdict="holds" if met is not None else "differs",
        compared=(
            Compared("actions of the gait to y = 60 in, 6 in steps", met),
            Compared("rungs climbed by one cycle, 6 in steps", rungs),
            Compared("largest torque, 6 in steps [oz-in]", torques),
            Compared("largest torque of the hand-made plan (Table D.1) [oz-in]", hand.verdict.max_torque / OZ_IN),
            Compared("mean power, 6 in steps [W]", power),
            Compared("mean power of the hand-made plan [W]", at_hand),
            *(Compared(f"largest torque, {row[1]} in steps, {row[0]} support [oz-in]", row[4]) for row in rows),
            *(Compared(f"highest body, {row[1]} in steps, {row[0]} support [in]", row[3]) for row in rows),
        ),
        deviations=(
            *INFERRED,
            "The step length of the gait is not printed: with 6 in one cycle climbs exactly one rung, so we read it so.",
            'The gait holds only if the stance is checked after each grab (support = "atomic"): leg 3 is free when leg 1 is to move, '
            'so with the swing checked ("strict") the robot hangs on leg 2 in the second cycle, and its body comes too near a peg.',
            "That no other gait has lower torques is not examined.",
        ),
        table=Table(
            ("support", "step [in]", "actions to the goal", "highest body [in]", "largest torque [oz-in]", "end"),
            tuple(rows),
        ),
        figures=(
            Figure(
                "route",
                "The gait with 6 in steps, repeated to the top of the ladder.",
                lambda path: draw_route(task, replay, path),
            ),
        ),
    )
