"""The sequencer: has a robot of any kind carry out its actions one after another, and tells what became of each, whatever ends the run."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, Final, Generic, TypeVar, TypeVarTuple

from ..interrupts import answer
from .run_report import Ending, FallenError, FaultError, Outcome, RefusedError, RunEndedError, RunReport

MOST_RECOVERIES: Final = 3
"""Of one action."""
MOST_REPLANS: Final = 3
"""Of one run."""

ActionT = TypeVar("ActionT")
"""What a kind of robot carries out in one go."""
ReportT = TypeVar("ReportT", bound=RunReport)
ToldTs = TypeVarTuple("ToldTs")
"""What those who follow a run are told before each action."""


@dataclass(slots=True)
class Attempt:
    """What becomes of an action."""

    start: float
    """When it began [s]."""
    outcome: Outcome = "interrupted"
    tries: int = 0
    reason: str = ""
    """Why it was not done, or what came between."""
    recovered: int = 0
    """Falls in it that the robot recovered from."""


class Performer(ABC, Generic[ActionT, ReportT, *ToldTs]):
    """What a kind of robot adds to the sequencer: where its actions come from, how each is carried out, what of a fall it can recover from.

    Every method but `record` and `end` may raise a `RunEndedError`, which ends the run.
    """

    goes_on: ClassVar[frozenset[Outcome]]
    """Outcomes after which the next action follows."""
    report: ReportT

    @property
    @abstractmethod
    def time(self) -> float:
        """Since the start, on the robot's clock [s]."""

    @abstractmethod
    def begin(self) -> None:
        """All that comes before the first action."""

    @abstractmethod
    def next(self) -> ActionT | None:
        """The coming action; None where there is no more to do.

        Raises:
            StuckError: If there is, and the robot cannot begin it.
        """

    @abstractmethod
    def told(self, action: ActionT) -> tuple[*ToldTs]:
        """What is told of an action before it is carried out."""

    @abstractmethod
    def carry_out(self, action: ActionT) -> tuple[Outcome, int, str]:
        """Carry out an action.

        Returns:
            What became of it, in how many tries, and why it was not done or what came between.
        """

    def recover(self, action: ActionT, fall: FallenError) -> str:
        """Bring the robot back to where the action can begin anew; why not, where that cannot be and the robot still holds.

        Raises:
            FallenError: The same one, if it is none to recover from.
        """
        raise fall

    @abstractmethod
    def record(self, action: ActionT, attempt: Attempt) -> None:
        """Write into the report what became of an action; also of the one in which the run ends."""

    def plan_again(self, action: ActionT, outcome: Outcome) -> bool:
        """After an action that was not done, or a fault in it: whether there is a plan without what failed, whose actions are the next."""
        return False

    def done(self, action: ActionT) -> None:
        """After an action that was done.

        Raises:
            StuckError: If it has not brought the robot on.
        """

    @abstractmethod
    def stop_safely(self) -> Ending:
        """After a fault that the robot has noticed in itself: hold still without what has failed; what became of it."""

    @abstractmethod
    def name(self, action: ActionT) -> str:
        """What a reason calls an action."""

    @abstractmethod
    def end(self) -> None:
        """Write into the report where the robot ended; it may take back that the run is done."""


class Sequencer(Generic[ActionT, ReportT, *ToldTs]):
    """Carries out the actions of a robot.

    Args:
        performer: The robot and what it is to do.
        progress: Told before each action.
    """

    def __init__(
        self,
        performer: Performer[ActionT, ReportT, *ToldTs],
        *,
        progress: Callable[[*ToldTs], None] | None = None,
    ) -> None:
        self.performer = performer
        self._progress = progress
        self._replans = 0

    def run(self) -> ReportT:
        """To the last action, one that is not done, or what else ends it: a fall, a fault, a refusal, a stopped plant, Ctrl-C.

        What happened until then is in the report.
        """
        performer, report = self.performer, self.performer.report
        try:
            performer.begin()
            report.reason = self._carry_all_out()
            report.done = not report.reason
        except KeyboardInterrupt:
            answer()
            report.reason = "interrupted"
        except FaultError as fault:
            report.reason = f"{fault.word}: {fault}"
            self._stop_safely()
        except RunEndedError as end:
            report.reason = f"{end.word}: {end}"
        report.seconds = performer.time
        performer.end()
        return report

    def _stop_safely(self) -> None:
        """After a fault: to a stop, and into the report what became of the robot."""
        report = self.performer.report
        try:
            report.ending = self.performer.stop_safely()
            if report.ending == "fell":  # what falls moves faster than its motors, which looks like a sensor that jumps
                report.reason = f"{FallenError.word}: noticed by {report.reason}"
        except KeyboardInterrupt:
            answer()
            report.reason = "interrupted"
        except RunEndedError as end:
            report.ending = "fell" if isinstance(end, FallenError) else ""
            report.reason += f"; then {end.word}: {end}"

    def _carry_all_out(self) -> str:
        """One action after another; why the last one was not done, empty if all were."""
        performer = self.performer
        while (action := performer.next()) is not None:
            if self._progress is not None:
                self._progress(*performer.told(action))
            attempt = self._act(action)
            if attempt.outcome in performer.goes_on:
                performer.done(action)
            elif attempt.outcome != FaultError.word and not self._goes_on(action, attempt.outcome):
                return f"{performer.name(action)}: {attempt.outcome}: {attempt.reason}"
        return ""

    def _act(self, action: ActionT) -> Attempt:
        """Carry out an action and report it, whatever becomes of it."""
        attempt = Attempt(self.performer.time)
        try:
            self._surely(action, attempt)
        except RunEndedError as end:
            attempt.outcome, attempt.reason = end.word, str(end)
            if not isinstance(end, RefusedError) and not (
                isinstance(end, FaultError) and self._goes_on(action, end.word)
            ):
                raise
        finally:
            self.performer.record(action, attempt)
        return attempt

    def _goes_on(self, action: ActionT, outcome: Outcome) -> bool:
        """Whether the robot goes on by another plan."""
        self._replans += 1
        return self._replans <= MOST_REPLANS and self.performer.plan_again(action, outcome)

    def _surely(self, action: ActionT, attempt: Attempt) -> None:
        """Carry out an action, once more after each fall in it that the robot recovers from."""
        while True:
            try:
                attempt.outcome, attempt.tries, attempt.reason = self.performer.carry_out(action)
                return
            except FallenError as fall:
                if attempt.recovered == MOST_RECOVERIES:
                    raise
                why = self.performer.recover(action, fall)
                if why:
                    attempt.outcome, attempt.reason = "missed", why
                    return
                attempt.recovered += 1
