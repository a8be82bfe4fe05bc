"""Uneven, unknown terrain: what is drawn, what the controller knows of it, and a climb on it by touch."""

import numpy as np
import pytest

from clamber.families.climber.execution.executable_plan import climbable
from clamber.families.climber.execution.hold_map import HoldMap, TipDifference
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials.noise import Noise, centre_of, draw_for, terrain_covariance, true_places
from clamber.families.climber.trials.trial import TrialSetup, climb_once
from clamber.studies.bevly_1997.body_climb import gait_plan
from clamber.tasks import load_task
from clamber.types import Floats


def task_named(name: str) -> LimbedTask:
    task = load_task(name)
    assert isinstance(task, LimbedTask)
    return task


def shifts(name: str, texts: list[str], seeds: range) -> Floats:
    """Where holds are less where they are mapped, shape (seeds, n_holds, 2) [m]."""
    task, noise = task_named(name), Noise.of("none", texts)
    return np.array([true_places(task, draw_for(task, noise, seed)) - task.world.positions() for seed in seeds])


@pytest.mark.parametrize("name", ["ladder", "h", "gecko-climb"])
def test_a_warp_moves_neighbours_alike_and_stays_within_its_width(name: str) -> None:
    task, width = task_named(name), 0.03
    found = shifts(name, ["terrain=30mm"], range(60))
    assert 0.5 * width < np.abs(found).max() <= width
    places = task.world.positions()
    far = np.linalg.norm(places[:, None] - places[None], axis=2)
    near = (far > 0.0) & (far < 0.5 * task.robot.longest_reach)
    apart = np.abs(found[:, :, None] - found[:, None])[:, near].max()
    assert apart < 0.5 * width  # within half a reach
    by_start = np.linalg.norm(places - centre_of(task), axis=1) < 0.25 * task.robot.longest_reach
    if by_start.any():
        assert np.abs(found[:, by_start]).max() < 0.4 * width


def test_a_tilt_turns_the_board_about_the_start() -> None:
    task = task_named("ladder")
    (found,) = shifts("ladder", ["tilt=5deg"], range(3, 4))
    arms = task.world.positions() - centre_of(task)
    after = arms + found
    np.testing.assert_allclose(np.linalg.norm(after, axis=1), np.linalg.norm(arms, axis=1))
    angles = np.unwrap(np.arctan2(after[:, 1], after[:, 0]) - np.arctan2(arms[:, 1], arms[:, 0]))
    assert np.ptp(np.degrees(angles)) < 1e-9 and 0.0 < abs(np.degrees(angles[0])) <= 5.0


def test_missing_holds_are_as_many_as_asked_and_never_those_of_the_start() -> None:
    task, noise = task_named("ladder"), Noise.of("none", ["missing=25%"])
    gone = np.array([draw_for(task, noise, seed).missing for seed in range(200)])
    start = np.array([hold.number in task.start.holds.values() for hold in task.world.holds])
    assert start.sum() == 3 and not gone[:, start].any()
    assert gone[:, ~start].mean() == pytest.approx(0.25, abs=0.02)
    drawn = draw_for(task, noise, 1)
    far = np.linalg.norm(true_places(task, drawn) - task.world.positions(), axis=1)
    np.testing.assert_array_equal(far > 10.0, drawn.missing)


@pytest.mark.parametrize("texts", [["terrain=30mm"], ["tilt=3deg"], ["terrain=30mm", "tilt=3deg"]])
def test_what_the_controller_knows_is_as_wide_as_what_is_drawn(texts: list[str]) -> None:
    task, noise = task_named("ladder"), Noise.of("none", texts)
    known = terrain_covariance(task, noise.widths["terrain"], noise.widths["tilt"])
    assert known is not None and np.linalg.eigvalsh(known).min() > -1e-12
    found = shifts("ladder", texts, range(300)).reshape(300, -1)
    far = np.sqrt(np.diag(known)) > 0.3 * np.sqrt(np.diag(known)).max()
    ratio = found.std(axis=0)[far] / np.sqrt(np.diag(known))[far]
    assert ratio.min() > 0.4 and ratio.max() < 1.3  # wider than drawn, never much narrower


def test_even_terrain_tells_the_controller_nothing_more() -> None:
    assert terrain_covariance(task_named("ladder"), 0.0, 0.0) is None


def touched(terrain: Floats | None, task: LimbedTask, off: Floats) -> HoldMap:
    """A map after the robot has held the ladder's holds 3 and 4, then 5, then 6, which are all off by `off`, shape (n, 2) [m]."""
    numbers = [hold.number for hold in task.world.holds]
    places = {hold.number: np.array((hold.x, hold.y)) for hold in task.world.holds}
    true = {number: places[number] + off[k] for k, number in enumerate(numbers)}
    hold_map = HoldMap(places, 0.003, terrain=terrain)
    nothing = np.zeros((2, 4))
    for one, other in ((4, 3), (5, 4), (6, 5)):
        seen = TipDifference(true[one] - true[other], np.zeros(2), np.zeros(2), nothing, np.zeros(4))
        hold_map.learn(one, other, seen)
    return hold_map


def test_holds_that_were_touched_tell_of_those_ahead() -> None:
    """By the tilt of the board: without that knowledge the next hold is as unknown as before."""
    task = task_named("ladder")
    noise = Noise.of("none", ["tilt=4deg"])
    seed = next(seed for seed in range(20) if abs(draw_for(task, noise, seed).tilt) > np.radians(3.0))
    off = true_places(task, draw_for(task, noise, seed)) - task.world.positions()
    numbers = [hold.number for hold in task.world.holds]
    ahead = numbers.index(9)
    known = terrain_covariance(task, 0.0, noise.widths["tilt"])

    def left(hold_map: HoldMap) -> float:
        believed = hold_map.places[9] - hold_map.places[6]
        true = (
            task.world.positions()[ahead]
            + off[ahead]
            - task.world.positions()[numbers.index(6)]
            - off[numbers.index(6)]
        )
        return float(np.linalg.norm(believed - true))

    with_it, without = touched(known, task, off), touched(None, task, off)
    assert left(with_it) < 0.5 * left(without)
    assert np.linalg.norm(with_it.shift([5, 6])) > 0.005  # where the plan's poses go with them
    assert not without.shift([5, 6]).any()


def test_what_is_near_the_robot_is_known_better_than_what_is_far_even_where_all_of_it_is_off() -> None:
    """Else every hold far from the start would be too doubtful for a limb to find a way by it."""
    task = task_named("ladder")
    noise = Noise.of("none", ["terrain=60mm"])
    known = terrain_covariance(task, noise.widths["terrain"], 0.0)
    hold_map = touched(known, task, np.zeros((len(task.world.holds), 2)))
    numbers = [hold.number for hold in task.world.holds]
    absolute = HoldMap({n: np.zeros(2) for n in numbers}, 0.003, terrain=known)
    assert hold_map.error(7) < 0.5 * absolute.error(7)
    assert hold_map.error(numbers[-1]) > 2.0 * hold_map.error(7)
    even = touched(None, task, np.zeros((len(task.world.holds), 2)))
    assert even.error(20) == pytest.approx(0.003)


@pytest.mark.slow
def test_two_rungs_are_climbed_on_a_board_warped_and_turned() -> None:
    """Seed 1 turns the board by 6 deg; a peg that the climb takes is 51 mm off the map."""
    task, noise = climbable(task_named("ladder")), Noise.of("none", ["terrain=60mm", "tilt=6deg"])
    plan = gait_plan(task, 2)
    off = np.linalg.norm(true_places(task, draw_for(task, noise, 1)) - task.world.positions(), axis=1)
    taken = {action.hold for action in plan.actions}
    assert max(far for hold, far in zip(task.world.holds, off, strict=True) if hold.number in taken) > 0.05
    _, trial, _ = climb_once(TrialSetup(task=task, noise=noise, plan=plan, replan=False), 1)
    assert (trial.done, trial.reason) == (True, "")
    assert (trial.grabs, trial.replans) == (7, 0)
