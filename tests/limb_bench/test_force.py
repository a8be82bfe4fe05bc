"""Forces on a wall: who holds 20 N, by how much friction spoils it, and what closed forms say."""

import json
import math
from functools import cache

import numpy as np
import pytest

from clamber.cli import main
from clamber.errors import UnknownNameError
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.force import ForceResult, force_entries, force_gains, run_force
from clamber.limb_bench.measures import measure_force
from clamber.limb_bench.scenario import ForceTask, ScenarioError, direction, force_scenario
from clamber.sim.limb_flaws import LimbFlaws

COMPENSATED = (
    "hybrid / model",
    "hybrid / wrist",
    "hybrid / base",
    "implicit-force / model",
    "admittance / wrist+model",
)
NOMINAL = LimbFlaws(backlash=math.radians(2.0), encoder_counts=400, delay=1)


TURNED = pytest.param(0.0, marks=pytest.mark.slow)
ASKEW = pytest.param(30.0, marks=pytest.mark.slow)


@cache
def result(label: str, angle: float = 90.0, friction: float = 1.0) -> ForceResult:
    """One law on the limb that the bench takes, with nothing but friction."""
    leg, flaws = bench_limb(), LimbFlaws(friction=friction)
    task = ForceTask(angle=math.radians(angle))
    law, way = label.split(" / ")
    return run_force(leg, task, force_entries(leg, task, flaws, [law], [way]), flaws)


@pytest.mark.parametrize("label", COMPENSATED)
@pytest.mark.parametrize("angle", [90.0, TURNED])
def test_with_friction_compensated_20_n_are_held_within_1_n_without_losing_contact(angle: float, label: str) -> None:
    found = result(label, angle)
    held = found.rows[0]
    force, time = held.run.force_into(found.task.angle), held.run.trace.time
    late = force[time >= found.scenario.settle]
    assert np.abs(late - 20.0).max() <= 1.0
    assert late.min() > 0.0
    assert held.measures.held and held.measures.contact == 1.0


@pytest.mark.parametrize("label", ["hybrid / base", "admittance / wrist"])
def test_a_sensor_learns_friction_anew_where_the_slide_starts(label: str) -> None:
    """Feeding the friction of the wanted motion forward takes a part of that error away."""
    alone, helped = (result(f"{label}{more}").rows[0].measures for more in ("", "+model"))
    assert max(alone.worst_standing, alone.worst_sliding) <= 1.0
    assert alone.worst > 1.5 * max(alone.worst_standing, alone.worst_sliding)
    assert helped.worst < 0.9 * alone.worst


def friction_error(angle: float, at: int) -> tuple[float, float]:
    r"""Error that friction may make of a hybrid force at rest, and that it makes while sliding, at a tick [N].

    At rest tau = J^T n f + K' J^-1 t p = J^T n F + tau_f, with p free: F - f = -n^T J K'^-1 tau_f / (n^T J K'^-1 J^T n).
    """
    found = result("hybrid / none", angle)
    trace = found.rows[0].run.trace
    joints = trace.chain.joints
    into = direction(found.task.angle)
    q, qd = trace.true[at, 0]
    jacobian = trace.chain.jacobian(q)[:2]
    weigh = into @ jacobian / joints["share"]
    mobility = weigh @ jacobian.T @ into
    most = np.abs(weigh) @ joints["friction"] / mobility
    moving = -(weigh @ (joints["friction"] * np.sign(qd) + joints["damping"] * qd)) / mobility
    return float(most), float(moving)


@pytest.mark.parametrize("angle", [90.0, TURNED, ASKEW])
def test_without_compensation_the_error_is_told_and_friction_bounds_it(angle: float) -> None:
    found = result("hybrid / none", angle)
    loose = found.rows[0]
    force, time = loose.run.force_into(found.task.angle), loose.run.trace.time
    still, _ = found.task.judged(time)
    assert loose.measures.worst_standing == np.abs(force[still] - 20.0).max()
    assert loose.measures.worst > 1.0 and not loose.measures.held
    assert loose.measures.worst > 3.0 * result("hybrid / model", angle).rows[0].measures.worst
    for tick in np.flatnonzero(still)[::50]:
        assert abs(force[tick] - 20.0) <= friction_error(angle, tick)[0] + 0.05


@pytest.mark.parametrize("angle", [90.0, ASKEW])
def test_sliding_friction_spoils_the_force_by_what_statics_say(angle: float) -> None:
    found = result("hybrid / none", angle)
    force = found.rows[0].run.force_into(found.task.angle)
    middle = round((found.task.slide_from + 0.5 * found.task.sliding) / found.flaws.period)
    _, error = friction_error(angle, middle)
    assert abs(error) > 2.0
    assert force[middle] - 20.0 == pytest.approx(error, abs=0.25)


@pytest.mark.parametrize("label", ["hybrid / none", "implicit-force / none", "admittance / none"])
def test_without_friction_all_laws_hold_the_force_at_rest(label: str) -> None:
    found = result(label, friction=0.0)
    force, time = found.rows[0].run.force_into(found.task.angle), found.rows[0].run.trace.time
    assert np.abs(force[time > found.task.slide_from - 0.2][:30] - 20.0).max() < 0.05
    assert found.rows[0].measures.held


@pytest.mark.parametrize("ratio", [0.5, 2.0, 4.0])
def test_a_wrong_stiffness_spoils_implicit_force_by_the_closed_form(ratio: float) -> None:
    """n^T J K'^-1 J^T n (F - f) = K_p (f / k_e - F / k): the spring of the law against that of the wall."""
    leg = bench_limb()
    flaws = LimbFlaws(friction=0.0)
    task = ForceTask(believed_stiffness=ratio * 1e4, slide=0.0)
    (only,) = run_force(leg, task, force_entries(leg, task, flaws, ["implicit-force"], ["none"]), flaws).rows
    trace = only.run.trace
    into = direction(task.angle)
    jacobian = trace.chain.jacobian(trace.true[-1, 0, 0])[:2]
    mobility = into @ jacobian / trace.chain.joints["share"] @ jacobian.T @ into
    wanted = (mobility + 200.0 / task.task_stiffness) / (mobility + 200.0 / task.stiffness) * task.force
    assert abs(wanted - 20.0) > 0.5
    assert only.run.force_into(task.angle)[-1] == pytest.approx(wanted, abs=0.05)


@pytest.mark.parametrize("believed", [60.0, 80.0, 125.0])
def test_a_wrong_angle_spoils_a_hybrid_force_by_the_closed_form(believed: float) -> None:
    """J^T n F = J^T n' f + K' J^-1 t' p at rest: F = f n'^T A n' / n'^T A n, with A = J K'^-1 J^T and n', t' as believed."""
    leg, flaws = bench_limb(), LimbFlaws(friction=0.0)
    task = ForceTask(believed_angle=math.radians(believed), slide=0.0)
    (only,) = run_force(leg, task, force_entries(leg, task, flaws, ["hybrid"], ["none"]), flaws).rows
    trace = only.run.trace
    jacobian = trace.chain.jacobian(trace.true[-1, 0, 0])[:2]
    mobility = jacobian / trace.chain.joints["share"] @ jacobian.T
    into, taken = direction(task.angle), direction(task.task_angle)
    wanted = task.force * (taken @ mobility @ taken) / (taken @ mobility @ into)
    assert abs(wanted - 20.0) > 0.5
    assert only.run.force_into(task.angle)[-1] == pytest.approx(wanted, abs=0.05)


@pytest.mark.parametrize("angle", [90.0, TURNED])
def test_with_two_degrees_of_backlash_a_sensed_force_is_still_held_at_rest(angle: float) -> None:
    leg = bench_limb()
    task = ForceTask(angle=math.radians(angle))
    entries = force_entries(leg, task, NOMINAL, ["hybrid"], ["wrist", "base"])
    for each in run_force(leg, task, entries, NOMINAL).rows:
        assert each.measures.worst_standing <= 1.0 and each.measures.contact == 1.0


def test_a_noisy_wrist_leaves_the_mean_force_right_and_its_seed_repeats() -> None:
    leg = bench_limb()
    task = ForceTask(slide=0.0)
    noisy = LimbFlaws(wrench_noise=0.5, seed=4)
    (each,) = run_force(leg, task, force_entries(leg, task, noisy, ["hybrid"], ["wrist"]), noisy).rows
    assert abs(each.measures.mean_error) < 0.3 and each.measures.contact == 1.0
    again = run_force(leg, task, force_entries(leg, task, noisy, ["hybrid"], ["wrist"]), noisy).rows[0]
    assert again.measures == each.measures


def test_gains_follow_the_wall_and_the_dead_time() -> None:
    leg = bench_limb()
    soft, stiff = (force_gains(leg, ForceTask(stiffness=k), LimbFlaws()) for k in (1e2, 1e6))
    late = force_gains(leg, ForceTask(stiffness=1e6), LimbFlaws(delay=3))
    assert soft.damping == pytest.approx(2.0 * math.sqrt(1e2 * soft.mass))
    assert stiff.damping / stiff.mass == pytest.approx(0.4 / (1.5 * 0.005))
    assert late.damping / stiff.damping == pytest.approx(1.5 / 4.5)
    jacobian, into = leg.chain.jacobian(leg.q0)[:2], direction(math.pi / 2)
    push = np.linalg.solve(leg.chain.inertia(leg.q0), jacobian.T @ into)
    assert soft.mass * (into @ jacobian @ push) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"force": 0.0}, "force"),
        ({"stiffness": -1.0}, "stiffness"),
        ({"tolerance": math.nan}, "tolerance"),
        ({"touch": 0.0}, "touch"),
        ({"stand": 0.5}, "stand"),
        ({"believed_stiffness": 0.0}, "believed_stiffness"),
    ],
)
def test_a_force_that_cannot_be_asked_for_is_refused_by_name(changes: dict[str, float], key: str) -> None:
    with pytest.raises(ScenarioError, match=f"force: {key} ="):
        ForceTask(**changes)


def test_a_wall_out_of_reach_is_refused() -> None:
    with pytest.raises(ScenarioError, match="wall"):
        force_scenario(bench_limb(), 200.0, ForceTask(angle=0.0, stiffness=1e2))


def test_an_unknown_way_is_refused_by_name() -> None:
    with pytest.raises(UnknownNameError, match="compensation is called 'prayer'"):
        force_entries(bench_limb(), ForceTask(), LimbFlaws(), [], ["prayer"])


def test_the_command_tells_in_json_what_was_measured(capsys: pytest.CaptureFixture[str], tmp_path) -> None:  # type: ignore[no-untyped-def]
    words = ["limb", "force", "-c", "hybrid", "--friction-compensation", "none", "--friction-compensation", "model"]
    picture = tmp_path / "force.png"
    with pytest.raises(SystemExit) as left:
        main([*words, "--json", "-q", "-o", str(picture)])
    assert left.value.code == 0
    told = json.loads(capsys.readouterr().out)
    assert [law["label"] for law in told["laws"]] == ["hybrid / none", "hybrid / model"]
    for law in told["laws"]:
        assert law["worst"] == pytest.approx(result(law["label"]).rows[0].measures.worst)
    assert picture.stat().st_size > 10_000


def test_the_command_leaves_with_1_if_nobody_held_the_force(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as left:
        main(["limb", "force", "-c", "hybrid", "--friction-compensation", "none", "-q"])
    assert left.value.code == 1
    assert "hybrid / none" in capsys.readouterr().out


def test_the_measures_are_of_the_true_force_whatever_the_sensor_says() -> None:
    found = result("hybrid / model")
    each = found.rows[0]
    assert measure_force(each.run, found.task) == each.measures
    assert each.measures.mean_error == pytest.approx(
        float(np.mean(each.run.force_into(found.task.angle)[each.run.trace.time >= found.scenario.settle]) - 20.0),
        abs=1e-6,
    )
