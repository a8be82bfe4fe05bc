"""What a climb runs, compiled or loaded before its time counts and before a plant waits for commands."""

from functools import cache
from typing import Final

import numpy as np

from ....execution.sequencer import Sequencer
from ....interrupts import passed_on
from ....kernel_cache import Use
from ....planning.problem.plan import Plan
from ....sim.flaw_texts import named_flaws
from ....tasks import load_task
from ..execution.climb_trace import TracedClimber
from ..execution.climbing import Climbing
from ..execution.executable_plan import climbable, lay_course
from ..planning.plans import thesis_code
from ..planning.task import LimbedTask
from ..sim.climber_plant import ClimberPlant

CLIMBING: Final = Use("clamber.families.climber.trials.warm_up:warm_up_beside_planning", "command_tick")
FIRST_GRAB: Final = 106
"""Of the thesis's gait on the ladder, its number of the action."""


@cache
@passed_on()  # the climb of one action would end with what it has, and the command go on
def warm_up() -> None:
    """Climb one action for nothing, once in a process: compiling takes minutes, loading what is compiled a second."""
    task = _on_the_ladder()
    plan = Plan.of_codes(task, [thesis_code(task, FIRST_GRAB)])
    Sequencer(Climbing(_climber(task), lay_course(task, plan))).run()


def warm_up_beside_planning() -> None:
    """The same while another process plans: first what planning does without, so that each of them compiles its own."""
    task = _on_the_ladder()
    start, climber = task.start, _climber(task)
    climber.start(np.array((start.x, start.y, start.theta)), start.holds, elbows={})
    climber.tick()
    warm_up()


def _on_the_ladder() -> LimbedTask:
    ladder = load_task("ladder")
    assert isinstance(ladder, LimbedTask)
    return climbable(ladder)


def _climber(task: LimbedTask) -> TracedClimber:
    plant = ClimberPlant(task.robot, task.world, named_flaws("nominal", task.robot))
    return TracedClimber(task.robot, task.world, plant, watched=True)
