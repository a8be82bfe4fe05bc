"""Dynamics of a floating tree: frames, mass matrix, bias forces, Jacobians of tips and their rates; composite bodies about the base.

Forces and inertias are taken about the base's origin, so that numbers stay small wherever in the world the robot is.
"""

import math

from ...compiled import inlined, kernel, opened
from ..kinematics import column, cross, dot, keep_three, less, plus, scaled, three
from .tree import FREE


@inlined
def _times(row, vector):
    """A vector turned by a heavy body's inertia about the base's origin."""
    return dot(three(row, 4), vector), dot(three(row, 7), vector), dot(three(row, 10), vector)


@inlined
def _way(out, start, end):
    """From one body's origin to another's."""
    return less(out.origin[end], out.origin[start])


@kernel
def place_bodies(tree, state, out):
    """Frames of all bodies, how they move, and the rates of that without acceleration of any generalised speed."""
    for a in range(3):
        out.origin[0, a] = state.position[a]
        out.velocity[0, a] = state.speed[a]
        out.spin[0, a] = 0.0
        out.turning[0, a] = 0.0
        out.acceleration[0, a] = 0.0
        for b in range(3):
            out.axes[0, a, b] = state.rotation[a, b]
            out.spin[0, a] += state.rotation[a, b] * state.speed[3 + b]
    for i in range(1, tree.parent.size):
        p = tree.parent[i]
        axes, before = out.axes[i], out.axes[p]
        q, qd = state.joints[i - 1], state.speed[FREE + i - 1]
        slides = tree.sliding[i]
        cosine, sine = (1.0, 0.0) if slides else (math.cos(q), math.sin(q))
        for a in range(3):
            x = (
                before[a, 0] * tree.turn[i, 0, 0]
                + before[a, 1] * tree.turn[i, 1, 0]
                + before[a, 2] * tree.turn[i, 2, 0]
            )
            y = (
                before[a, 0] * tree.turn[i, 0, 1]
                + before[a, 1] * tree.turn[i, 1, 1]
                + before[a, 2] * tree.turn[i, 2, 1]
            )
            axes[a, 2] = (
                before[a, 0] * tree.turn[i, 0, 2]
                + before[a, 1] * tree.turn[i, 1, 2]
                + before[a, 2] * tree.turn[i, 2, 2]
            )
            axes[a, 0], axes[a, 1] = cosine * x + sine * y, cosine * y - sine * x
            out.origin[i, a] = out.origin[p, a] + before[a, 0] * tree.offset[i, 0]
            out.origin[i, a] += before[a, 1] * tree.offset[i, 1] + before[a, 2] * tree.offset[i, 2]
            if slides:
                out.origin[i, a] += q * axes[a, 2]
        w, t, r = out.spin[p], out.turning[p], _way(out, p, i)
        along = cross(w, r)
        moved = plus(out.velocity[p], along)
        sped = plus(plus(out.acceleration[p], cross(t, r)), cross(w, along))
        own = scaled(qd, column(axes, 2))
        turned = cross(w, own)
        if slides:
            keep_three(out.velocity[i], 0, plus(moved, own))
            keep_three(out.acceleration[i], 0, plus(sped, scaled(2.0, turned)))
            keep_three(out.spin[i], 0, w)
            keep_three(out.turning[i], 0, t)
        else:
            keep_three(out.velocity[i], 0, moved)
            keep_three(out.acceleration[i], 0, sped)
            keep_three(out.spin[i], 0, plus(w, own))
            keep_three(out.turning[i], 0, plus(t, turned))


@kernel
def weigh_bodies(tree, out):
    """Mass, first moment and inertia about the base's origin of every body by itself, into `heavy`."""
    for i in range(tree.parent.size):
        axes, row, m = out.axes[i], out.heavy[i], tree.mass[i]
        row[0] = m
        square = 0.0
        for a in range(3):
            c = out.origin[i, a] - out.origin[0, a]
            for b in range(3):
                c += axes[a, b] * tree.centre[i, b]
            row[1 + a] = m * c
            square += c * m * c
        for a in range(3):
            for b in range(3):
                total = 0.0
                for c in range(3):
                    for d in range(3):
                        total += axes[a, c] * tree.inertia[i, c, d] * axes[b, d]
                if m > 0.0:
                    total -= row[1 + a] * row[1 + b] / m
                row[4 + 3 * a + b] = total + (square if a == b else 0.0)


@kernel
def bias_forces(tree, out, moving, to):
    """Generalised forces without acceleration, of the moving robot or of one at rest (`moving` 0 or 1), into `to`; after `weigh_bodies`."""
    for i in range(tree.parent.size):
        row, force = out.heavy[i], out.force[i]
        m, h, w, t = row[0], three(row, 1), out.spin[i], out.turning[i]
        # acceleration of the point of the body that is at the base's origin
        r = _way(out, i, 0)
        sped = plus(plus(out.acceleration[i], cross(t, r)), cross(w, cross(w, r)))
        falls = less(scaled(moving, sped), tree.gravity)
        whirls = plus(cross(t, h), cross(w, cross(w, h)))
        keep_three(force, 0, plus(scaled(m, falls), scaled(moving, whirls)))
        turns = plus(_times(row, t), cross(w, _times(row, w)))
        keep_three(force, 3, plus(cross(h, falls), scaled(moving, turns)))
    for i in range(tree.parent.size - 1, 0, -1):
        force = out.force[i]
        to[FREE + i - 1] = _on_joint(tree, out, i, force)
        above = out.force[tree.parent[i]]
        for c in range(6):
            above[c] += force[c]
    for a in range(3):
        to[a] = out.force[0, a]
        to[3 + a] = 0.0
        for b in range(3):
            to[3 + a] += out.axes[0, b, a] * out.force[0, 3 + b]


@inlined
def _on_joint(tree, out, i, force):
    """What a force, its moment about the base's origin behind it, does along a sliding joint's axis or about a turning one's."""
    axis = column(out.axes[i], 2)
    if tree.sliding[i]:
        return dot(axis, force)
    return dot(axis, less(three(force, 3), cross(_way(out, 0, i), force)))


@kernel
def mass_matrix(tree, out):
    """The mass matrix, of composite bodies; `heavy` becomes theirs."""
    for i in range(tree.parent.size - 1, 0, -1):
        above = out.heavy[tree.parent[i]]
        for c in range(13):
            above[c] += out.heavy[i, c]
    mass, force = out.mass, out.force[0]
    for i in range(mass.shape[0]):
        for j in range(mass.shape[0]):
            mass[i, j] = 0.0
    for i in range(1, tree.parent.size):
        row, axis = out.heavy[i], column(out.axes[i], 2)
        at, h = FREE + i - 1, three(row, 1)
        if tree.sliding[i]:
            keep_three(force, 0, scaled(row[0], axis))
            keep_three(force, 3, cross(h, axis))
        else:
            moved = cross(_way(out, 0, i), axis)
            keep_three(force, 0, plus(scaled(row[0], moved), cross(axis, h)))
            turned = cross(h, moved)
            for a in range(3):
                force[3 + a] = (
                    turned[a] + row[4 + 3 * a] * axis[0] + row[5 + 3 * a] * axis[1] + row[6 + 3 * a] * axis[2]
                )
        j = i
        while j > 0:
            mass[at, FREE + j - 1] = mass[FREE + j - 1, at] = _on_joint(tree, out, j, force)
            j = tree.parent[j]
        mass[at, at] += tree.rotor[i - 1]
        for a in range(3):
            mass[at, a] = mass[a, at] = force[a]
            value = 0.0
            for b in range(3):
                value += out.axes[0, b, a] * force[3 + b]
            mass[at, 3 + a] = mass[3 + a, at] = value
    row, axes = out.heavy[0], out.axes[0]
    for a in range(3):
        mass[a, a] = row[0]
        keep_three(mass[3 + a], 0, cross(column(axes, a), three(row, 1)))
        for b in range(3):
            mass[b, 3 + a] = mass[3 + a, b]
            value = 0.0
            for c in range(3):
                for d in range(3):
                    value += axes[c, a] * row[4 + 3 * c + d] * axes[d, b]
            mass[3 + a, 3 + b] = value


@kernel
def tip_motion(tree, state, out):
    """Places, directions, Jacobians and rates of all tips."""
    for limb in range(tree.end.size):
        i = tree.end[limb]
        tip, jacobian = out.tip[limb], out.jacobian[limb]
        for a in range(3):
            tip[a] = out.origin[i, a]
            for b in range(3):
                tip[a] += out.axes[i, a, b] * tree.tip[limb, b]
                out.tip_turn[limb, a, b] = 0.0
                for c in range(3):
                    out.tip_turn[limb, a, b] += out.axes[i, a, c] * tree.tip_turn[limb, c, b]
        for r in range(6):
            for c in range(jacobian.shape[1]):
                jacobian[r, c] = 0.0
        j = i
        while j > 0:
            turns, axis = jacobian[:, FREE + j - 1], column(out.axes[j], 2)
            if tree.sliding[j]:
                keep_three(turns, 0, axis)
            else:
                keep_three(turns, 0, cross(axis, less(tip, out.origin[j])))
                keep_three(turns, 3, axis)
            j = tree.parent[j]
        for a in range(3):
            jacobian[a, a] = 1.0
            axis = column(out.axes[0], a)
            keep_three(jacobian[:, 3 + a], 0, cross(axis, less(tip, out.origin[0])))
            keep_three(jacobian[:, 3 + a], 3, axis)
        for r in range(6):
            total = 0.0
            for c in range(jacobian.shape[1]):
                total += jacobian[r, c] * state.speed[c]
            out.tip_speed[limb, r] = total
        w, t, r = out.spin[i], out.turning[i], less(tip, out.origin[i])
        keep_three(out.tip_bias[limb], 0, plus(plus(out.acceleration[i], cross(t, r)), cross(w, cross(w, r))))
        keep_three(out.tip_bias[limb], 3, t)


@kernel
def work_out(tree, state, out):
    """All of `Dynamics` for a state."""
    place_bodies(tree, state, out)
    weigh_bodies(tree, out)
    bias_forces(tree, out, 1.0, out.bias)
    bias_forces(tree, out, 0.0, out.weight)
    mass_matrix(tree, out)
    tip_motion(tree, state, out)


@kernel
def look(handle):
    """`work_out` of what a handle holds: a tree, its state and `Dynamics` first."""
    held = opened(handle)
    work_out(held[0], held[1], held[2])
