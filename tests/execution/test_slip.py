"""A hook that comes off is told, and which one, within 0.2 s; nothing else is called a slip; the robot catches itself and climbs on."""

from collections.abc import Callable
from dataclasses import dataclass, field

import mujoco
import numpy as np
import pytest

from clamber.benchmarks.climb_speed import two_rungs
from clamber.execution.sequencer import Sequencer
from clamber.families.climber.execution.climb_report import ClimbReport
from clamber.families.climber.execution.climb_trace import TracedClimber
from clamber.families.climber.execution.climber import FallenError, SlippedError
from clamber.families.climber.execution.climbing import Climbing
from clamber.families.climber.execution.executable_plan import lay_course
from clamber.families.climber.execution.slip import MOVED
from clamber.families.climber.sim.climber_plant import ClimberPlant
from clamber.families.climber.trials.noise import Noise, draw_for
from clamber.families.climber.trials.plants import drawn_plant
from clamber.families.climber.trials.run_plan import believing_climber, climbing_flaws
from clamber.types import Floats
from tiers import first_fast

OFF = 0.012
"""A tip that far from its peg is off it [m]."""
GONE = 0.25
"""Time for which a peg is not there, where it comes back [s]."""
RIGHT, LEFT, BOTTOM = 0, 1, 2
When = Callable[[TracedClimber], bool]


@dataclass
class Knocked:
    """Two rungs of the ladder under the usual noise, on the way of which a limb's peg is suddenly not there."""

    seed: int
    limb: int = RIGHT
    when: When = lambda climber: False
    gone: float = GONE
    others: bool = True
    """Whether the other pegs stay."""
    knocked: float | None = None
    off: float | None = None
    """When the tip was first off its peg [s]."""
    told: float | None = None
    said: FallenError | None = None
    moved: list[float] = field(default_factory=list)
    """Most that two tips moved against each other, at each tick before [m]."""

    def __post_init__(self) -> None:
        task, plan = two_rungs()
        drawn = draw_for(task, Noise.of("usual"), self.seed)
        self.plant: ClimberPlant = drawn_plant(task, climbing_flaws(task, ()), drawn)
        self.pegs: Floats = task.world.positions() + drawn.pegs
        self.climber = believing_climber(task, self.plant, Noise.of("usual"), drawn)
        self.sequencer = Sequencer(Climbing(self.climber, lay_course(task, plan)))
        self._tick, self.climber.tick = self.climber.tick, self.tick  # type: ignore[method-assign]
        model = self.plant.model
        self._there = model.geom_contype.copy(), model.geom_conaffinity.copy()
        self.hold = 0

    def climb(self) -> ClimbReport:
        return self.sequencer.run()

    def tick(self) -> None:
        climber, model = self.climber, self.plant.model
        if self.knocked is None and self.when(climber):
            self.knocked, self.hold = climber.time, climber.body.tasks[self.limb].hold
            which = model.geom(f"peg {self.hold}").id if self.others else slice(None)
            model.geom_contype[which] = model.geom_conaffinity[which] = 0
        elif self.knocked is not None and climber.time > self.knocked + self.gone:
            model.geom_contype[:], model.geom_conaffinity[:] = self._there
        try:
            self._tick()
        except FallenError as said:
            if self.told is None:
                self.told, self.said = climber.time, said
            raise
        finally:
            if self.knocked is None:
                self.moved.append(climber.slip.moved)
            elif self.off is None:
                apart = self.plant.truth().tips[self.limb] - self.pegs[self.hold - 1]
                self.off = climber.time if float(np.hypot(*apart)) > OFF else None


def on_two_limbs(step: int, ticks: int) -> When:
    """Some ticks after a step has begun and two limbs carry while the third is free."""
    return _after(
        step, ticks, lambda doing: doing.count("stance") == 2 and bool({"swing_joint", "swing_cartesian"} & set(doing))
    )


def on_three_limbs(step: int, ticks: int) -> When:
    """Likewise, while the third one, the bottom limb, clings."""
    return _after(step, ticks, lambda doing: doing.count("stance") == 2 and doing[BOTTOM] == "unloaded_contact")


def while_one_pushes(step: int, ticks: int) -> When:
    """Likewise, while the third one pushes its hook onto a hold."""
    return _after(step, ticks, lambda doing: doing.count("stance") == 2 and "contact_push" in doing)


def _after(step: int, ticks: int, fits: Callable[[list[str]], bool]) -> When:
    seen = [0]

    def due(climber: TracedClimber) -> bool:
        if climber.step >= step and fits([task.mode for task in climber.body.tasks]):
            seen[0] += 1
        return seen[0] > ticks

    return due


@pytest.mark.parametrize("seed", first_fast(range(6)))
def test_no_slip_is_told_in_a_climb_without_one(seed: int) -> None:
    climb = Knocked(seed)
    report = climb.climb()
    assert report.done, report.reason
    assert climb.said is None
    assert max(climb.moved) < 0.9 * MOVED
    assert all(action.recovered == 0 for action in report.actions)


@pytest.mark.parametrize("seed", first_fast(range(4)))
@pytest.mark.parametrize("limb", [RIGHT, LEFT])
@pytest.mark.parametrize(
    ("when", "step", "ticks"),
    [(on_two_limbs, 2, 60), (on_two_limbs, 5, 100), (on_three_limbs, 3, 10), (while_one_pushes, 2, 40)],
    ids=["reaching", "body moves", "third clings", "third pushes"],
)  # fmt: skip
def test_a_lost_hook_is_told_and_named_within_a_fifth_of_a_second(
    when: Callable[[int, int], When], step: int, ticks: int, limb: int, seed: int
) -> None:
    climb = Knocked(seed, limb, when(step, ticks), gone=60.0)
    tick = climb.climber.tick

    def tick_until_told() -> None:
        if climb.told is not None and (climb.off is not None or climb.climber.time > climb.told + 1.0):
            raise KeyboardInterrupt  # how it recovers is not asked here
        tick()

    climb.climber.tick = tick_until_told  # type: ignore[method-assign]
    climb.climb()
    assert climb.knocked is not None
    if climb.off is None:  # another hook has taken the load before this one came down
        assert climb.told is not None
        return
    assert climb.told is not None
    assert climb.told - climb.off < 0.2
    assert isinstance(climb.said, SlippedError)
    assert climb.said.limb == limb


@pytest.mark.parametrize("seed", first_fast(range(4)))
def test_the_loss_of_all_hooks_is_told_within_a_fifth_of_a_second_and_is_a_fall(seed: int) -> None:
    climb = Knocked(seed, RIGHT, on_two_limbs(2, 60), gone=60.0, others=False)
    report = climb.climb()
    assert climb.off is not None
    assert climb.told is not None
    assert climb.told - climb.off < 0.2
    assert report.actions[-1].outcome == "fell"
    assert "fell" in report.reason


@pytest.mark.parametrize("seed", first_fast(range(8)))
def test_a_clinging_hook_takes_the_load_and_the_climb_goes_on(seed: int) -> None:
    climb = Knocked(seed, RIGHT, on_three_limbs(3, 10))
    report = climb.climb()
    assert climb.knocked is not None
    assert report.done, report.reason
    assert sum(action.recovered for action in report.actions) >= 1
    assert all(action.outcome == "ok" for action in report.actions)
    course = climb.sequencer.performer.course
    np.testing.assert_allclose(climb.plant.truth().pose[:2], course.pose(len(course.actions))[:2], atol=0.02)
    told = report.to_json()["actions"]
    assert isinstance(told, list)
    assert sum(action["recovered"] for action in told) >= 1


@pytest.mark.parametrize("seed", first_fast(range(4)))
@pytest.mark.parametrize(("limb", "step", "ticks"), [(RIGHT, 2, 60), (LEFT, 5, 100)], ids=["body above", "body beside"])
def test_a_body_that_has_lost_one_of_two_hooks_is_still_held_two_seconds_later(
    limb: int, step: int, ticks: int, seed: int
) -> None:
    climb = Knocked(seed, limb, on_two_limbs(step, ticks))
    tick, borne = climb.climber.tick, []

    def tick_until_seen() -> None:
        if climb.knocked is not None and climb.climber.time > climb.knocked + 2.0:
            raise KeyboardInterrupt
        tick()
        if climb.knocked is not None and climb.climber.time > climb.knocked + 1.5:
            borne.append(upwards(climb.plant))

    climb.climber.tick = tick_until_seen  # type: ignore[method-assign]
    report = climb.climb()
    assert report.reason == "interrupted"
    assert float(np.mean(borne)) > 0.8 * climb.climber.robot.weight  # what falls is borne by nothing


def upwards(plant: ClimberPlant) -> float:
    """Sum of what pegs do to the robot, upwards [N]."""
    total, wrench = 0.0, np.zeros(6)
    for k in range(plant._data.ncon):
        contact = plant._data.contact[k]
        mujoco.mj_contactForce(plant.model, plant._data, k, wrench)
        force = contact.frame.reshape(3, 3).T @ wrench[:3]  # on the second geom
        first_is_peg = plant.model.geom(contact.geom1).name.startswith("peg")
        total += float(force[1]) * (1.0 if first_is_peg else -1.0)
    return total


@pytest.mark.parametrize("limb", first_fast([RIGHT, LEFT]))
def test_a_hook_that_bears_is_kept_though_it_seemed_to_have_come_off(limb: int) -> None:
    climb = Knocked(3)
    tick, due = climb.climber.tick, on_three_limbs(3, 10)
    told: list[int] = []
    kept: list[int] = []

    def tick_and_err() -> None:
        tick()
        if told and len(kept) < 60:
            kept.append(climb.climber.body.tasks[limb].hold)
        if not told and due(climb.climber):
            told.append(climb.climber.body.tasks[limb].hold)
            raise SlippedError(limb, "nothing has")

    climb.climber.tick = tick_and_err  # type: ignore[method-assign]
    report = climb.climb()
    assert set(kept) == {told[0]}
    assert report.done, report.reason
    assert sum(action.recovered for action in report.actions) == 1
