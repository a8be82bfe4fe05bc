"""Loads of stances moved away from the limits of contacts and motors."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from clamber.control.whole_body.tree import Dynamics, State
from clamber.control.whole_body.tree_kernels import work_out
from clamber.families.spatial.control.believed_tree import believed_tree
from clamber.families.spatial.execution.centred_loads import centre, contact_rows
from clamber.families.spatial.execution.course import Course, Standing
from clamber.families.spatial.planning.task import SpatialTask
from clamber.planning.problem.plan import Plan
from clamber.planning.problem.problems import plan_family
from clamber.tasks import load_task
from clamber.types import Floats
from clamber.units import GRAVITY

TASKS = ("wall-gripper", "stones-quadruped", "corners-magnet", "truss-inchworm", "rubble-hexapod")


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**31), n=st.integers(2, 9), equations=st.integers(1, 6))
def test_the_product_of_what_is_left_is_the_largest(seed: int, n: int, equations: int) -> None:
    """Against SciPy's minimiser of the same function, begun elsewhere, within a box that bounds it."""
    drawn = np.random.default_rng(seed)
    rows = np.concatenate((np.eye(n), -np.eye(n), drawn.standard_normal((8, n))))
    limits = np.concatenate((drawn.uniform(0.5, 3.0, 2 * n), drawn.uniform(0.1, 2.0, 8)))
    balance = drawn.standard_normal((min(equations, n - 1), n))
    found = centre(rows, limits, balance)
    assert np.allclose(balance @ found, 0.0, atol=1e-9)
    assert (limits - rows @ found > 0.0).all()
    free = np.linalg.svd(balance)[2][len(balance) :].T

    def left(z: np.ndarray) -> float:
        room = limits - rows @ (free @ z)
        return float(-np.log(room).sum()) if (room > 0.0).all() else 1e9

    best = minimize(
        left, np.zeros(free.shape[1]), method="Nelder-Mead", options={"xatol": 1e-7, "fatol": 1e-10, "maxiter": 20000}
    )
    assert left(free.T @ found) <= best.fun + 1e-5


def test_from_beyond_a_limit_nothing_moves() -> None:
    assert not centre(np.eye(3), np.array((1.0, -0.1, 1.0)), np.ones((1, 3))).any()


def test_two_feet_under_a_weight_push_straight_down_and_bear_half_each() -> None:
    """Feet in a plane that push with 0 to 20 N along their normals, friction 0.5; begun off the middle and across each other."""
    foot = np.array(((-0.5, 1.0), (-0.5, -1.0), (-1.0, 0.0), (1.0, 0.0)))
    rows, limits = np.kron(np.eye(2), foot), np.tile((0.0, 0.0, 0.0, 20.0), 2)
    start, balance = np.array((8.0, 2.0, 4.5, -2.0)), np.kron((1.0, 1.0), np.eye(2))
    found = start + centre(rows, limits - rows @ start, balance)
    assert found == pytest.approx((6.25, 0.0, 6.25, 0.0), abs=1e-3)


@pytest.mark.parametrize("name", TASKS)
def test_centred_loads_balance_as_the_planners_do_and_leave_more_friction(name: str) -> None:
    task = load_task(name)
    assert isinstance(task, SpatialTask)
    stance = plan_family(task).problem(task).replay([]).stances[0]
    planned = np.array(stance["wrench"][: len(task.robot.limb_names)], np.float64)
    start = Course.of(task, Plan.of_codes(task, [])).start
    tips = task.world.places[start.holds]
    for loads in (planned, start.loads):
        assert np.isfinite(loads).all()
    force, moment = (start.loads - planned)[:, :3], (start.loads - planned)[:, 3:]
    scale = np.abs(planned).max()
    assert np.abs(force.sum(axis=0)).max() < 1e-6 * scale
    assert np.abs((np.cross(tips, force) + moment).sum(axis=0)).max() < 1e-4 * scale
    least, kept = (rooms(task, start, loads).min() for loads in (planned, start.loads))
    assert kept >= 0.9 * least - 1e-9
    assert (
        np.log(np.maximum(rooms(task, start, start.loads), 1e-12)).sum()
        >= np.log(np.maximum(rooms(task, start, planned), 1e-12)).sum() - 1e-6
    )


def rooms(task: SpatialTask, start: Standing, loads: Floats) -> Floats:
    """What loads leave of every row of every contact, in its share of reserve."""
    tree = believed_tree(task.robot, task.world.gravity)
    state, dynamics = State.of(tree), Dynamics.of(tree)
    state.rotation[:], state.position[:], state.joints[:] = start.pose.rotation, start.pose.position, start.joints
    work_out(tree, state, dynamics)
    weight, found = GRAVITY * task.robot.chains.total_mass, []
    for limb, hold in enumerate(start.holds.tolist()):
        frame, rows, limits = contact_rows(task.robot, task.world, limb, hold, dynamics.tip_turn[limb], 1.0)
        wrench = np.concatenate((frame @ loads[limb, :3], frame @ loads[limb, 3:]))
        scale = np.array([row.slack[0] * weight + row.slack[1] for row in task.robot.contacts[limb].rows])
        found.append((limits - rows @ wrench) / scale)
    return np.concatenate(found)
