"""Which states of the relaxed problem meet a goal: where its backward search sets out."""

import math

import numpy as np

from ....compiled import kernel
from ..statics.records import goals
from .goals import meets
from .relaxed_places import (
    ALL_ANGLES,
    UNREACHED,
    all_states,
    bit_of,
    block_base,
    grip_at,
    grip_holds,
    left,
    on_one_hold,
    open_state,
    put,
)


@kernel
def mark_goals(p, s, stage, masks, values, members):
    """Write what is left of the later stages (0 at the last) at every state and angle that meets a goal; UNREACHED elsewhere.

    Args:
        p: Parameters.
        s: Scratch, one stance.
        stage: Which goal.
        masks: Angles at which each grip holds.
        values: Output, per lap, state and angle kept.
        members: Scratch, shape (3, 2).
    """
    goal = goals(p)[stage]
    for at in range(values.shape[0]):
        values[at] = UNREACHED
    states = all_states(p)
    later = (stage + 1) * values.shape[0]
    for where in range(p.places_nx * p.places_ny):
        put(p, s, where, 0)
        if s.x < goal.x_min - 1e-9 or s.x > goal.x_max + 1e-9 or s.y < goal.y_min - 1e-9 or s.y > goal.y_max + 1e-9:
            continue
        if p.circles:
            s.bearing = math.atan2(s.y - p.centre_y, s.x - p.centre_x)
        blocks = p.n_limbs * (p.n_limbs - 1) // 2 + 1
        for state in range(block_base(p, where, 0), block_base(p, where, blocks)):
            count = open_state(p, where, state, members)
            both = ALL_ANGLES
            for i in range(p.n_limbs):
                s.hold[i] = -1 if p.n_limbs == 3 else goal.hold[i]
            for k in range(count):
                grip = grip_at(p, where, members[k, 0], members[k, 1])
                s.hold[members[k, 0]] = grip_holds(p)[grip]
                both &= masks[grip]
            for k in range(1, count):
                for m in range(k):
                    if on_one_hold(p, where, members[m, 0], members[m, 1], members[k, 0], members[k, 1]):
                        both = np.uint64(0)
            for angle in range(p.angles):
                if not both & bit_of(p, angle):
                    continue
                put(p, s, where, angle)
                for lap in range(p.laps_most):
                    s.laps = p.laps_least + lap
                    if meets(p, s, goal):
                        at = (lap * states + state) * p.angles_kept + (angle if p.angles_kept > 1 else 0)
                        values[at] = 0 if stage == p.n_goals - 1 else min(values[at], left(p)[later + at])


@kernel
def sort_sources(values, first_of, order):
    """Sort the entries of `values` below UNREACHED by value: those of value v are order[first_of[v]:first_of[v + 1]]."""
    for at in range(values.shape[0]):
        if values[at] < UNREACHED:
            first_of[values[at] + 1] += 1
    for value in range(1, first_of.shape[0]):
        first_of[value] += first_of[value - 1]
    for at in range(values.shape[0]):
        if values[at] < UNREACHED:
            order[first_of[values[at]]] = at
            first_of[values[at]] += 1
    for value in range(first_of.shape[0] - 1, 0, -1):
        first_of[value] = first_of[value - 1]
    first_of[0] = 0
