"""What a law of cooperative motion works out at a configuration, in arrays made once, and the kernel that fills them.

The arm in the plate's frame: the vector to its tool by its joints, as a kernel (the last factor of equation 8).

The arm's first moment of mass has the same form, with other lengths (`arm_moment.py`), so this kernel serves both.
"""

import math
from typing import NamedTuple

import numpy as np

from .....compiled import kernel
from .....types import Floats
from .manipulability import manipulability, manipulability_gradient, normalise
from .planted import along_feet, curve_along_feet, follow_feet, stand
from .planted_feet import BALANCE, N_ROWS
from .plate_bounds import Y_STANDS, bound_gradients, bound_values
from .plate_turn import plate_turn
from .tool_chain import POSE, tool_curvature, tool_jacobian, tool_place


@kernel
def arm_vector(links, out, up, joints, a, da, dda):
    """The vector from the plate's origin to the tool, plate frame, and its derivatives.

    Args:
        links: Lengths of the pitching links [m], shape (n,).
        out: From the axis of joint 0 to that of joint 1, outwards [m].
        up: From the plate to the axis of joint 1 [m].
        joints: Angles [rad], shape (n + 1,): the turning joint, then the pitching ones.
        a: Filled with the vector [m], shape (3,).
        da: Filled with its first derivatives [m/rad], shape (n + 1, 3).
        dda: Filled with its second derivatives [m/rad^2], shape (n + 1, n + 1, 3).
    """
    n = links.size
    c0, s0 = math.cos(joints[0]), math.sin(joints[0])
    total = 0.0
    for i in range(n):
        total += joints[i + 1]
    # from the tip inwards: everything beyond joint j moves with it
    reach, rise = 0.0, 0.0
    for i in range(n - 1, -1, -1):
        reach += links[i] * math.cos(total)
        rise += links[i] * math.sin(total)
        total -= joints[i + 1]
        da[i + 1, 0] = -rise * c0
        da[i + 1, 1] = -rise * s0
        da[i + 1, 2] = reach
        for j in range(i + 1):
            # the inner of two pitching joints is carried by the outer one's part only
            dda[i + 1, j + 1, 0] = -reach * c0
            dda[i + 1, j + 1, 1] = -reach * s0
            dda[i + 1, j + 1, 2] = -rise
            for k in range(3):
                dda[j + 1, i + 1, k] = dda[i + 1, j + 1, k]
        dda[0, i + 1, 0] = rise * s0
        dda[0, i + 1, 1] = -rise * c0
        dda[0, i + 1, 2] = 0.0
        for k in range(3):
            dda[i + 1, 0, k] = dda[0, i + 1, k]
    reach += out
    a[0] = reach * c0
    a[1] = reach * s0
    a[2] = rise + up
    da[0, 0] = -reach * s0
    da[0, 1] = reach * c0
    da[0, 2] = 0.0
    dda[0, 0, 0] = -reach * c0
    dda[0, 0, 1] = -reach * s0
    dda[0, 0, 2] = 0.0


class Chain(NamedTuple):
    """The arm, and which limits its joints have."""

    links: Floats
    """[m], shape (n,)."""
    shape: Floats
    """Out and up [m], shape (2,)."""
    moment_links: Floats
    """Of the first moment [kg m], shape (n,)."""
    lowest: Floats
    """Of the joints [rad], shape (n + 1,)."""
    highest: Floats
    """[rad], shape (n + 1,)."""
    row_lowest: Floats
    """Of the bounded quantities, shape (N_ROWS,)."""
    row_highest: Floats
    """Shape (N_ROWS,)."""
    row_speed: Floats
    """Fastest change of a bounded quantity [m/s], shape (N_ROWS,); infinite where none is stated."""


class Scratch(NamedTuple):
    """Scratch of one law; m freedoms, n + 1 joints."""

    turn: Floats
    turn_1: Floats
    turn_2: Floats
    a: Floats
    da: Floats
    dda: Floats
    s: Floats
    ds: Floats
    dds: Floats
    place: Floats
    """Tool point, world [m], shape (3,)."""
    jacobian: Floats
    """Of the tool, along planted feet where there are some, shape (3, m)."""
    curvature: Floats
    """Its derivatives, shape (m, 3, m)."""
    scaled: Floats
    """J^, shape (3, m)."""
    grams: Floats
    gradient: Floats
    """dV/dq^, shape (m,)."""
    follow: Floats
    follow_1: Floats
    y_place: Floats
    moved: Floats
    slope: Floats
    lengths: Floats
    by_place: Floats
    values: Floats
    """Of `plate_bounds`, shape (N_ROWS,)."""
    gradients: Floats
    """Shape (N_ROWS, m)."""
    ahead: Floats
    """Values after a step, shape (N_ROWS,)."""
    speeds: Floats
    """Largest of the freedoms now, shape (m,); 0 switches one off."""
    velocity: Floats
    """Wanted of the tool, feedback included, shape (3,) [m/s]."""
    rates: Floats
    """Shape (m,)."""
    after: Floats
    """Configuration after a step, shape (m,)."""
    square: Floats
    right: Floats
    ones: Floats
    """Speeds of 1, of the plain chain, shape (m,)."""


def make_scratch(n_joints: int) -> Scratch:
    """Arrays for an arm of so many joints."""
    m = POSE + n_joints
    return Scratch(
        turn=np.zeros((3, 3)),
        turn_1=np.zeros((3, 3, 3)),
        turn_2=np.zeros((3, 3, 3, 3)),
        a=np.zeros(3),
        da=np.zeros((n_joints, 3)),
        dda=np.zeros((n_joints, n_joints, 3)),
        s=np.zeros(3),
        ds=np.zeros((n_joints, 3)),
        dds=np.zeros((n_joints, n_joints, 3)),
        place=np.zeros(3),
        jacobian=np.zeros((3, m)),
        curvature=np.zeros((m, 3, m)),
        scaled=np.zeros((3, m)),
        grams=np.zeros((2, 3, 3)),
        gradient=np.zeros(m),
        follow=np.zeros((3, 3)),
        follow_1=np.zeros((3, 3, 3)),
        y_place=np.zeros(3),
        moved=np.zeros((3, POSE)),
        slope=np.zeros(3),
        lengths=np.zeros(3),
        by_place=np.zeros((3, 3)),
        values=np.zeros(N_ROWS),
        gradients=np.zeros((N_ROWS, m)),
        ahead=np.zeros(N_ROWS),
        speeds=np.zeros(m),
        velocity=np.zeros(3),
        rates=np.zeros(m),
        after=np.zeros(m),
        square=np.zeros((3, 3)),
        right=np.zeros(3),
        ones=np.ones(m),
    )


@kernel
def see_tool(chain, q, w):
    """Fill turn, arm vector, place, Jacobian and curvature of the free chain.

    Args:
        chain: A `Chain`.
        q: Freedoms, shape (m,).
        w: A `Scratch`.
    """
    plate_turn(q[3:POSE], w.turn, w.turn_1, w.turn_2)
    arm_vector(chain.links, chain.shape[0], chain.shape[1], q[POSE:], w.a, w.da, w.dda)
    tool_place(q, w)
    tool_jacobian(w)
    tool_curvature(w)


@kernel
def see_bounds(chain, footing, q, w):
    """Fill values and gradients of the plate's bounds, and lead everything along planted feet; after `see_tool`.

    Args:
        chain: A `Chain`.
        footing: Record of `PLANTED_FEET`.
        q: Freedoms, shape (m,).
        w: A `Scratch`.
    """
    arm_vector(chain.moment_links, footing.moment_out, footing.moment_up, q[POSE:], w.s, w.ds, w.dds)
    bound_values(footing, q, w, w.values)
    bound_gradients(footing, q, w)
    if footing.support != Y_STANDS:
        follow_feet(q, footing.anchor, w.follow, w.follow_1)
        curve_along_feet(w.jacobian, w.follow, w.follow_1, w.curvature)
        along_feet(w.jacobian, w.follow)
        along_feet(w.gradients, w.follow)


@kernel
def see_measure(speeds, tool_speeds, w):
    """V of the normalised chain, its gradient left in the scratch; after `see_tool` (and `see_bounds`).

    Args:
        speeds: Largest speeds of the freedoms [m/s, rad/s], shape (m,); 0 switches one off.
        tool_speeds: Of the tool [m/s], shape (3,).
        w: A `Scratch`.
    """
    normalise(w.jacobian, speeds, tool_speeds, w.scaled)
    measure = manipulability(w.scaled, w.grams)
    manipulability_gradient(measure, w.scaled, w.grams, w.curvature, speeds, tool_speeds, w.gradient)
    return measure


@kernel
def step_to(footing, q, time, share, w):
    """The configuration after a share of a step by the scratch's rates: x, y and alpha by the planted feet if there are some.

    Args:
        footing: Record of `PLANTED_FEET`.
        q: Freedoms, shape (m,).
        time: Of the whole step [s].
        share: How much of it [-].
        w: A `Scratch`; its `after` is filled.
    """
    for k in range(q.size):
        w.after[k] = q[k] + share * time * w.rates[k]
    if footing.support != Y_STANDS:
        stand(w.after, footing.anchor, footing.heading)


@kernel
def share_within(chain, footing, q, time, w):
    """The largest share of a step [-] after which every bound holds and no actuator or leg was too fast, to a thousandth.

    The arm's joints are bounded one by one, which the rates keep exactly; the plate's bounds are curved, so they are looked at.

    Args:
        chain: A `Chain`.
        footing: Record of `PLANTED_FEET`.
        q: Freedoms, within the bounds, shape (m,).
        time: Of the step [s].
        w: A `Scratch` after `see_bounds`, with the rates; `after` is left with the configuration that is reached.
    """
    low, high = 0.0, 1.0
    share = 1.0
    for _ in range(11):
        step_to(footing, q, time, share, w)
        if _holds(chain, footing, time, w):
            low = share
            if share == 1.0:
                return share
        else:
            high = share
        share = 0.5 * (low + high)
    step_to(footing, q, time, low, w)
    return low


@kernel
def _holds(chain, footing, time, w):
    plate_turn(w.after[3:POSE], w.turn, w.turn_1, w.turn_2)
    arm_vector(chain.moment_links, footing.moment_out, footing.moment_up, w.after[POSE:], w.s, w.ds, w.dds)
    bound_values(footing, w.after, w, w.ahead)
    for row in range(BALANCE + footing.n_edges):
        if not chain.row_lowest[row] <= w.ahead[row] <= chain.row_highest[row]:
            return False
        if abs(w.ahead[row] - w.values[row]) > chain.row_speed[row] * time:
            return False
    return True
