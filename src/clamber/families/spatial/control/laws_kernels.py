"""A tick of the laws that solve no programme."""

import math

from ....compiled import kernel, opened
from ....control.matrices import factor, solve_transposed
from ....control.whole_body.programme import ARM, BASE_RATE, HOLDS, POSTURE_RATE, REST_RATE, SWING_RATE, SWINGS
from ....control.whole_body.programme_kernels import wanted_base
from ....control.whole_body.tree import FREE
from ....control.whole_body.tree_kernels import place_bodies, tip_motion
from .task_kernels import (
    about,
    bear,
    meet,
    points,
    share_wrenches,
    tip_error,
    turn_error,
    turn_row,
    turn_wanted,
)

GIVES = 0.05
"""By which a joint of an impedance gives way at most when it takes its whole torque [rad] or [m] ..."""
STEPS = 3
"""... and how often its inverse kinematics are made better at a tick."""
LEAN = 0.01
"""Share of the way to their posture that joints lean at each of them, as far as they may [-]."""
FARTHEST = 0.2
"""That a joint goes in one of them [rad] or [m]."""


@kernel
def operational_space(handle):
    """See `laws.OperationalSpace`, of what its handle holds; returns whether any contact bears."""
    tree, state, dynamics, aims, limits, gains, room = opened(handle)
    upper, row, y, wanted = room.upper, room.row, room.y, room.wanted
    n = y.size
    factor(dynamics.mass, n, upper)
    wanted_base(state, aims, gains[BASE_RATE], wanted)
    rate = gains[POSTURE_RATE]
    for k in range(tree.rotor.size):
        wanted[FREE + k] = rate * (rate * (aims.posture[k] - state.joints[k]) - 2.0 * state.speed[FREE + k])
    for i in range(n):  # y = U of the accelerations: in y, lengths are kinetic energies
        y[i] = 0.0
        for j in range(i, n):
            y[i] += upper[i, j] * wanted[j]
    count = 0
    for limb in range(aims.does.size):
        if aims.does[limb] != HOLDS:
            continue
        for a in range(3 if aims.components[limb] == 3 else 6):
            for i in range(n):
                row[i] = dynamics.jacobian[limb, a, i]
            value = -gains[REST_RATE] * dynamics.tip_speed[limb, a] - dynamics.tip_bias[limb, a]
            solve_transposed(upper, n, row)
            count = meet(room.basis, count, row, value, y)
    for a in range(FREE):
        for i in range(n):
            row[i] = 1.0 if i == a else 0.0
        solve_transposed(upper, n, row)
        count = meet(room.basis, count, row, wanted[a], y)
    for limb in range(aims.does.size):
        if aims.does[limb] != SWINGS:
            continue
        for a in range(3):
            for i in range(n):
                row[i] = dynamics.jacobian[limb, a, i]
            solve_transposed(upper, n, row)
            value = tip_error(dynamics, aims, gains, limb, a) - dynamics.tip_bias[limb, a]
            count = meet(room.basis, count, row, value, y)
        for axis in range(2 if points(aims, limb) else 0):
            turn_row(dynamics, limb, axis, row)
            solve_transposed(upper, n, row)
            value = turn_wanted(dynamics, aims, gains, limb, axis)
            value -= about(dynamics, limb, axis, dynamics.tip_bias[limb])
            count = meet(room.basis, count, row, value, y)
    for i in range(n):  # M of the accelerations is U^T y
        room.forces[i] = dynamics.bias[i]
        for j in range(i + 1):
            room.forces[i] += upper[j, i] * y[j]
    return shared(tree, dynamics, aims, limits, gains, room)


@kernel
def shared(tree, dynamics, aims, limits, gains, room):
    """Wrenches and torques that bear `room.forces`; whether any contact bears."""
    gravity = math.sqrt(tree.gravity[0] ** 2 + tree.gravity[1] ** 2 + tree.gravity[2] ** 2)
    some = share_wrenches(dynamics, aims, gains, room, max(gravity, 1.0))
    bear(dynamics, aims, limits, room)
    return some


@kernel
def jacobian_transpose(handle):
    """See `laws.JacobianTranspose`, of what its handle holds; returns whether any contact bears."""
    tree, state, dynamics, aims, limits, gains, room = opened(handle)
    mass, row, forces, wanted = dynamics.mass, room.row, room.forces, room.wanted
    wanted_base(state, aims, gains[BASE_RATE], wanted)
    for a in range(FREE):
        forces[a] = dynamics.weight[a]
        for b in range(FREE):
            forces[a] += mass[a, b] * wanted[b]
    rate = gains[POSTURE_RATE]
    for k in range(tree.rotor.size):
        lean = rate * (rate * (aims.posture[k] - state.joints[k]) - 2.0 * state.speed[FREE + k])
        forces[FREE + k] = dynamics.weight[FREE + k] + mass[FREE + k, FREE + k] * lean
    for limb in range(aims.does.size):
        if aims.does[limb] != SWINGS:
            continue
        for r in range(5 if points(aims, limb) else 3):
            if r < 3:
                value, most = tip_error(dynamics, aims, gains, limb, r), mass[0, 0]
                for i in range(row.size):
                    row[i] = dynamics.jacobian[limb, r, i]
            else:
                turn_row(dynamics, limb, r - 3, row)
                value = turn_wanted(dynamics, aims, gains, limb, r - 3)
                most = mass[0, 0] * gains[ARM] ** 2
            light = 1.0 / most  # one over what the tip weighs along the row, as if joints were not coupled
            for i in range(FREE, row.size):
                light += row[i] * row[i] / mass[i, i]
            for i in range(FREE, row.size):
                forces[i] += row[i] * value / light
    return shared(tree, dynamics, aims, limits, gains, room)


@kernel
def note_holds(dynamics, aims, room):
    """Remember where limbs took hold."""
    for limb in range(aims.does.size):
        if aims.does[limb] == HOLDS and room.did[limb] != HOLDS:
            room.place[limb] = dynamics.tip[limb]
            room.turn[limb] = dynamics.tip_turn[limb]
        room.did[limb] = aims.does[limb]


@kernel
def joint_rows(aims, work, room, gains, moving, y):
    """Change `y` so that tips come to where they are to be (`moving` 0), or move as they are to with the base (1)."""
    row, base, count = room.row, room.wanted, 0
    for a in range(3):
        base[a], base[3 + a] = aims.velocity[a], 0.0
        for b in range(3):
            base[3 + a] += aims.rotation[b, a] * aims.velocity[3 + b]
    for limb in range(aims.does.size):
        does, turn, jacobian = aims.does[limb], work.tip_turn[limb], work.jacobian[limb]
        if does == HOLDS:
            rows = 3 if aims.components[limb] == 3 else 6
        elif does == SWINGS:
            rows = 5 if points(aims, limb) else 3
        else:
            rows = 0
        for r in range(rows):
            value = 0.0
            if does == SWINGS and r >= 3:
                turn_row(work, limb, r - 3, row)
                if not moving:
                    value = turn_error(work, aims, limb, r - 3)
            else:
                for i in range(row.size):
                    row[i] = jacobian[r, i]
                if does == SWINGS:
                    value = aims.tip_velocity[limb, r] if moving else aims.tip[limb, r] - work.tip[limb, r]
                elif not moving and r < 3:
                    value = room.place[limb, r] - work.tip[limb, r]
                elif not moving:
                    p, q = (r - 2) % 3, (r - 1) % 3
                    for c in range(3):
                        value += 0.5 * (turn[p, c] * room.turn[limb, q, c] - turn[q, c] * room.turn[limb, p, c])
            for a in range(FREE):
                if moving:
                    value -= row[a] * base[a]
                row[a] = 0.0
            count = meet(room.basis, count, row, value, y)


@kernel
def joint_impedance(handle):
    """See `laws.JointImpedance`, of what its handle holds; returns whether any contact bears."""
    tree, state, dynamics, aims, limits, gains, room, reference = opened(handle)
    note_holds(dynamics, aims, room)
    ideal, work, y = reference.state, reference.dynamics, room.y
    ideal.rotation[:], ideal.position[:] = aims.rotation, aims.position
    for _ in range(STEPS):
        place_bodies(tree, ideal, work)
        tip_motion(tree, ideal, work)
        for a in range(FREE):
            y[a] = 0.0
        for k in range(tree.rotor.size):
            y[FREE + k] = LEAN * (aims.posture[k] - ideal.joints[k])
        joint_rows(aims, work, room, gains, False, y)
        for k in range(tree.rotor.size):
            moved = ideal.joints[k] + min(FARTHEST, max(-FARTHEST, y[FREE + k]))
            ideal.joints[k] = min(limits.upper[k], max(limits.lower[k], moved))
    for i in range(y.size):
        reference.speed[i] = 0.0
    joint_rows(aims, work, room, gains, True, reference.speed)
    mass, forces, holding = dynamics.mass, room.forces, 0
    for limb in range(aims.does.size):
        holding += aims.does[limb] == HOLDS
    for i in range(FREE):
        forces[i] = dynamics.weight[i]
    rate = gains[SWING_RATE]
    for k in range(tree.rotor.size):
        i = FREE + k
        inertia = mass[i, i]
        for limb in range(aims.does.size):  # a joint of a limb that holds on moves its part of the whole robot
            if aims.does[limb] == HOLDS:
                for a in range(3):
                    inertia += mass[0, 0] / holding * dynamics.jacobian[limb, a, i] ** 2
        stiffness = min(rate * rate * inertia, limits.torque[k] / GIVES)
        forces[i] = dynamics.weight[i] + stiffness * (ideal.joints[k] - state.joints[k])
        forces[i] += 2.0 * math.sqrt(stiffness * inertia) * (reference.speed[i] - state.speed[i])
    return shared(tree, dynamics, aims, limits, gains, room)
