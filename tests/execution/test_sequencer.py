"""One sequencer for every kind of robot: a toy that only counts, a climber and a walker end alike, and all that happened is told."""

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.benchmarks.climb_speed import two_rungs
from clamber.execution.plant import PlantStoppedError
from clamber.execution.run_report import Ending, FallenError, FaultError, Outcome, RefusedError, RunReport, StuckError
from clamber.execution.sequencer import MOST_RECOVERIES, MOST_REPLANS, Attempt, Performer, Sequencer
from clamber.families.climber.execution.climb_trace import TracedClimber
from clamber.families.climber.execution.climbing import Climbing
from clamber.families.climber.execution.executable_plan import lay_course
from clamber.families.climber.sim.climber_plant import ClimberPlant
from clamber.families.walker.control.track import straight
from clamber.families.walker.execution.footstep_plan import TrackCourse
from clamber.families.walker.execution.true_walk import TracedPlant
from clamber.families.walker.execution.walk_trace import TracedWalker
from clamber.families.walker.execution.walking import Walking
from clamber.families.walker.planning import load_walk
from clamber.families.walker.sim.walker_flaws import WalkerFlaws
from clamber.families.walker.sim.walker_plant import WalkerSim
from clamber.sim.limb_flaws import LimbFlaws

WORDS = ("ok", "stalled", "missed", "refused", "slipped", "fell", "fault", "stopped", "stuck", "interrupted")
"""What may become of a toy's try."""
ENDS = {
    "fell": FallenError,
    "fault": FaultError,
    "stopped": PlantStoppedError,
    "refused": RefusedError,
    "stuck": StuckError,
}


class SlippedError(FallenError):
    """A fall that a toy recovers from."""


@dataclass
class ToyReport(RunReport):
    tried: list[tuple[int, Attempt]] = field(default_factory=list)


class Toy(Performer[int, ToyReport, int]):
    """Its actions are numbers; each try takes a second, and what becomes of it is given.

    Args:
        tries: What becomes of the tries of each action, one after another; `ok` from then on.
        plans: How many new plans there are; each leads on with the next action.
        spares: How many faults it can do without what has failed.
    """

    goes_on = frozenset({"ok", "stalled"})

    def __init__(self, *tries: list[str], plans: int = 0, spares: int = 0) -> None:
        self._tries, self._plans, self._spares = [list(one) for one in tries], plans, spares
        self._at, self._time = -1, 0.0
        self.before = self.ended = self.braced = 0
        self.report = ToyReport()

    @property
    def time(self) -> float:
        return self._time

    def begin(self) -> None:
        self.before = 1
        self._time = 0.5

    def next(self) -> int | None:
        self._at += 1
        return self._at if self._at < len(self._tries) else None

    def told(self, action: int) -> tuple[int]:
        return (action,)

    def carry_out(self, action: int) -> tuple[Outcome, int, str]:
        self._time += 1.0
        word = self._tries[action].pop(0) if self._tries[action] else "ok"
        if word == "interrupted":
            raise KeyboardInterrupt
        if word == "slipped":
            raise SlippedError("off")
        if word in ENDS:
            raise ENDS[word](f"said {word}")
        return word, 1, f"said {word}"

    def recover(self, action: int, fall: FallenError) -> str:
        if not isinstance(fall, SlippedError):
            raise fall
        return ""

    def record(self, action: int, attempt: Attempt) -> None:
        self.report.tried.append((action, attempt))

    def plan_again(self, action: int, outcome: Outcome) -> bool:
        self._plans -= outcome == "missed"
        self._spares -= outcome == "fault"
        return (outcome == "missed" and self._plans >= 0) or (outcome == "fault" and self._spares >= 0)

    def stop_safely(self) -> Ending:
        self.braced += 1
        return "held"

    def name(self, action: int) -> str:
        return f"action {action}"

    def end(self) -> None:
        self.ended += 1


def outcomes(toy: Toy) -> list[str]:
    return [attempt.outcome for _, attempt in toy.report.tried]


def test_all_actions_are_carried_out_in_turn() -> None:
    told: list[int] = []
    toy = Toy([], ["stalled"], [])
    report = Sequencer(toy, progress=told.append).run()
    assert (report.done, report.reason, report.seconds) == (True, "", 3.5)
    assert told == [0, 1, 2]
    assert outcomes(toy) == ["ok", "stalled", "ok"]
    assert [attempt.start for _, attempt in report.tried] == [0.5, 1.5, 2.5]


@pytest.mark.parametrize(
    ("word", "reason"),
    [
        ("missed", "action 1: missed: said missed"),
        ("refused", "action 1: refused: said refused"),
        ("fell", "fell: said fell"),
        ("fault", "fault: said fault"),
        ("stopped", "stopped: said stopped"),
        ("stuck", "stuck: said stuck"),
        ("interrupted", "interrupted"),
    ],
)
def test_what_ends_a_run_is_its_reason_and_the_outcome_of_the_action_that_it_ended(word: str, reason: str) -> None:
    toy = Toy([], [word], [])
    report = Sequencer(toy).run()
    assert (report.done, report.reason, report.seconds) == (False, reason, 2.5)
    assert outcomes(toy) == ["ok", word]
    assert toy.ended == 1
    assert (toy.braced, report.ending) == ((1, "held") if word == "fault" else (0, ""))


def test_a_robot_that_falls_as_it_stops_for_a_fault_is_told_to_have_fallen() -> None:
    toy = Toy(["fault"])

    def fall() -> Ending:
        raise FallenError("off")

    toy.stop_safely = fall  # type: ignore[method-assign]
    report = Sequencer(toy).run()
    assert (report.ending, report.reason) == ("fell", "fault: said fault; then fell: off")
    assert toy.ended == 1


@pytest.mark.parametrize("error", [*ENDS.values(), KeyboardInterrupt])
@pytest.mark.parametrize("where", ["begin", "next", "told", "done"])
def test_nothing_that_ends_a_run_escapes(error: type[BaseException], where: str) -> None:
    toy = Toy([], [])

    def end(*_: object) -> None:
        raise error("there")

    setattr(toy, where, end)
    report = Sequencer(toy, progress=lambda _: None).run()
    assert not report.done
    assert report.reason == ("interrupted" if error is KeyboardInterrupt else f"{error.word}: there")  # type: ignore[attr-defined]
    assert len(report.tried) == (where == "done")
    assert toy.ended == 1


def test_a_users_mistake_is_none_of_a_runs_ends() -> None:
    toy = Toy(["ok"])
    toy.begin = lambda: int("no number")  # type: ignore[method-assign, assignment]
    with pytest.raises(ValueError, match="no number"):
        Sequencer(toy).run()


@pytest.mark.parametrize("slips", range(MOST_RECOVERIES + 2))
def test_an_action_begins_anew_after_falls_that_the_robot_recovers_from_but_not_for_ever(slips: int) -> None:
    toy = Toy([], ["slipped"] * slips)
    report = Sequencer(toy).run()
    assert report.done == (slips <= MOST_RECOVERIES)
    assert [attempt.recovered for _, attempt in report.tried] == [0, min(slips, MOST_RECOVERIES)]
    assert report.reason == ("" if report.done else "fell: off")


def test_a_fall_that_cannot_be_recovered_from_while_the_robot_still_holds_is_a_miss() -> None:
    toy = Toy(["slipped"])
    toy.recover = lambda action, fall: "no way back"  # type: ignore[method-assign]
    report = Sequencer(toy).run()
    assert (report.reason, outcomes(toy)) == ("action 0: missed: no way back", ["missed"])


@pytest.mark.parametrize("misses", range(MOST_REPLANS + 2))
def test_a_new_plan_leads_on_after_a_miss_but_not_for_ever(misses: int) -> None:
    report = Sequencer(Toy(*[["missed"]] * misses, [], plans=9)).run()
    assert report.done == (misses <= MOST_REPLANS)
    assert len(report.tried) == min(misses, MOST_REPLANS) + 1


def test_without_a_new_plan_a_miss_is_the_end() -> None:
    assert Sequencer(Toy(["missed"], ["missed"], [], plans=1)).run().reason == "action 1: missed: said missed"


def plainly(tries: list[list[str]], plans: int) -> tuple[list[str], bool]:
    """Outcomes of a toy's actions, and whether it is done."""
    told: list[str] = []
    replans = 0
    for words in tries:
        slips = next((k for k, word in enumerate(words) if word != "slipped"), len(words))
        word = "fell" if slips > MOST_RECOVERIES else "ok" if slips == len(words) else words[slips]
        told.append(word)
        if word == "missed" and replans < min(MOST_REPLANS, plans):
            replans += 1
        elif word not in Toy.goes_on:
            return told, False
    return told, True


@given(st.lists(st.lists(st.sampled_from(WORDS), max_size=5), max_size=6), st.integers(0, 5))
def test_whatever_happens_all_of_it_is_told_once(tries: list[list[str]], plans: int) -> None:
    told: list[int] = []
    toy = Toy(*tries, plans=plans)
    report = Sequencer(toy, progress=told.append).run()
    assert (outcomes(toy), report.done) == plainly(tries, plans)
    assert report.done == (not report.reason)
    assert [action for action, _ in report.tried] == told == list(range(len(told)))
    assert report.seconds == toy.time
    assert all(before.start < after.start for (_, before), (_, after) in pairwise(report.tried))
    assert (toy.before, toy.ended) == (1, 1)


def climber() -> tuple[Climbing, TracedClimber]:
    task, plan = two_rungs()
    plant = ClimberPlant(task.robot, task.world, LimbFlaws(physics_rate=1000.0))
    robot = TracedClimber(task.robot, task.world, plant, truth=plant.truth)
    return Climbing(robot, lay_course(task, plan)), robot


def walker() -> tuple[Walking, TracedWalker]:
    walk = load_walk("level-walk")
    plant = TracedPlant(WalkerSim(walk.robot, walk.ground, WalkerFlaws()))
    robot = TracedWalker(walk.robot, plant)
    robot.start(walk.start_pose(), walk.start_place(), walk.start_legs(), np.array(walk.arm))
    radius = walk.robot.legs.radius_delta
    return Walking(robot, lambda pose: TrackCourse(straight(pose, 0.0, 0.5, radius))), robot


@pytest.mark.parametrize("word", ["fell", "refused", "stopped", "interrupted"])
@pytest.mark.parametrize("kind", [climber, walker])
def test_a_robot_of_either_kind_ends_in_the_same_words_with_a_trace_up_to_that_tick(
    kind: Callable[[], tuple[Climbing, TracedClimber] | tuple[Walking, TracedWalker]],
    word: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    performer, robot = kind()
    told: list[object] = []
    ended: list[bool] = []
    plant = robot.plant
    go_on = plant.step

    def step() -> None:
        """The run ends in the hundredth tick of the first action."""
        ended.append(robot.step == 1)
        if sum(ended) == 100:
            raise KeyboardInterrupt if word == "interrupted" else ENDS[word]("the line is cut")
        go_on()

    monkeypatch.setattr(plant, "step", step)
    report = Sequencer(performer, progress=lambda *said: told.append(said[0])).run()
    records = report.actions if isinstance(performer, Climbing) else report.steps
    assert told == [1]
    assert [one.outcome for one in records] == [word]
    said = {"interrupted": "interrupted", "refused": "refused: the line is cut"}.get(word, f"{word}: the line is cut")
    assert report.reason == (f"{performer.name((1, 1))}: {said}" if word == "refused" else said)
    assert not report.done
    trace = robot.trace(report.to_json())
    assert trace.time[-1] == report.seconds == robot.time == pytest.approx(records[0].start + 99 * plant.period)
    assert (trace.step[0], trace.step[-1]) == (0, 1)
    assert np.all(np.diff(trace.time) > 0.0)
    assert report.true_pose is not None
    np.testing.assert_array_equal(report.pose, trace.believed[-1])
    back = type(trace).from_log(trace.to_log())
    for name in ("time", "step", "believed", "true_pose"):
        np.testing.assert_array_equal(getattr(back, name), getattr(trace, name))
    assert back.notes is not None
    assert back.notes["reason"] == report.reason


def test_after_a_fault_a_robot_that_can_goes_on_without_what_has_failed() -> None:
    toy = Toy(["fault"], [], ["fault"], [], spares=1)
    report = Sequencer(toy).run()
    assert outcomes(toy) == ["fault", "ok", "fault"]
    assert (report.done, report.ending, toy.braced) == (False, "held", 1)
    assert report.reason == "fault: said fault"
    assert Sequencer(Toy(["fault"], [], spares=1)).run().done


def test_it_does_so_and_plans_again_three_times_in_a_run_at_most() -> None:
    toy = Toy(["fault"], ["missed"], ["fault"], ["fault"], plans=9, spares=9)
    assert Sequencer(toy).run().ending == "held"
    assert outcomes(toy) == ["fault", "missed", "fault", "fault"]
