from dataclasses import replace
from functools import cache

import numpy as np
import numpy.typing as npt
import pytest

from clamber.control.identification.amplifier import amplifier_gain
from clamber.control.identification.joint import Drivetrain, backlash, identify_joint, rough_estimates
from clamber.control.identification.joint_fit import JointFit, _phi, fit_joint
from clamber.control.identification.samples import JointSamples, angle_noise, motion_of

INERTIA, DAMPING, FRICTION = 0.402, 0.7, 0.45
PERIOD = 0.005
Floats = npt.NDArray[np.float64]


def moved(torque: Floats, late: float = 0.0) -> JointSamples:
    """A joint under torques held for a period each, by small steps of equation 3.28 with stick; angles are `late` [s]."""
    return _moved(tuple(torque.tolist()), late)


@cache
def _moved(torques: tuple[float, ...], late: float, fine: int = 20) -> JointSamples:
    torque = np.array(torques)
    step = PERIOD / fine
    q, v, angles = 0.0, 0.0, []
    shift = round(late / step)
    for pull in np.repeat(torque, fine):
        angles.append(q)
        free = pull - DAMPING * v
        rate = (free - FRICTION * np.sign(v if v else free)) / INERTIA if v or abs(free) > FRICTION else 0.0
        new = v + step * rate
        if v and new * v <= 0.0:
            new = 0.0
        q, v = q + step * (v + new) / 2, new
    path = np.concatenate((np.zeros(shift), np.array(angles)))[: len(angles)]
    return JointSamples(name="joint", time=np.arange(torque.size) * PERIOD, angle=path[::fine], torque=torque)


def excitation(seconds: float = 24.0) -> Floats:
    time = np.arange(0.0, seconds, PERIOD)
    sign = np.where(np.floor(time / 6.0) % 2 == 0, 1.0, -1.0)
    steps = np.where(time % 6.0 < 3.0, 0.75, 1.1)
    sines = 0.25 * np.sin(5.0 * time) + 0.3 * np.sin(11.0 * time)
    return np.where(time < 12.0, sign * steps, sign * (0.9 + sines)) * (time % 6.0 < 5.3)


def fitted(samples: JointSamples, seed: int = 0) -> JointFit:
    assert samples.torque is not None
    return fit_joint(samples, motion_of(samples), samples.torque, None, seed)


def values(fit: JointFit) -> Floats:
    return np.array([np.nan if e.value is None else e.value for e in fit.estimates])


def test_the_window_function_has_integral_one_and_true_derivatives() -> None:
    width, t = 0.2, np.linspace(-0.15, 0.15, 30001)
    assert np.trapezoid(_phi(t, width, 0), t) == pytest.approx(1.0, rel=1e-9)
    nudge = 1e-6
    for k in (0, 1):
        numeric = (_phi(t + nudge, width, k) - _phi(t - nudge, width, k)) / (2 * nudge)
        np.testing.assert_allclose(_phi(t, width, k + 1), numeric, atol=1e-6 * np.abs(numeric).max())


def test_a_joint_without_noise_is_identified_to_a_thousandth() -> None:
    fit = fitted(moved(excitation()))
    np.testing.assert_allclose(values(fit)[:3], (INERTIA, DAMPING, FRICTION), rtol=2e-3)
    assert fit.estimates[3].value == pytest.approx(0.0, abs=1e-3)
    assert fit.lag == pytest.approx(PERIOD / 2, abs=1e-4)


@pytest.mark.parametrize("late", [0.005, 0.0125])
def test_a_late_sensor_is_told_and_does_no_harm(late: float) -> None:
    fit = fitted(moved(excitation(), late=late))
    assert fit.lag == pytest.approx(PERIOD / 2 + late, abs=1e-4)
    np.testing.assert_allclose(values(fit)[:3], (INERTIA, DAMPING, FRICTION), rtol=2e-3)


def test_a_mirrored_log_gives_the_same_joint_and_a_torque_in_other_units_scales_it() -> None:
    samples = moved(excitation())
    assert samples.torque is not None
    first = values(fitted(samples))
    mirrored = values(fitted(replace(samples, angle=-samples.angle, torque=-samples.torque)))
    np.testing.assert_allclose(mirrored[:3], first[:3], rtol=1e-6)
    scaled = values(fitted(replace(samples, torque=1000.0 * samples.torque)))
    np.testing.assert_allclose(scaled[:3], 1000.0 * first[:3], rtol=1e-5)


@pytest.mark.slow
def test_errors_are_as_large_as_the_scatter_over_noise() -> None:
    clean = moved(excitation())
    assert clean.torque is not None
    rng = np.random.default_rng(3)
    found, errors = [], []
    for seed in range(24):
        noisy = replace(
            clean,
            torque=clean.torque + 0.08 * rng.standard_normal(clean.torque.size),
            angle=clean.angle + 2e-5 * rng.standard_normal(clean.torque.size),
        )
        fit = fitted(noisy, seed)
        found.append(values(fit)[:3])
        errors.append([e.error for e in fit.estimates[:3]])
    scatter, told = np.std(found, axis=0, ddof=1), np.mean(errors, axis=0)
    # 24 runs tell a scatter within 15 % or so
    assert np.all(told > 0.6 * scatter)
    assert np.all(told < 1.7 * scatter)
    bias = np.abs(np.mean(found, axis=0) - (INERTIA, DAMPING, FRICTION))
    assert np.all(bias < 4.0 * scatter / np.sqrt(24) + 2e-3)


def test_a_wild_torque_here_and_there_does_no_harm() -> None:
    samples = moved(excitation())
    assert samples.torque is not None
    torque = samples.torque.copy()
    torque[::701] = 50.0
    np.testing.assert_allclose(
        values(fitted(replace(samples, torque=torque)))[:3], (INERTIA, DAMPING, FRICTION), rtol=0.02
    )


def test_uneven_times_are_evened_first() -> None:
    samples = moved(excitation())
    keep = np.sort(np.random.default_rng(0).choice(samples.time.size, int(0.9 * samples.time.size), replace=False))
    assert samples.torque is not None
    uneven = replace(samples, time=samples.time[keep], angle=samples.angle[keep], torque=samples.torque[keep])
    np.testing.assert_allclose(values(fitted(uneven.evened()))[:3], (INERTIA, DAMPING, FRICTION), rtol=0.03)


def test_what_a_log_cannot_tell_is_not_told() -> None:
    time = np.arange(0.0, 10.0, PERIOD)
    rng = np.random.default_rng(1)
    noise = 0.05 * rng.standard_normal(time.size)
    steady = JointSamples(name="steady", time=time, angle=0.5 * time, torque=0.8 + noise)
    fit = fitted(steady)
    assert [e.value for e in fit.estimates] == [None] * 4
    assert "speeds that change" in fit.estimates[0].needs
    still = JointSamples(name="still", time=time, angle=0.0 * time, torque=0.2 + noise)
    joint = identify_joint(still, motion_of(still), None, Drivetrain())
    assert all(e.value is None and e.needs for e in joint.estimates)
    one_way = moved(np.abs(excitation()))
    offset = fitted(one_way).estimates[3]
    assert (offset.value, offset.needs) == (None, "motion both ways")
    bare = replace(one_way, torque=None)
    told = {e.name: e for e in identify_joint(bare, motion_of(bare), None, Drivetrain()).estimates}
    assert "torque constant" in told["inertia"].needs
    assert "command voltage" in told["amplifier gain"].needs
    assert "behind the gear" in told["backlash"].needs


def test_the_thesiss_way_is_right_where_speeds_get_steady() -> None:
    time = np.arange(0.0, 16.0, PERIOD)
    torque = np.where(time % 4.0 < 3.5, np.choose((time // 4.0).astype(int) % 4, (0.8, -0.8, 1.2, -1.2)), 0.0)
    samples = moved(torque)
    rough = rough_estimates(samples, motion_of(samples), torque)
    assert len(rough.episodes) == 4
    assert rough.damping == pytest.approx(DAMPING, rel=0.03)
    assert rough.friction == pytest.approx(FRICTION, rel=0.03)
    assert rough.inertia == pytest.approx(INERTIA, rel=0.08)


def stalled(gain: float = 0.27, noise: float = 0.01, emf: float = 0.0) -> JointSamples:
    rng = np.random.default_rng(5)
    time = np.arange(0.0, 6.0, PERIOD)
    volts = np.floor(time / 0.5) - 4.0
    angle = 0.0 * time if emf == 0.0 else 0.3 * np.sin(3.0 * time)
    speed = np.zeros(time.size) if emf == 0.0 else 0.9 * np.cos(3.0 * time)
    current = gain * volts - emf * speed + 0.02 + noise * rng.standard_normal(time.size)
    return JointSamples(name="motor", time=time, angle=angle, command=volts, current=current)


def test_an_amplifiers_gain_is_the_slope_of_current_over_voltage_at_a_stall() -> None:
    samples = stalled()
    found = amplifier_gain(samples, motion_of(samples), None)
    assert found.value == pytest.approx(0.27, rel=0.01)
    assert found.error is not None and abs(found.value - 0.27) < 4 * found.error
    assert found.method == "stalled motor"


def test_a_motor_in_motion_does_not_count_back_emf_as_gain() -> None:
    samples = stalled(emf=0.4)
    found = amplifier_gain(samples, motion_of(samples), None)
    assert found.value == pytest.approx(0.27, rel=0.02)
    assert "no stall" in found.method


def test_a_sensed_torque_at_a_stall_gives_the_gain_whatever_friction_holds_back() -> None:
    samples = stalled()
    assert samples.current is not None
    held = 8.0 * samples.current - 0.5 * np.sign(samples.command)
    sensed = replace(samples, current=None, sensed_torque=held)
    assert amplifier_gain(sensed, motion_of(sensed), 8.0).value == pytest.approx(0.27, rel=0.02)
    assert amplifier_gain(sensed, motion_of(sensed), None).value is None


def play(width: float, noise: float, late: float = 0.0) -> tuple[JointSamples, Floats]:
    """A joint swung to and fro whose load is pushed along by the ends of the play."""
    rng = np.random.default_rng(2)
    time = np.arange(0.0, 20.0, PERIOD)
    angle, speed = 0.5 * np.sin(1.5 * time), 0.75 * np.cos(1.5 * time)
    load, behind = -width / 2, np.empty(time.size)
    for k, place in enumerate(angle):
        load = min(max(load, place - width / 2), place + width / 2)
        behind[k] = load
    behind += late * speed + noise * rng.standard_normal(time.size)
    return JointSamples(name="geared", time=time, angle=angle, output_angle=behind), speed


@pytest.mark.parametrize("late", [0.0, 0.005])
def test_play_is_the_width_of_the_hysteresis_even_where_one_sensor_is_late(late: float) -> None:
    samples, speed = play(0.035, 3e-4, late)
    found = backlash(samples, speed)
    assert found.value == pytest.approx(0.035, rel=0.02)


def test_play_below_the_noise_is_not_seen_and_play_on_one_side_is_not_told() -> None:
    samples, speed = play(0.0, 3e-4)
    none = backlash(samples, speed)
    assert none.value == 0.0
    assert none.high is not None and none.high < 5e-3
    assert backlash(replace(samples, output_angle=None), speed).value is None


def test_the_noise_of_an_angle_is_told_whatever_the_motion() -> None:
    time = np.arange(0.0, 10.0, PERIOD)
    rng = np.random.default_rng(0)
    angle = np.sin(2.0 * time) + 1e-4 * rng.standard_normal(time.size)
    assert angle_noise(angle) == pytest.approx(1e-4, rel=0.05)
