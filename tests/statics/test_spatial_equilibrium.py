"""Forces of stances in space against HiGHS, which gets the same stance by other words (`plain_spatial`)."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from clamber.families.spatial.robot.chains import Chains
from clamber.families.spatial.robot.contact_kinds import Magnet, build_contact, read_contact
from clamber.families.spatial.robot.contacts import Contact
from clamber.families.spatial.statics.checks import STANCE_CHECK
from clamber.families.spatial.statics.judging import Statics, rules_record
from clamber.tasks import load_task
from clamber.types import Records
from plain_spatial import PlainStance, plain_margins, solve_forces, turn_about
from spatial_machines import arms, gripper, point_foot, random_stances, spider


def shipped(name: str) -> Contact:
    return build_contact(read_contact(name)).contact()


MAGNET = build_contact(read_contact("magnet"))
assert isinstance(MAGNET, Magnet)
TILTED = replace(MAGNET, pull=40.0, ankle=False, half_tilt=1.0, tilt=2.0).contact()
MACHINES: dict[str, tuple[Chains, Contact]] = {
    "four grippers": (spider(4), gripper(0.8, 9.0)),
    "weak grippers": (spider(4, torque=0.8), gripper(0.5, 4.0)),
    "four feet": (spider(4, torque=2.0), point_foot(0.7)),
    "six feet": (spider(6), point_foot(0.6)),
    "three feet": (spider(3), point_foot(0.9)),
    "four spines": (spider(4), shipped("spine")),
    "three clamps": (arms(3, torque=90.0), shipped("clamp")),
    "two clamps": (arms(2, 7, torque=150.0), shipped("clamp")),
    "slides and clamps": (arms(3, slide=True), shipped("clamp")),
    "flat feet": (arms(3, torque=90.0), shipped("area")),
    "tilted magnets": (spider(4), TILTED),
    "hooks on bars": (spider(4), shipped("hook")),
}


def plain(body: np.void, contacts: Records, judged: np.void) -> PlainStance:
    """A judged stance for the plain evaluator, which takes the posture alone from what was judged."""
    base = np.eye(4)
    base[:3, :3], base[:3, 3] = body["rotation"].reshape(3, 3), body["place"]
    return PlainStance(
        base=base,
        gravity=body["gravity"],
        wrench=body["wrench"],
        posture=judged["posture"],
        places=contacts["place"],
        normals=contacts["normal"],
        along=contacts["along"],
        bears=[bool(bears) for bears in contacts["bears"]],
        strength=contacts["strength"],
        friction=contacts["friction"],
    )


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("n", [60, pytest.param(1000, marks=pytest.mark.slow)])
def test_no_verdict_differs_from_that_of_another_solver(machine: str, n: int) -> None:
    chains, kind = MACHINES[machine]
    limbs = len(chains.limb_names)
    statics = Statics(chains, [kind] * limbs)
    rng = np.random.default_rng(5)
    bodies, contacts = random_stances(statics, chains, n, rng)
    contacts["friction"] = rng.uniform(0.3, 1.0, contacts.shape)
    weight = 9.81 * chains.total_mass
    contacts["strength"] = rng.uniform(0.02, 0.6, contacts.shape) * weight
    if kind.kind == "hook":
        contacts["along"] = np.cross(contacts["normal"], rng.normal(size=(*contacts.shape, 3)))
        contacts["strength"] *= 5.0  # a hook bears the weight as a push
    contacts["bears"] = rng.uniform(size=contacts.shape) < 0.85
    bodies["wrench"] = rng.normal(size=(n, 6)) * weight * [0.05, 0.05, 0.05, 0.005, 0.005, 0.005]
    exact, _ = statics.judge(bodies, contacts)
    _, reasons = statics.judge(
        bodies, contacts, rules_record(exact=0, need=0.05, hard=1 << STANCE_CHECK["equilibrium"])
    )
    judged = np.flatnonzero(exact["judged"])
    assert len(judged) > 0.9 * n
    feasible = 0
    for i in judged:
        found = solve_forces(chains, [kind] * limbs, plain(bodies[i], contacts[i], exact[i]))
        feasible += found >= 0.05
        if found < -0.9:  # no forces balance, or only very wrong ones
            assert exact["s"][i] < -0.8
        else:
            assert exact["s"][i] == pytest.approx(found, abs=1e-6)
        if abs(found - 0.05) > 1e-7:
            assert (reasons[i] < 0) == (found >= 0.05)
    assert 0.02 * n < feasible < 0.98 * n


@pytest.mark.slow
def test_no_verdict_differs_where_a_robot_stands_in_its_own_plane() -> None:
    """Forces in the plane and across it hang together by rounding alone there, which is no number to divide by."""
    robot: Any = load_task("truss-inchworm").robot
    chains, kinds, n = robot.chains, robot.contacts, 1000
    statics = Statics(chains, kinds)
    rng = np.random.default_rng(1)
    bodies = statics.bodies(n)
    places, normals = np.zeros((n, 2, 3)), np.tile((0.0, 0.0, 1.0), (n, 2, 1))
    places[:, :, 0] = rng.uniform(0.25, 0.5, (n, 2)) * (1.0, -1.0)
    bodies["place"][:, 2] = rng.uniform(0.2, 0.35, n)
    for i, roll in enumerate(np.radians(15.0) * rng.integers(-1, 2, n)):
        bodies["rotation"][i] = turn_about(np.array((1.0, 0.0, 0.0)), roll).reshape(-1)
    contacts = statics.contacts(places, normals)
    judged, _ = statics.judge(bodies, contacts)
    reached = np.flatnonzero(judged["judged"])
    assert len(reached) > 0.4 * n
    for i in reached:
        found = solve_forces(chains, list(kinds), plain(bodies[i], contacts[i], judged[i]))
        assert judged["s"][i] == pytest.approx(found, abs=1e-6)


@pytest.mark.parametrize("machine", MACHINES)
def test_margins_are_those_of_the_plain_evaluator(machine: str) -> None:
    chains, kind = MACHINES[machine]
    limbs = len(chains.limb_names)
    statics = Statics(chains, [kind] * limbs)
    bodies, contacts = random_stances(statics, chains, 15, np.random.default_rng(21), spread=0.6)
    rules = rules_record()
    judged, _ = statics.judge(bodies, contacts, rules)
    size = float(statics.robot["size"][0])
    for i in np.flatnonzero(judged["judged"]):
        expected = plain_margins(chains, [kind] * limbs, plain(bodies[i], contacts[i], judged[i]))
        margins = {name: float(judged["margins"][i, number]) for name, number in STANCE_CHECK.items()}
        assert margins["reach"] - rules["reach"][0] * size == pytest.approx(expected["reach"], abs=1e-6 * size)
        assert margins["joint"] == pytest.approx(expected["joint"], abs=1e-9)
        assert min(margins["tilt"], 1e9) == pytest.approx(min(expected["tilt"], 1e9), abs=1e-7)
        assert margins["limb_limb"] == pytest.approx(expected["limb_limb"], abs=1e-7)
        assert margins["limb_body"] == pytest.approx(expected["limb_body"], abs=1e-4)
        assert margins["equilibrium"] == pytest.approx(max(expected["equilibrium"], -1.0), abs=1e-6)
