"""How far limbs may be stretched: against the longest that a search over all angles finds, and in stances and plans."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize

from clamber.families.spatial.planning.problem import SpatialProblem
from clamber.families.spatial.robot.chains import Chains
from clamber.families.spatial.statics.judging import REACHED, Statics, rules_record
from clamber.families.spatial.statics.stretch import farthest_tips
from clamber.planning.beam import plan_beam
from clamber.tasks import load_task
from clamber.types import Floats
from plain_spatial import joints
from spatial_machines import arms, point_foot, random_stances, spider

PART = 0.9


def longest(chains: Chains, limb: int, joint: int) -> float:
    """Largest distance of a limb's tip from a joint, whatever limits say, by searches from many postures [m]."""
    n, rng = int(chains.n_joints[limb]), np.random.default_rng(20)

    def apart(q: Floats) -> float:
        at = joints(chains, limb, q, np.eye(4))
        return -float(np.linalg.norm(at[-1] - at[joint]))

    return -min(float(minimize(apart, rng.uniform(-np.pi, np.pi, n)).fun) for _ in range(12))


def hips(lateral: float) -> Chains:
    """A spider whose limbs roll first, beside which their legs hang: no joint puts all of a limb on one line."""
    chains = spider(4)
    offset = chains.offset.copy()
    offset[:, 1] = [0.0, 0.0, lateral]
    return replace(chains, offset=offset)


@pytest.mark.parametrize(
    "chains", [spider(3), hips(0.04), arms(2), arms(2, 7)], ids=["spider", "hips", "arms", "seven"]
)
def test_limbs_are_stretched_as_far_as_any_search_gets_them(chains: Chains) -> None:
    allowed = farthest_tips(replace(chains, stretch=PART), 1)
    limited, found = 0, [longest(chains, 1, joint) for joint in range(len(allowed))]
    for joint, most in enumerate(allowed):
        if np.isfinite(most):
            assert most == pytest.approx(PART * found[joint], rel=1e-6)
            assert found[joint] > 0.666 * max(found)
            limited += 1
        else:
            assert found[joint] <= 0.667 * max(found) or joint == len(found) - 1
    assert limited > 0


def test_limbs_that_nothing_bends_or_that_slide_are_not_limited() -> None:
    chains = spider(4)
    offset = chains.offset.copy()
    offset[:, 1:3] = 0.0
    for each in (replace(chains, offset=offset, stretch=PART), replace(arms(2, slide=True), stretch=PART), chains):
        assert np.isinf(farthest_tips(each, 0)).all()


@pytest.mark.parametrize("chains", [spider(4), hips(0.04), arms(3)], ids=["spider", "hips", "arms"])
def test_a_stance_lacks_as_much_reach_as_a_limb_is_stretched_too_far(chains: Chains) -> None:
    chains = replace(chains, stretch=PART)
    statics = Statics(chains, [point_foot(0.8)] * len(chains.limb_names))
    bodies, contacts = random_stances(statics, chains, 200, np.random.default_rng(21), spread=0.9)
    free = Statics(replace(chains, stretch=1.0), [point_foot(0.8)] * len(chains.limb_names))
    there, _ = free.judge(bodies, contacts, rules_record(hard=1))
    judged, reasons = statics.judge(bodies, contacts, rules_record(hard=1))
    too_far = 0
    for i in np.flatnonzero(there["judged"]):
        rooms = [there["margins"][i, 0]]
        for limb, n in enumerate(chains.n_joints):
            at = joints(chains, limb, there["posture"][i, limb], np.eye(4))
            most = farthest_tips(chains, limb)
            room = min(float(most[k] - np.linalg.norm(at[-1] - at[k])) for k in range(n))
            rooms.append(REACHED * float(statics.robot["size"][0]) + min(0.0, room))
            if rooms[-1] < 0.0:
                break  # what is out of reach ends the judging
        if abs(min(rooms)) > 1e-7:
            assert (reasons[i] == 0) == (min(rooms) < 0.0)
        assert judged["margins"][i, 0] == pytest.approx(min(rooms), abs=1e-9)
        too_far += reasons[i] == 0
    assert 0 < too_far < there["judged"].sum()


def most_stretched(task: Any) -> float:
    """Of the full length of a limb, in any stance of a plan."""
    found = plan_beam(task, width=30, threads=1)
    assert found.has_plan, found.reason
    chains, most = task.robot.chains, 0.0
    lengths = [[longest(chains, limb, k) for k in range(2)] for limb in range(len(chains.n_joints))]
    for stance in SpatialProblem(task, 1, exact=True).replay(found.plan.codes(task)).stances:
        for limb, whole in enumerate(lengths):
            at = joints(chains, limb, stance["q"][limb], np.eye(4))
            most = max(most, *(float(np.linalg.norm(at[-1] - at[k])) / length for k, length in enumerate(whole)))
    return most


@pytest.mark.slow
def test_plans_keep_limbs_bent() -> None:
    """A quadruped, whose hips lie beside its legs."""
    goal = "goal={ along_min = '0.5 m' }"
    free = most_stretched(load_task("stones-quadruped", [goal]))
    kept = free - 0.02
    assert most_stretched(load_task("stones-quadruped", [goal, f"robot.stretch={kept:.4f}"])) <= kept + 1e-3
