"""Equation 19, with and without limits, against linear algebra written out."""

from typing import Any

import numpy as np
import pytest
from walkers import ROBOTS, hoshino, random_q, switch

from clamber.families.walker.control.cooperative.cooperator import Cooperator
from clamber.families.walker.control.cooperative.freedoms import BODY, FreedomsError, freedoms_of, weights_of
from clamber.families.walker.control.cooperative.limits import chain_of
from clamber.families.walker.control.cooperative.planted_feet import PlantedFeet
from clamber.families.walker.control.cooperative.scratch import make_scratch, see_measure, see_tool
from clamber.families.walker.control.cooperative.settings import Cooperation, CooperationError, own_speeds
from clamber.families.walker.robot import WalkerRobot
from clamber.types import Floats

SPEEDS = np.array([0.05, 0.05, 0.02, 0.15, 0.10, 0.10, 0.35, 0.35, 0.35, 0.35])
CASES = [(name, dof) for name in ROBOTS for dof in BODY if (name, dof) != ("one link", "arm")]
"""An arm of two joints alone cannot move its tool at will: there is no V and no inverse."""
TOOL_SPEEDS = np.array([0.10, 0.12, 0.08])


def law(robot: WalkerRobot, **settings: Any) -> Cooperator:
    assert robot.arm is not None
    n = robot.arm.n_joints
    speeds = np.array([*SPEEDS[:6], *np.full(n, 0.35)])
    made = Cooperation(**{"speeds": speeds, "tool_speeds": TOOL_SPEEDS, "limited": False, **settings})
    return Cooperator(robot, made, PlantedFeet(robot=robot, support="y", pose=np.array([0, 0, 0.4, 0, 0, 0])))


def gradient_of(robot: WalkerRobot, q: Floats, speeds: Floats, tool_speeds: Floats) -> tuple[Floats, Floats]:
    """J and dV/dq^ of a chain with such speeds; both are tested elsewhere."""
    assert robot.arm is not None
    w = make_scratch(robot.arm.n_joints)
    see_tool(chain_of(robot, balance=0.0), q, w)
    see_measure(speeds, tool_speeds, w)
    return w.jacobian.copy(), w.gradient.copy()


def plain_equation_19(
    robot: WalkerRobot, q: Floats, speeds: Floats, velocity: Floats, gain: float, form: str
) -> Floats:
    """As it is written, with numpy's pseudo-inverse."""
    jacobian, xi = gradient_of(robot, q, speeds, TOOL_SPEEDS)
    if form == "as printed":
        xi = gradient_of(robot, q, np.ones(q.size), np.ones(3))[1]
    from_q, to_v = np.diag(speeds), np.diag(1.0 / TOOL_SPEEDS)
    scaled = to_v @ jacobian @ from_q
    inverse = np.linalg.pinv(scaled)
    out: Floats = from_q @ inverse @ to_v @ velocity
    out += from_q @ (np.eye(q.size) - inverse @ scaled) @ xi * gain
    return out


@pytest.mark.parametrize("form", ["right", "as printed"])
@pytest.mark.parametrize(("name", "dof"), CASES)
def test_a_step_is_equation_19(name: str, form: str, dof: str) -> None:
    robot = ROBOTS[name]
    assert robot.arm is not None
    n = robot.arm.n_joints
    weights = weights_of(dof, n)  # type: ignore[arg-type]
    made = law(robot, gain=0.7, feedback=1.5, form=form)
    for seed in range(5):
        q = random_q(robot, seed)
        rng = np.random.default_rng(seed)
        target, velocity = made.place(q) + rng.uniform(-0.1, 0.1, 3), rng.uniform(-0.1, 0.1, 3)
        step = made.step(q, target, velocity, weights)
        speeds = weights * np.array([*SPEEDS[:6], *np.full(n, 0.35)])
        wanted = velocity + 1.5 * (target - made.place(q))
        rates = plain_equation_19(robot, q, speeds, wanted, 0.7, form)
        np.testing.assert_allclose((step.q - q) / 0.02, rates, atol=1e-9 * max(1.0, np.abs(rates).max()))
        assert not (step.q - q)[weights == 0.0].any()


def test_the_right_form_never_lowers_the_measure_and_the_printed_one_often_does() -> None:
    """The gradient's part alone (the tool rests): V rises at the rate k_p |(I - J^+ J^) dV/dq^|^2."""
    robot = hoshino()
    lowered = {"right": 0, "as printed": 0}
    count = 200
    for form in lowered:
        made = law(robot, gain=1.0, feedback=0.0, form=form, period=1e-6)
        ones = np.ones(10)
        for seed in range(count):
            q = random_q(robot, seed, tilt=0.17)
            before = made.measure(q, ones)
            after = made.step(q, np.zeros(3), np.zeros(3), ones).q
            jacobian, xi = gradient_of(robot, q, SPEEDS, TOOL_SPEEDS)
            scaled = jacobian * SPEEDS / TOOL_SPEEDS[:, None]
            rise = (made.measure(after, ones) - before) / 1e-6
            if form == "right":
                rest = xi - np.linalg.pinv(scaled) @ scaled @ xi
                assert rise == pytest.approx(rest @ rest, rel=1e-3, abs=1e-6)
            lowered[form] += rise < -1e-6
    assert lowered["right"] == 0
    assert 0.02 * count < lowered["as printed"] < 0.6 * count


@pytest.mark.parametrize("dof", ["arm", "height", "all"])
def test_with_no_limit_near_the_programme_is_equation_19(dof: str) -> None:
    robot = hoshino()
    q = np.array([0.0, 0.0, 0.35, 0.0, 0.0, 0.0, 0.2, 1.1, -1.0, -0.9])
    settings = {"gain": 0.05, "softness": 1e-6, "approach": 20.0}
    speeds = own_speeds(robot)
    made = law(robot, speeds=speeds, tool_speeds=TOOL_SPEEDS, limited=True, **settings)
    weights = weights_of(dof, 4)  # type: ignore[arg-type]
    if dof != "all":
        made.stand(PlantedFeet(robot=robot, support="delta", pose=q[:6]))
    rng = np.random.default_rng(2)
    for _ in range(10):
        velocity = rng.uniform(-0.003, 0.003, 3)
        step = made.step(q, made.place(q), velocity, weights)
        assert step.share == 1.0
        assert step.tight == ()
        rates = plain_equation_19(robot, q, weights * speeds, velocity, 0.05, "right")
        np.testing.assert_allclose((step.q - q) / 0.02, rates, atol=1e-8)


def test_freedoms_are_switched_off_at_both_ends() -> None:
    """With a speed of 0 in the front T_q^-1 only, the tool would get part of its motion from a freedom that rests."""
    robot = hoshino()
    made = law(robot, gain=1.0, feedback=0.0)
    q, velocity = random_q(robot, 4), np.array([0.02, -0.01, 0.03])
    for freedoms, body in BODY.items():
        weights = weights_of(freedoms, 4)
        rates = (made.step(q, np.zeros(3), velocity, weights).q - q) / 0.02
        jacobian, _ = gradient_of(robot, q, np.ones(10), np.ones(3))
        np.testing.assert_allclose(jacobian @ rates, velocity, atol=1e-10)
        assert not rates[[k for k in range(6) if k not in body]].any()


@pytest.mark.parametrize("limited", [False, True])
def test_switching_is_smooth_in_time(limited: bool) -> None:
    """Rates change from step to step by no more than the switching's own pace, twice as fast a clock halves the change."""
    robot = hoshino()
    q0 = np.array([0.0, 0.0, 0.35, 0.0, 0.0, 0.0, 0.2, 1.1, -1.0, -0.9])
    arm, everything = weights_of("arm", 4), weights_of("all", 4)
    changes = {}
    for period in (0.02, 0.01):
        made = law(robot, speeds=own_speeds(robot), limited=limited, gain=1.0, period=period)
        q, rates = q0.copy(), []
        for k in range(round(3.0 / period)):
            weights = switch(arm, everything, (k * period - 0.5) / 1.0)
            after = made.step(q, made.place(q), np.array([0.004, 0.004, -0.002]), weights).q
            rates.append((after - q) / period)
            q = after
        steps = np.abs(np.diff(rates, axis=0)).max(axis=1)
        changes[period] = steps.max()
        body = np.abs(np.array(rates)[:, :6]).max(axis=1)
        assert body[: round(0.5 / period)].max() == 0.0
        assert body[-1] > 1e-4
    assert changes[0.01] < 0.65 * changes[0.02]


def test_the_ends_of_a_switching_are_the_sets_themselves() -> None:
    arm, everything = weights_of("arm", 4), weights_of("all", 4)
    np.testing.assert_array_equal(switch(arm, everything, -0.5), arm)
    np.testing.assert_array_equal(switch(arm, everything, 1.5), everything)
    np.testing.assert_allclose(switch(arm, everything, 0.5)[:6], 0.5)
    near = 1e-4
    assert switch(arm, everything, near)[0] < 11 * near**3


def test_sets_are_named_by_their_degrees_of_freedom() -> None:
    assert [freedoms_of(dof, 4) for dof in (4, 5, 7, 10)] == list(BODY)
    assert freedoms_of(12, 6) == "all"
    with pytest.raises(FreedomsError, match="no set has 6 degrees of freedom; with this arm there are 4, 5, 7, 10"):
        freedoms_of(6, 4)


def test_feedback_takes_back_the_drift_of_the_open_loop() -> None:
    """The paper's open loop drifts: 0.2 mm over 0.38 m at 20 ms; with feedback the error stays far below."""
    robot = hoshino()
    q0 = np.array([0.0, 0.0, 0.40, 0.0, 0.0, 0.0, 0.2, 1.1, -1.0, -0.9])
    way, lasts, period = np.array([0.14, 0.12, -0.22]), 20.0, 0.02
    errors = {}
    for feedback in (0.0, 2.0):
        made = law(robot, tool_speeds=np.full(3, 0.1), gain=1.0, feedback=feedback)
        q, start = q0.copy(), made.place(q0)
        for k in range(round(lasts / period)):
            u = k * period / lasts
            share = u * u * u * (10 - 15 * u + 6 * u * u)
            speed = 30 * u * u * (1 - u) ** 2 / lasts
            q = made.step(q, start + share * way, speed * way, np.ones(10)).q
        errors[feedback] = np.linalg.norm(made.place(q) - start - way)
    assert 2e-5 < errors[0.0] < 5e-4
    assert errors[2.0] < 0.1 * errors[0.0]


def test_speeds_of_single_freedoms_follow_from_actuators_and_legs() -> None:
    """The data's own numbers: 9.5 mm/s, 5 mm/s, 0.0436 rad/s by the published turning speed."""
    speeds = own_speeds(hoshino())
    assert speeds[1] == pytest.approx(0.00947)
    assert speeds[0] == pytest.approx(0.00947 / np.cos(np.radians(30)))
    assert speeds[2] == pytest.approx(0.005)
    assert speeds[3] == pytest.approx(0.0436, rel=0.06)
    assert speeds[4] == pytest.approx(0.005 / (0.2384 * np.cos(np.radians(30))))
    assert speeds[5] == pytest.approx(0.005 / 0.2384)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"gain": -1.0}, "gain = -1.0: must be a finite number, 0 or more"),
        ({"period": 0.0}, "period = 0.0: must be over 0 s"),
        ({"feedback": 60.0}, "feedback = 60.0: must be at most 50 /s"),
        ({"tool_speeds": np.zeros(3)}, "tool_speeds"),
        ({"form": "printed"}, "form = 'printed'"),
    ],
)
def test_a_setting_that_cannot_be_is_named(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(CooperationError, match="^" + words[:20].replace("(", ".")) as error:
        law(hoshino(), **changes)
    assert words in str(error.value)


def test_a_freedom_that_the_feet_hold_may_not_take_part() -> None:
    made = law(hoshino(), limited=True)
    made.stand(PlantedFeet(robot=hoshino(), support="delta", pose=np.array([0, 0, 0.4, 0, 0, 0])))
    with pytest.raises(CooperationError, match="unless the Y-frame alone stands"):
        made.check_weights(np.ones(10))
