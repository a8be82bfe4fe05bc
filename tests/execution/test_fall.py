"""Falls are told within 0.2 s of the truth, and nothing else is called one."""

from collections.abc import Callable
from typing import Final

import numpy as np
import pytest

from clamber.families.climber.control.backlash import weight_loads
from clamber.families.climber.control.felt_force import ASTRAY, SLOW, TURNED
from clamber.families.climber.execution.climb_trace import TracedClimber
from clamber.families.climber.execution.climber import FallenError
from clamber.families.climber.execution.grabbing import grab
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.families.climber.sim.climber_model import HookShape
from clamber.families.climber.sim.climber_plant import ClimberPlant
from clamber.families.climber.world.library import load_board
from clamber.sim.limb_flaws import LimbFlaws
from clamber.tasks.robots import load_robot

NOMINAL = LimbFlaws(backlash=np.radians(2.0), physics_rate=1000.0, encoder_counts=400, delay=1)
START = np.array((0.2286, 0.1374, 0.0))
OFF = HookShape().depth + HookShape().flare
"""A tip that far from every peg has none in its hook [m]."""
PLAY = 0.015
"""What 2 deg of backlash in two joints of a limb moves its tip by, both ways [m]."""


def on_the_ladder() -> tuple[TracedClimber, ClimberPlant]:
    robot, board = load_robot("libra"), load_board("ladder")
    assert isinstance(robot, LimbedRobot)
    plant = ClimberPlant(robot, board, NOMINAL)
    climber = TracedClimber(robot, board, plant, map_error=0.006, truth=plant.truth)
    climber.start(START, {"right": 4, "left": 3, "bottom": 2}, idle="bottom", elbows={"right": -1, "left": 1})
    return climber, plant


def without_pegs(plant: ClimberPlant) -> None:
    plant.model.geom_contype[:] = plant.model.geom_conaffinity[:] = 0


def pushed(x: float, y: float) -> Callable[[ClimberPlant], None]:
    return lambda plant: plant.push((x, y))


def has_fallen(climber: TracedClimber, plant: ClimberPlant) -> bool:
    """Whether in truth no hook has a peg, or the body is as far from its aim as no climbing robot's is."""
    true, aim = plant.truth(), climber.body.aim
    pegs = plant.board.positions()
    free = np.hypot(*(true.tips[:, None] - pegs).transpose(2, 0, 1)).min() > OFF
    # what is believed is off the truth by the play of the joints, so the truth gets as much more
    astray = np.hypot(*(true.pose[:2] - aim[:2])) > ASTRAY + PLAY or abs(true.pose[2] - aim[2]) > TURNED
    return bool(free or astray)


@pytest.mark.parametrize("after", [0.6, 1.3, 2.1])
@pytest.mark.parametrize(
    "spoil",
    [
        without_pegs,
        pushed(0.0, 400.0),
        pushed(0.0, -600.0),
        pushed(-300.0, 0.0),
        pushed(400.0, 0.0),
    ],
    ids=["no pegs", "up", "down", "left", "right"],
)
def test_a_fall_is_told_within_a_fifth_of_a_second_and_the_log_goes_up_to_it(
    spoil: Callable[[ClimberPlant], None], after: float
) -> None:
    climber, plant = on_the_ladder()
    climber.wait(after)
    spoil(plant)
    fell: float | None = None
    told = False
    while not told and climber.time < after + 2.0:
        try:
            climber.tick()
        except FallenError:
            told = True
        if fell is None and has_fallen(climber, plant):
            fell = climber.time
        if fell is not None:
            assert told or climber.time - fell < 0.2
    assert told or spoil is not without_pegs  # a push need not take a good climber off its holds
    trace = climber.trace()
    assert trace.time[-1] == climber.time
    np.testing.assert_allclose(np.diff(trace.time)[:-1], 0.02)
    assert trace.true_pose is not None
    np.testing.assert_array_equal(trace.true_pose[-1], plant.truth().pose)


@pytest.mark.parametrize("push", [(0.0, 0.0), (0.0, 20.0), (0.0, 40.0), (0.0, 60.0), (60.0, 0.0), (0.0, -60.0)])
def test_a_robot_that_is_pushed_or_lifted_but_not_off_its_holds_has_not_fallen(push: tuple[float, float]) -> None:
    climber, plant = on_the_ladder()
    climber.wait(0.6)
    plant.push(push)
    climber.wait(0.5)
    plant.push((0.0, 0.0))
    climber.wait(1.0)
    assert climber.fall.carried > 0.5 * climber.robot.weight


ALL: Final = slice(None)
ONE: Final = (0, 1)
"""Joints that turn."""


@pytest.mark.parametrize(("rate", "turns", "hangs", "told"), [
    (0.0, ALL, False, False), (0.02, ALL, False, False), (0.07, ALL, False, False), (0.5, ALL, False, True),
    (0.5, ONE, False, False),
    (0.0, ONE, True, False), (0.02, ONE, True, False), (0.07, ONE, True, True), (0.5, ONE, True, True),
])  # fmt: skip
def test_a_robot_that_stands_still_has_not_fallen_whatever_its_tips_feel(
    rate: float, turns: slice | tuple[int, int], hangs: bool, told: bool
) -> None:
    """A link of it lies on a hold, or the friction of joints that do not turn bears it; where nothing does, what its motors bore the weight
    with turns their joints at once."""
    climber, _ = on_the_ladder()
    climber.wait(0.6)
    body = climber.body
    body.qd[:] = 0.0
    body.qd[turns] = rate
    for i, leg in enumerate(body.legs):  # what the limbs themselves take, and a tenth of the weight at one tip
        friction, damping = (np.array((leg[key + "1"], leg[key + "2"])) for key in ("friction", "damping"))
        rub = damping * body.qd[i] + friction * np.clip(body.qd[i] / SLOW, -1.0, 1.0)
        body.torques[i] = weight_loads(leg, body.q[i], body.pose[2]) + rub
    body.torques[0] += body.turned_by_joints(0).T @ (0.0, -0.1 * climber.robot.weight)
    if hangs:
        climber.body.tasks[0].mode = "hang"
    assert any(climber.fall.see() for _ in range(100)) is told


def test_the_tips_feel_the_weight_and_so_they_do_while_a_limb_climbs() -> None:
    climber, _ = on_the_ladder()
    climber.wait(0.6)
    up = -climber.fall.forces[:2, 1].sum()
    assert up == pytest.approx(climber.robot.weight, rel=0.25)  # dry friction of four joints bears the rest
    least: list[float] = []
    see = climber.fall.see

    def noted() -> bool:
        falls = see()
        least.append(climber.fall.loose)
        return falls

    climber.fall.see = noted  # type: ignore[method-assign]
    assert grab(climber, 0, 6, elbow=-1).held
    assert max(least) < 0.02


def test_a_body_that_a_push_pins_far_from_its_aim_is_told_with_its_hooks_still_on() -> None:
    climber, plant = on_the_ladder()
    climber.wait(0.6)
    plant.push((100.0, 200.0))
    with pytest.raises(FallenError, match=r"stays .* off its aim"):
        climber.wait(4.0)
    pegs = plant.board.positions()[[3, 2, 1]]
    assert np.hypot(*(plant.truth().tips - pegs).T).max() < OFF
