"""Forces of stances in space against HiGHS, which gets the same stance by other words (`plain_spatial`)."""

import numpy as np
import pytest

from clamber.families.spatial.robot.chains import Chains
from clamber.families.spatial.robot.contact_kinds import build_contact, read_contact
from clamber.families.spatial.robot.contacts import Contact, gripper, point_foot
from clamber.families.spatial.statics.checks import STANCE_CHECK
from clamber.families.spatial.statics.judging import Statics, rules_record
from clamber.types import Records
from plain_spatial import PlainStance, solve_forces
from spatial_machines import arms, random_stances, spider


def shipped(name: str) -> Contact:
    return build_contact(read_contact(name)).contact()


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
}


def plain(statics: Statics, body: np.void, contacts: Records, judged: np.void) -> PlainStance:
    """A judged stance for the plain evaluator."""
    base = np.eye(4)
    base[:3, :3], base[:3, 3] = body["rotation"].reshape(3, 3), body["place"]
    frames = judged["frame"][: statics.n_limbs].reshape(-1, 3, 3) @ base[:3, :3].T
    return PlainStance(
        base=base,
        gravity=body["gravity"],
        wrench=body["wrench"],
        posture=judged["posture"],
        places=contacts["place"],
        frames=frames,
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
        found = solve_forces(chains, [kind] * limbs, plain(statics, bodies[i], contacts[i], exact[i])).s
        feasible += found >= 0.05
        if found < -0.9:  # no forces balance, or only very wrong ones
            assert exact["s"][i] < -0.8
        else:
            assert exact["s"][i] == pytest.approx(found, abs=1e-6)
        if abs(found - 0.05) > 1e-7:
            assert (reasons[i] < 0) == (found >= 0.05)
    assert 0.02 * n < feasible < 0.98 * n
