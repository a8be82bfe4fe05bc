"""Stances in space as a whole: laws that hold for every robot, gaps against dense points, and what a posture may depend on."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from clamber.families.spatial.execution.references import TipPath
from clamber.families.spatial.robot.chains import Chains
from clamber.families.spatial.robot.contact_kinds import build_contact, read_contact
from clamber.families.spatial.robot.contacts import Contact
from clamber.families.spatial.statics.checks import STANCE_CHECK, STANCE_CHECKS
from clamber.families.spatial.statics.collision_kernels import box_gap, limbs_gap, pair_gap, segment_gap
from clamber.families.spatial.statics.judging import Statics, rules_record
from clamber.families.spatial.statics.kinematics_kernels import limb_frames
from clamber.families.spatial.statics.records import WORK, robot_record
from clamber.families.spatial.statics.stance_kernels import swing_reach
from clamber.planning.problem.check import UNLIMITED
from clamber.types import Floats, Records
from plain_spatial import frames
from spatial_machines import arms, gripper, point_foot, random_stances, random_turn, spider

CLAMP = build_contact(read_contact("clamp")).contact()
MACHINES: dict[str, tuple[Chains, Contact]] = {
    "grippers": (spider(4), gripper(0.8, 9.0)),
    "feet": (spider(6), point_foot(0.8)),
    "clamps": (arms(3), CLAMP),
}
MACHINE = st.sampled_from(sorted(MACHINES))
SEED = st.integers(0, 2**32 - 1)
ONE = 1


def stance(machine: str, seed: int) -> tuple[Statics, Records, Records]:
    """One random stance, gravity towards the surface so that most are in balance."""
    chains, kind = MACHINES[machine]
    statics = Statics(chains, [kind] * len(chains.limb_names))
    rng = np.random.default_rng(seed)
    bodies, contacts = random_stances(statics, chains, ONE, rng)
    weight = 9.81 * chains.total_mass
    contacts["friction"] = rng.uniform(0.4, 0.8, contacts.shape)
    contacts["strength"] = rng.uniform(0.2, 1.0, contacts.shape) * weight
    bodies["wrench"] = rng.normal(size=(ONE, 6)) * weight * [0.02, 0.02, 0.02, 0.002, 0.002, 0.002]
    return statics, bodies, contacts


def share(statics: Statics, bodies: Records, contacts: Records) -> float:
    return float(statics.judge(bodies, contacts)[0]["s"][0])


@given(machine=MACHINE, seed=SEED)
@settings(max_examples=60)
def test_turning_and_moving_world_and_gravity_together_changes_no_margin(machine: str, seed: int) -> None:
    statics, bodies, contacts = stance(machine, seed)
    rng = np.random.default_rng(seed + 1)
    turn, move = random_turn(rng), rng.normal(size=3)
    others, theirs = bodies.copy(), contacts.copy()
    others["rotation"] = (turn @ bodies["rotation"].reshape(3, 3)).reshape(1, 9)
    others["place"] = bodies["place"] @ turn.T + move
    others["gravity"] = bodies["gravity"] @ turn.T
    others["wrench"] = np.concatenate([bodies["wrench"][:, :3] @ turn.T, bodies["wrench"][:, 3:] @ turn.T], axis=1)
    theirs["place"] = contacts["place"] @ turn.T + move
    theirs["normal"] = contacts["normal"] @ turn.T
    here, reasons = statics.judge(bodies, contacts)
    there, their_reasons = statics.judge(others, theirs)
    reached = STANCE_CHECK["equilibrium"] + 1  # forces of the best s need not be the only ones: s is
    assert there["margins"][0, :reached] == pytest.approx(here["margins"][0, :reached], abs=1e-7, nan_ok=True)
    assert there["s"] == pytest.approx(here["s"], abs=1e-7, nan_ok=True)
    if here["judged"][0]:
        assert there["centre"][0] == pytest.approx(turn @ here["centre"][0] + move, abs=1e-6)
    if abs(float(here["s"][0])) > 1e-6:
        assert (reasons == their_reasons).all()


@given(machine=MACHINE, seed=SEED, limb=st.integers(0, 2))
@settings(max_examples=60)
def test_letting_go_never_brings_balance(machine: str, seed: int, limb: int) -> None:
    """Of a share above 0 a hold may take some: what bears has to do so with s to spare."""
    statics, bodies, contacts = stance(machine, seed)
    fewer = contacts.copy()
    fewer["bears"][0, limb] = 0
    if share(statics, bodies, fewer) >= 0.0:
        assert share(statics, bodies, contacts) >= -1e-9


@given(machine=MACHINE, seed=SEED, gain=st.floats(1.0, 3.0), what=st.sampled_from(["friction", "strength", "torque"]))
@settings(max_examples=90)
def test_more_friction_pull_or_torque_never_hurts(machine: str, seed: int, gain: float, what: str) -> None:
    statics, bodies, contacts = stance(machine, seed)
    before = share(statics, bodies, contacts)
    if what == "torque":
        statics.robot["torque"] *= gain
    else:
        contacts[what] *= gain
    if before >= 0.0:
        assert share(statics, bodies, contacts) >= before - 1e-9


@given(machine=MACHINE, seed=SEED)
@settings(max_examples=40)
def test_margins_of_forces_are_those_of_the_wrenches(machine: str, seed: int) -> None:
    statics, bodies, contacts = stance(machine, seed)
    chains, kind = MACHINES[machine]
    judged, _ = statics.judge(bodies, contacts)
    if not judged["judged"][0] or not judged["s"][0] > -0.5:
        return
    force, moment = np.zeros(3), np.zeros(3)
    rotation, place = bodies["rotation"][0].reshape(3, 3), bodies["place"][0]
    for limb in range(statics.n_limbs):
        frame = judged["frame"][0, limb].reshape(3, 3) @ rotation.T
        wrench = judged["wrench"][0, limb]
        matrix, bound = kind.polytope(contacts["friction"][0, limb], contacts["strength"][0, limb])
        room = bound - matrix @ wrench
        for margin, name in enumerate(("slip", "grip", "moment")):
            rooms = [room[row] for row in range(len(room)) if kind.rows[row].margin == margin]
            if rooms:
                assert judged["margins"][0, STANCE_CHECK[name]] <= min(rooms) + 1e-9
        push = wrench[:3] @ frame
        force += push
        moment += np.cross(contacts["place"][0, limb] - place, push) + wrench[3:] @ frame
    mass = chains.total_mass
    pull = mass * bodies["gravity"][0]
    assert force == pytest.approx(-pull - bodies["wrench"][0, :3], abs=1e-6 * 9.81 * mass)
    arm = judged["centre"][0] - place
    assert moment == pytest.approx(-np.cross(arm, pull) - bodies["wrench"][0, 3:], abs=1e-5 * 9.81 * mass)


@given(machine=MACHINE, seed=SEED)
@settings(max_examples=20)
def test_a_verdict_for_a_need_is_that_of_the_exact_share(machine: str, seed: int) -> None:
    statics, bodies, contacts = stance(machine, seed)
    exact = share(statics, bodies, contacts)
    only = 1 << STANCE_CHECK["equilibrium"]
    for need in (-0.2, 0.0, 0.05, 0.2):
        judged, reasons = statics.judge(bodies, contacts, rules_record(exact=0, need=need, hard=only | 1))
        if judged["judged"][0] and abs(exact - need) > 1e-7:
            assert (reasons[0] < 0) == (exact >= need)


def test_a_posture_depends_on_the_stance_alone() -> None:
    statics, bodies, contacts = stance("clamps", 11)
    alone, _ = statics.judge(bodies, contacts)
    many, others = np.repeat(bodies, 5), np.repeat(contacts, 5, axis=0)
    others["place"][[0, 1, 3]] += 0.01
    among, _ = statics.judge(many, others)
    assert among["posture"][4].tobytes() == alone["posture"][0].tobytes() == among["posture"][2].tobytes()


def test_aligned_end_effectors_point_into_the_surface() -> None:
    chains, kind = MACHINES["clamps"]
    statics = Statics(chains, [kind] * 3)
    bodies, contacts = random_stances(statics, chains, 300, np.random.default_rng(12), spread=0.4)
    judged, reasons = statics.judge(bodies, contacts, rules_record(hard=1))
    assert np.mean(reasons < 0) > 0.9
    for i in np.flatnonzero(reasons < 0):
        base = np.eye(4)
        base[:3, :3], base[:3, 3] = bodies["rotation"][i].reshape(3, 3), bodies["place"][i]
        for limb in range(3):
            end = frames(chains, limb, judged["posture"][i, limb, :6], base)[-1]
            assert end[:3, 3] == pytest.approx(contacts["place"][i, limb], abs=2e-4)
            assert end[:3, 2] @ contacts["normal"][i, limb] == pytest.approx(-1.0, abs=1e-6)
        assert judged["margins"][i, STANCE_CHECK["tilt"]] == pytest.approx(kind.tilt, abs=1e-3)


def test_a_stance_that_is_out_of_reach_says_so() -> None:
    statics, bodies, contacts = stance("grippers", 13)
    contacts["place"][0, 2] += 1.0
    judged, reasons = statics.judge(bodies, contacts)
    assert reasons[0] == STANCE_CHECK["reach"] and judged["margins"][0, 0] < -0.1
    assert np.isnan(judged["margins"][0, 1:]).all() and not judged["judged"][0]


def test_two_points_never_balance_and_one_clamp_may() -> None:
    for machine, alone, holds in (("grippers", 2, False), ("clamps", 1, True)):
        chains, kind = MACHINES[machine]
        strong = arms(3, torque=500.0) if holds else chains
        statics = Statics(strong, [kind] * len(chains.limb_names))
        bodies, contacts = random_stances(statics, strong, 50, np.random.default_rng(14), spread=0.1)
        contacts["bears"][:, alone:] = 0
        judged, _ = statics.judge(bodies, contacts, rules_record(hard=1))
        assert (judged["s"][judged["judged"] == 1] > 0.0).any() == holds


def test_the_smallest_room_of_a_check_ends_the_judging_in_order() -> None:
    statics, bodies, contacts = stance("grippers", 15)
    for name, rules in (
        ("joint", {"joint_room": 9.0}),
        ("equilibrium", {"need": 9.0}),
    ):
        _, reasons = statics.judge(bodies, contacts, rules_record(**rules))
        assert STANCE_CHECKS[reasons[0]].name == name


def test_limbs_that_meet_end_the_judging_before_forces_are_asked_for() -> None:
    chains, kind = MACHINES["feet"]
    statics = Statics(chains, [kind] * len(chains.limb_names))
    bodies, contacts = random_stances(statics, chains, 300, np.random.default_rng(19), spread=1.0)
    judged, _ = statics.judge(bodies, contacts, rules_record(hard=0))
    limb_limb, equilibrium = STANCE_CHECK["limb_limb"], STANCE_CHECK["equilibrium"]
    meet = (judged["margins"][:, limb_limb] < -1e-6) & (judged["margins"][:, :limb_limb] > 1e-6).all(axis=1)
    assert meet.any()
    judged, reasons = statics.judge(bodies[meet], contacts[meet], rules_record(need=9.0, exact=0))
    assert (reasons == limb_limb).all() and np.isnan(judged["margins"][:, equilibrium]).all()


def dense_gap(a: Floats, b: Floats, c: Floats, d: Floats) -> float:
    """Distance of two segments by many points of both."""
    t = np.linspace(0.0, 1.0, 401)[:, None]
    first, second = a + t * (b - a), c + t * (d - c)
    return float(np.sqrt(((first[:, None] - second[None]) ** 2).sum(-1)).min())


@given(seed=SEED, kind=st.sampled_from(["any", "parallel", "point", "crossing"]))
@settings(max_examples=60)
def test_gaps_of_segments_are_those_of_dense_points(seed: int, kind: str) -> None:
    rng = np.random.default_rng(seed)
    a, b, c, d = rng.normal(size=(4, 3))
    if kind == "parallel":
        d = c + rng.uniform(-2.0, 2.0) * (b - a)
    elif kind == "point":
        d = c.copy()
    elif kind == "crossing":
        d = 2.0 * (a + 0.3 * (b - a)) - c
    longest = max(float(np.linalg.norm(b - a)), float(np.linalg.norm(d - c)))
    exact, dense = segment_gap(a, b, c, d), dense_gap(a, b, c, d)
    assert exact <= dense + 1e-12
    assert exact == pytest.approx(dense, abs=longest / 300)


@given(seed=SEED)
@settings(max_examples=60)
def test_gaps_of_a_box_are_those_of_dense_points(seed: int) -> None:
    rng = np.random.default_rng(seed)
    a, b = rng.normal(size=(2, 3))
    half = rng.uniform(0.1, 1.0, 3)
    points = a + np.linspace(0.0, 1.0, 20_001)[:, None] * (b - a)
    over = abs(points) - half
    outside = np.linalg.norm(np.maximum(over, 0.0), axis=1)
    assert box_gap(a, b, half) == pytest.approx(float((outside + np.minimum(over.max(axis=1), 0.0)).min()), abs=1e-4)


@given(machine=MACHINE, seed=SEED)
@settings(max_examples=40)
def test_the_gap_of_limbs_is_the_least_of_all_pairs_or_what_was_asked(machine: str, seed: int) -> None:
    chains, kind = MACHINES[machine]
    robot, work, rng = (
        robot_record(chains, [kind] * len(chains.limb_names))[0],
        np.zeros(1, WORK),
        np.random.default_rng(seed),
    )
    limbs = range(len(chains.limb_names))
    for limb in limbs:
        n = chains.n_joints[limb]
        work["posture"][0, limb, :n] = rng.uniform(chains.lower[limb, :n], chains.upper[limb, :n])
        limb_frames(robot, limb, work[0])
    origin = work["origin"][0]
    pairs = {(i, j): float(pair_gap(robot, i, j, origin[i], origin[j])) for i in limbs for j in range(i)}
    for only in (-1, *limbs):
        least = min(gap for pair, gap in pairs.items() if only < 0 or only in pair)
        for asked in (UNLIMITED, least + 0.01, least - 0.01):
            assert limbs_gap(robot, origin, only, asked) == min(least, asked)


def path_rooms(machine: str, seed: int, shift: Floats, lift: float) -> tuple[float, Records, Statics]:
    """Room along the lifted path of limb 0 from its hold to one shifted along the base's axes, and the scratch afterwards."""
    statics, bodies, contacts = stance(machine, seed)
    judged, _ = statics.judge(bodies, contacts)
    assert judged["judged"][0]
    swing = np.repeat(contacts[0, :1], 2)
    swing["place"][1] += bodies["rotation"][0].reshape(3, 3) @ shift
    work = np.zeros(1, WORK)
    room = swing_reach(statics.robot[0], statics.table.records[0], bodies[0], 0, swing, judged[0], lift, work[0])
    return room, work, statics


@pytest.mark.parametrize(("machine", "seed"), [("grippers", 16), ("feet", 17), ("clamps", 18)])
def test_a_lifted_path_within_reach_is_followed_and_one_beyond_is_not(machine: str, seed: int) -> None:
    near, work, statics = path_rooms(machine, seed, np.array([-0.01, 0.01, 0.0]), 0.02)
    far, _, _ = path_rooms(machine, seed, np.array([0.0, 0.0, -2.0]), 0.02)
    assert near > 0.0 > far > -math.inf
    end = work["origin"][0, 0, statics.robot["n_joints"][0, 0]]
    assert end == pytest.approx(work["target"][0, 0], abs=2e-3 * float(statics.robot["size"][0]))
    if statics.robot["aligned"][0, 0]:
        assert work["tip_turn"][0, 0, [2, 5, 8]] @ work["normal"][0, 0] == pytest.approx(-1.0, abs=1e-4)


def test_a_path_that_is_lifted_out_of_reach_says_so_though_its_ends_are_in_reach() -> None:
    shift = np.array([0.005, 0.005, 0.0])
    assert path_rooms("grippers", 16, shift, 0.01)[0] > 0.0 > path_rooms("grippers", 16, shift, 0.5)[0]


def follow(chains: Chains, limb: int, posture: Floats, base: Floats, places: Floats) -> Floats:
    """Postures of a limb of three joints whose tip goes through places that lie close together, shape (places, 3)."""

    def tip(q: Floats) -> Floats:
        return frames(chains, limb, np.append(q, posture[3:]), base)[-1][:3, 3]

    q, found = posture[:3].copy(), []
    for place in places:
        for _ in range(3):
            at = tip(q)
            jacobian = np.stack([(tip(q + 1e-7 * np.eye(3)[k]) - at) / 1e-7 for k in range(3)], axis=1)
            q = q + np.linalg.lstsq(jacobian, place - at, rcond=1e-9)[0]
        found.append(q)
    return np.array(found)


@pytest.mark.slow
@pytest.mark.parametrize("machine", ["grippers", "feet"])
def test_a_path_that_is_followed_leads_to_the_posture_of_the_stance_behind_it(machine: str) -> None:
    """Of two postures that a limb has for most places, beside its hip, it comes to the one that it is to have there.

    Only where the path all but meets the axis of its first joint, it may go through that, from one posture to the other.
    """
    drawn, passed, through, lift = np.random.default_rng(5), 0, 0, 0.01
    chains = MACHINES[machine][0]
    for _ in range(400):
        seed = int(drawn.integers(100))
        statics, bodies, contacts = stance(machine, seed)
        judged, _ = statics.judge(bodies, contacts)
        if not judged["judged"][0]:
            continue
        base = np.eye(4)
        base[:3, :3], base[:3, 3] = bodies["rotation"][0].reshape(3, 3), bodies["place"][0]
        start, normal = contacts["place"][0, 0], contacts["normal"][0, 0]
        hip = frames(chains, 0, judged["posture"][0, 0], base)[0][:3]
        shift = base[:3, :3].T @ (drawn.uniform(0.5, 2.0) * (hip[:, 3] - start)) + drawn.normal(0.0, 0.02, 3)
        shift[2] = drawn.normal(0.0, 0.02)
        room, work, _ = path_rooms(machine, seed, shift, lift)
        if room < 0.0:
            continue
        path = TipPath(start, start + base[:3, :3] @ shift, np.stack((normal, normal)), lift * normal)
        places = np.array([path.at(u)[0] for u in np.linspace(0.0, 1.0, 300)])
        beside = np.linalg.norm(np.cross(places - hip[:, 3], hip[:, 2]), axis=1).min()
        if beside < 0.02 * float(statics.robot["size"][0]):
            through += 1
            continue
        way = follow(chains, 0, judged["posture"][0, 0], base, places)
        assert way[-1] == pytest.approx(work["posture"][0, 0, :3], abs=0.01)
        assert (way > chains.lower[0, :3] - 0.1).all() and (way < chains.upper[0, :3] + 0.1).all()
        passed += 1
    assert passed > through > 0


@pytest.mark.parametrize("machine", sorted(MACHINES))
def test_quick_verdicts_of_forces_are_those_of_the_whole_programme(machine: str) -> None:
    chains, kind = MACHINES[machine]
    statics = Statics(chains, [kind] * len(chains.limb_names))
    bodies, contacts = random_stances(statics, chains, 400, np.random.default_rng(7))
    need = 0.05
    whole, _ = statics.judge(bodies, contacts, rules_record(need=need))
    quick, reasons = statics.judge(
        bodies, contacts, rules_record(need=need, exact=0, hard=1 << STANCE_CHECK["equilibrium"])
    )
    clear = (whole["judged"] == 1) & (quick["judged"] == 1) & (abs(whole["s"] - need) > 1e-6)
    assert clear.sum() > 100
    assert np.array_equal(reasons[clear] < 0, whole["s"][clear] >= need)
    held = clear & (reasons < 0)
    assert np.all(quick["s"][held] <= whole["s"][held] + 1e-6)
    assert np.nanmin(quick["margins"][held][:, STANCE_CHECK["equilibrium"] :]) >= -1e-6


def test_without_weight_no_motor_has_to_work() -> None:
    chains, kind = MACHINES["clamps"]
    statics = Statics(chains, [kind] * len(chains.limb_names))
    bodies, contacts = random_stances(statics, chains, 200, np.random.default_rng(8))
    bodies["gravity"] = 0.0
    judged, _ = statics.judge(bodies, contacts)
    stands = judged["judged"] == 1
    assert stands.sum() > 100
    assert judged["s"][stands] == pytest.approx(1.0, abs=1e-6)
    assert np.all(judged["torque"][stands] < 1e-3)
