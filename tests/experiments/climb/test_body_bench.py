"""The body on two limbs: what holds it, how stiffly, and what it does when it is led or pushed."""

from dataclasses import replace

import numpy as np
import pytest

from clamber.errors import UnknownNameError
from clamber.families.climber.execution.body_gains import BodyGains
from clamber.families.climber.execution.limb_task import LimbTask
from clamber.families.climber.execution.whole_body import WholeBody
from clamber.families.climber.trials.body_bench import ANGLES, BodyEntry, measure_body, push_trials, run_body
from clamber.families.climber.trials.body_entries import (
    CONTROLS,
    body_stiffness,
    make_entries,
    match_body,
    read_triple,
    tip_wrench,
)
from clamber.families.climber.trials.body_stand import BodyStand, bench_flaws, circle, ladder_stand, push, push_up
from clamber.sim.limb_flaws import LimbFlaws
from clamber.sim.plant_rules import PlantError
from clamber.types import Floats
from tiers import first_fast

FREE = LimbFlaws(friction=0.0, damping=0.0, physics_rate=1000.0)
REFERENCE = BodyGains(kp=(400.0, 400.0, 40.0), kd=(20.0, 20.0, 2.0), mapping="thesis", limit="none", weight_fed=1.0)
TABLE_4_1 = BodyGains(kp=(100.0, 50.0, 10.0), kd=(10.0, 5.0, 1.0), mapping="thesis", limit="thesis", alpha=0.0)
PINNED = ladder_stand(fixed=True, below=0.05)


def closed_form(stand: BodyStand, gains: BodyGains) -> Floats:
    """Sum over the limbs of G^T S B K_p: SCCT's stiffness at each tip between the maps of motion and of pulls."""
    body = WholeBody(stand.robot, period=0.005, gains=gains)
    q = stand.angles(stand.pose)
    places = {hold.number: np.array((hold.x, hold.y)) for hold in stand.board.holds}
    arms = {name: places[number] - stand.pose[:2] for name, number in stand.holds.items()}
    (x1, y1), (x2, y2) = arms["right"], arms["left"]
    half, wide = (y1 + y2) / 2, x1 - x2
    shares = {
        "right": np.array([[0.5, 0, 0], [half / wide, -x2 / wide, 1 / wide]]),
        "left": np.array([[0.5, 0, 0], [-half / wide, x1 / wide, -1 / wide]]),
    }
    total = np.zeros((3, 3))
    for i, limb in enumerate(stand.robot.limbs):
        if limb.name not in arms:
            continue
        x, y = arms[limb.name]
        motion = np.array([[1, 0, -y], [0, 1, x]])  # of a point of the body at the hold
        into = shares[limb.name] if gains.mapping == "thesis" else motion
        chain, turn = body.chains[i], limb.port_angle
        rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        inverse = np.linalg.inv(chain.jacobian(q[i])[:2])
        stiffness = rotation @ inverse.T @ np.diag(chain.joints["share"]) @ inverse @ rotation.T
        total += motion.T @ stiffness @ into @ np.diag(gains.kp)
    return total


@pytest.mark.parametrize("mapping", ["thesis", "kinematic"])
def test_the_bodys_stiffness_by_scct_is_the_closed_form(mapping: str) -> None:
    gains = replace(REFERENCE, mapping=mapping)
    ours = body_stiffness(PINNED, gains)
    np.testing.assert_allclose(ours, closed_form(PINNED, gains), atol=1e-5 * np.abs(ours).max())


def test_jacobian_transpose_and_the_coordinated_scheme_have_the_stiffness_of_their_gains() -> None:
    for gains in (
        replace(REFERENCE, law="jacobian-transpose"),
        replace(REFERENCE, scheme="coordinated", leg_kp=700.0, leg_kd=20.0),
    ):
        np.testing.assert_allclose(body_stiffness(PINNED, gains), np.diag(gains.kp), atol=1e-3)


@pytest.mark.parametrize("how", ["yy", "mean", "diagonal"])
def test_matched_gains_hold_the_body_as_stiffly_in_that_sense(how: str) -> None:
    matched = match_body(PINNED, replace(REFERENCE, law="jacobian-transpose"), REFERENCE, how)  # type: ignore[arg-type]
    ours, theirs = np.diag(body_stiffness(PINNED, matched)), np.diag(body_stiffness(PINNED, REFERENCE))
    seen = np.array({"yy": [[0, 1, 0]], "mean": [[1, 1, 0]], "diagonal": [[1, 0, 0], [0, 1, 0]]}[how])
    np.testing.assert_allclose(seen @ ours, seen @ theirs, rtol=1e-4)
    assert ours[2] == pytest.approx(theirs[2], rel=1e-4)


def test_a_steady_push_moves_the_pinned_body_by_force_over_stiffness() -> None:
    flaws = FREE.with_changes(damping=1.0)
    force = np.array((8.0, 3.0, 0.0))
    scenario = push(PINNED.pose, 0.005, force=(8.0, 3.0), seconds=4.0, half_sine=False, after=0.0)
    still = push(PINNED.pose, 0.005, force=(0.0, 0.0), seconds=4.0, half_sine=False, after=0.0)
    moved = run_body(PINNED, scenario, BodyEntry("scct", REFERENCE), flaws).trace.pose
    stood = run_body(PINNED, still, BodyEntry("scct", REFERENCE), flaws).trace.pose
    k = 200 + round(0.75 * 4.0 / 0.005)  # before the push goes
    np.testing.assert_allclose(
        (moved - stood)[k, :2], np.linalg.solve(body_stiffness(PINNED, REFERENCE), force)[:2], rtol=0.05
    )


def test_pinned_tips_stay_where_they_are_and_the_estimate_is_the_truth() -> None:
    scenario = circle(PINNED.pose, 0.005, radius=0.05, lap=6.0)
    for angle in ANGLES:
        trace = run_body(PINNED, scenario, BodyEntry("scct", REFERENCE, angle), FREE).trace
        assert trace.off.max() < 2e-4
        np.testing.assert_allclose(trace.believed[1:], trace.pose[:-1], atol=5e-4)


@pytest.mark.parametrize("lap", [12.5, 6.0])
def test_scct_leads_the_flawless_pinned_body_round_its_circle(lap: float) -> None:
    scenario = circle(PINNED.pose, 0.005, radius=0.05, lap=lap)
    told = measure_body(run_body(PINNED, scenario, BodyEntry("scct", REFERENCE), FREE), scenario)
    assert told.radial_rms is not None
    assert told.radial_rms < 0.01 * scenario.radius
    stiffer = replace(REFERENCE, kp=(1600.0, 1600.0, 160.0), kd=(80.0, 80.0, 8.0))
    better = measure_body(run_body(PINNED, scenario, BodyEntry("scct", stiffer), FREE), scenario)
    assert better.radial_rms is not None
    assert better.radial_rms == pytest.approx(told.radial_rms / 4, rel=0.1)  # four times as stiff


@pytest.mark.parametrize("name", first_fast(CONTROLS[::-1], 4))
def test_every_control_holds_the_pinned_body_and_leads_it(name: str) -> None:
    (entry,) = make_entries([name], REFERENCE, PINNED, "diagonal")
    still = push(PINNED.pose, 0.005, force=(0.0, 0.0), seconds=1.0)
    held = measure_body(run_body(PINNED, still, entry, LimbFlaws(physics_rate=1000.0)), still)
    sag = PINNED.robot.weight / entry.gains.kp[1] if entry.gains.scheme == "coordinated" else 0.0
    assert held.rest < 2e-3 + 1.2 * sag  # friction keeps what little is left [m]
    assert held.turn_max < np.radians(0.5)
    scenario = circle(PINNED.pose, 0.005, radius=0.03, lap=8.0)
    led = measure_body(run_body(PINNED, scenario, entry, LimbFlaws(physics_rate=1000.0)), scenario)
    assert led.behind_rms < 5e-3 + 1.2 * sag
    assert led.turn_max < np.radians(1.5)


def test_a_push_from_the_other_side_is_the_mirror_image() -> None:
    stand = replace(PINNED, rest={"bottom": (0.0, 0.0)})  # the folded limb is not symmetric
    runs = [
        run_body(stand, push(stand.pose, 0.005, force=(side * 30.0, 0.0), seconds=0.5), BodyEntry("", REFERENCE), FREE)
        for side in (1, -1)
    ]
    ours, theirs = (run.trace.pose - stand.pose for run in runs)
    assert np.abs(ours[:, 0]).max() > 1e-3
    np.testing.assert_allclose(ours * (-1, 1, -1), theirs, atol=2e-6)


def test_the_limit_of_the_thesis_keeps_hooks_on_through_pushes_from_either_side() -> None:
    flaws = bench_flaws("nominal")
    trials = push_trials(ladder_stand(), BodyEntry("scct", TABLE_4_1), flaws, force=(60.0, 0.0), seconds=0.5, trials=6)
    assert {trial.side for trial in trials} == {1, -1}
    assert all(trial.measures.unhooked_at is None and trial.measures.off_max < 2e-3 for trial in trials)


@pytest.mark.parametrize("kp_x", [25.0, 50.0])
def test_a_soft_body_rests_under_the_printed_limit_and_sways_with_an_alpha_beyond_it(kp_x: float) -> None:
    """Section 4.4.2: the thesis asks for accelerations of at least alpha, 0 or more; its own gains are for 0."""
    stand, sways = ladder_stand(), {}
    scenario = push(stand.pose, 0.005, force=(8.0, 0.0), seconds=0.2, after=5.0)
    for alpha in (0.0, 0.3):
        gains = replace(TABLE_4_1, kp=(kp_x, 50.0, 10.0), kd=(0.1 * kp_x, 5.0, 1.0), alpha=alpha)
        trace = run_body(stand, scenario, BodyEntry("", gains), bench_flaws("ideal")).trace
        sways[alpha] = float(np.ptp(trace.pose[-400:, 0]))
    assert sways[0.0] < 1e-3 < 20e-3 < sways[0.3]


def test_a_hook_that_comes_off_is_told() -> None:
    stand = ladder_stand()
    scenario = push(stand.pose, 0.005, force=(400.0, 0.0), seconds=0.5)
    told = measure_body(run_body(stand, scenario, BodyEntry("", TABLE_4_1), bench_flaws("nominal")), scenario)
    assert told.unhooked_at is not None
    assert 0.0 < told.unhooked_at < 1.0


def test_a_push_up_ends_where_it_is_to() -> None:
    stand = ladder_stand()
    scenario = push_up(stand.pose, 0.005, height=0.075, seconds=0.5)
    told = measure_body(
        run_body(stand, scenario, BodyEntry("", replace(TABLE_4_1, limit="shared")), bench_flaws("nominal")), scenario
    )
    assert told.unhooked_at is None
    assert told.rest < 5e-3


def test_coordinated_forces_balance_and_press_as_wished() -> None:
    stand = PINNED
    gains = replace(REFERENCE, scheme="coordinated", leg_kp=1e6, leg_kd=0.0, inside=8.0, weight_fed=0.0)
    body = WholeBody(stand.robot, period=0.005, gains=gains, backlash=0.0)
    places = {hold.number: np.array((hold.x, hold.y)) for hold in stand.board.holds}
    for i, limb in enumerate(stand.robot.limbs):
        number = stand.holds.get(limb.name, 0)
        body.assign(i, LimbTask("stance", number, places[number].copy()) if number else LimbTask("swing_joint"))
    pose = stand.pose + np.array((0.01, -0.02, 0.05))
    body.pose[:], body.aim[:] = pose, stand.pose
    body.see(stand.angles(pose), np.zeros((3, 2)), float(pose[2]), 0.0)
    torques = body.command()
    wrenches = [tip_wrench(body, i, torques[i]) for i in (0, 1)]
    np.testing.assert_allclose(sum(wrenches), np.array(gains.kp) * (stand.pose - pose), atol=1e-6)
    line = places[3] - places[4]
    # both springs in series: what reaches the hold is a little more than wished where the limb's is stiffer by far
    pressed = -float(wrenches[1][:2] @ line) / np.linalg.norm(line)
    assert abs(pressed) == pytest.approx(8.0 * (1.0 + 1e6 / 20_000.0), rel=1e-6)


def test_unknown_controls_and_gains_are_named() -> None:
    with pytest.raises(UnknownNameError, match="leg-by-leg:scct"):
        make_entries(["leg-by-leg:sct"], REFERENCE, PINNED, "none")
    for text in ("1,2", "1,2,x", "1,2,-3"):
        with pytest.raises(PlantError, match="kp"):
            read_triple("kp", text)
    with pytest.raises(PlantError, match="lap"):
        circle(PINNED.pose, 0.005, radius=0.05, lap=0.0)
