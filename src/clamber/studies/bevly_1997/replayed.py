"""The six printed plans carried out, and the words that several results share."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from ...errors import SpecError
from ...families.climber.planning.task import LimbedTask
from ...planning.problem.plan_source import OpenedPlan, open_plan
from ...planning.problem.problem import Replay
from ...planning.problem.problems import plan_family
from ...planning.problem.verdict import Verdict
from ...tasks import load_task

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
    verdict: Verdict
    replay: Replay

    @property
    def task(self) -> LimbedTask:
        """The task that it is for."""
        assert isinstance(self.opened.task, LimbedTask), "printed plans are for limbed robots"
        return self.opened.task


def replay_printed(name: str, overrides: Sequence[str] = (), *, go_on: bool = False) -> Replayed:
    """Carry out a printed plan.

    Args:
        name: Its name, such as "h-hand".
        overrides: Texts "key=value" that change its task.
        go_on: Whether to go on past a violation.
    """
    opened = open_plan(name, None, overrides)
    codes = opened.plan.codes(opened.task, opened.label)
    replay = plan_family(opened.task).problem(opened.task).replay(codes, go_on=go_on)
    return Replayed(opened, opened.check(go_on=go_on), replay)


def limbed_task(name: str, overrides: Sequence[str] = ()) -> LimbedTask:
    """A task of a limbed robot by name."""
    task = load_task(name, overrides)
    if not isinstance(task, LimbedTask):
        raise SpecError(name, "robot", task.robot.name, "must be a limbed robot; the study is about one")
    return task
