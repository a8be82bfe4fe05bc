"""Dynamics of a floating tree: frames, mass matrix, bias forces, Jacobians of tips and their rates; composite bodies about the base.

Forces and inertias are taken about the base's origin, so that numbers stay small wherever in the world the robot is.
"""

import math

from ...compiled import inlined, kernel, opened
from .tree import FREE


@inlined
def cross(a0, a1, a2, b0, b1, b2):
    """Cross product."""
    return a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0


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
        w, r = out.spin[p], out.origin[i]
        rx, ry, rz = r[0] - out.origin[p, 0], r[1] - out.origin[p, 1], r[2] - out.origin[p, 2]
        ux, uy, uz = cross(w[0], w[1], w[2], rx, ry, rz)
        t = out.turning[p]
        tx, ty, tz = cross(t[0], t[1], t[2], rx, ry, rz)
        cx, cy, cz = cross(w[0], w[1], w[2], ux, uy, uz)
        zx, zy, zz = axes[0, 2] * qd, axes[1, 2] * qd, axes[2, 2] * qd
        gx, gy, gz = cross(w[0], w[1], w[2], zx, zy, zz)
        v, a0 = out.velocity[p], out.acceleration[p]
        if slides:
            out.velocity[i, 0], out.velocity[i, 1], out.velocity[i, 2] = v[0] + ux + zx, v[1] + uy + zy, v[2] + uz + zz
            out.acceleration[i, 0] = a0[0] + tx + cx + 2.0 * gx
            out.acceleration[i, 1] = a0[1] + ty + cy + 2.0 * gy
            out.acceleration[i, 2] = a0[2] + tz + cz + 2.0 * gz
            for a in range(3):
                out.spin[i, a], out.turning[i, a] = w[a], t[a]
        else:
            out.velocity[i, 0], out.velocity[i, 1], out.velocity[i, 2] = v[0] + ux, v[1] + uy, v[2] + uz
            out.acceleration[i, 0] = a0[0] + tx + cx
            out.acceleration[i, 1] = a0[1] + ty + cy
            out.acceleration[i, 2] = a0[2] + tz + cz
            out.spin[i, 0], out.spin[i, 1], out.spin[i, 2] = w[0] + zx, w[1] + zy, w[2] + zz
            out.turning[i, 0], out.turning[i, 1], out.turning[i, 2] = t[0] + gx, t[1] + gy, t[2] + gz


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
        m, hx, hy, hz = row[0], row[1], row[2], row[3]
        w, t, o = out.spin[i], out.turning[i], out.origin[i]
        # acceleration of the point of the body that is at the base's origin
        rx, ry, rz = out.origin[0, 0] - o[0], out.origin[0, 1] - o[1], out.origin[0, 2] - o[2]
        ux, uy, uz = cross(w[0], w[1], w[2], rx, ry, rz)
        cx, cy, cz = cross(w[0], w[1], w[2], ux, uy, uz)
        tx, ty, tz = cross(t[0], t[1], t[2], rx, ry, rz)
        ax = moving * (out.acceleration[i, 0] + tx + cx) - tree.gravity[0]
        ay = moving * (out.acceleration[i, 1] + ty + cy) - tree.gravity[1]
        az = moving * (out.acceleration[i, 2] + tz + cz) - tree.gravity[2]
        lx, ly, lz = cross(w[0], w[1], w[2], hx, hy, hz)
        kx, ky, kz = cross(w[0], w[1], w[2], lx, ly, lz)
        px, py, pz = cross(t[0], t[1], t[2], hx, hy, hz)
        force[0] = m * ax + moving * (px + kx)
        force[1] = m * ay + moving * (py + ky)
        force[2] = m * az + moving * (pz + kz)
        nx, ny, nz = cross(hx, hy, hz, ax, ay, az)
        jx = row[4] * w[0] + row[5] * w[1] + row[6] * w[2]
        jy = row[7] * w[0] + row[8] * w[1] + row[9] * w[2]
        jz = row[10] * w[0] + row[11] * w[1] + row[12] * w[2]
        qx, qy, qz = cross(w[0], w[1], w[2], jx, jy, jz)
        force[3] = nx + moving * (row[4] * t[0] + row[5] * t[1] + row[6] * t[2] + qx)
        force[4] = ny + moving * (row[7] * t[0] + row[8] * t[1] + row[9] * t[2] + qy)
        force[5] = nz + moving * (row[10] * t[0] + row[11] * t[1] + row[12] * t[2] + qz)
    for i in range(tree.parent.size - 1, 0, -1):
        axis, force = out.axes[i], out.force[i]
        if tree.sliding[i]:
            to[FREE + i - 1] = axis[0, 2] * force[0] + axis[1, 2] * force[1] + axis[2, 2] * force[2]
        else:
            to[FREE + i - 1] = about(out, i, force)
        above = out.force[tree.parent[i]]
        for c in range(6):
            above[c] += force[c]
    for a in range(3):
        to[a] = out.force[0, a]
        to[3 + a] = 0.0
        for b in range(3):
            to[3 + a] += out.axes[0, b, a] * out.force[0, 3 + b]


@inlined
def about(out, i, force):
    """Moment of a force (its moment about the base's origin behind it) about a joint's axis."""
    rx = out.origin[i, 0] - out.origin[0, 0]
    ry = out.origin[i, 1] - out.origin[0, 1]
    rz = out.origin[i, 2] - out.origin[0, 2]
    x, y, z = cross(rx, ry, rz, force[0], force[1], force[2])
    axis = out.axes[i]
    return axis[0, 2] * (force[3] - x) + axis[1, 2] * (force[4] - y) + axis[2, 2] * (force[5] - z)


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
        row, axes = out.heavy[i], out.axes[i]
        zx, zy, zz = axes[0, 2], axes[1, 2], axes[2, 2]
        at = FREE + i - 1
        if tree.sliding[i]:
            force[0], force[1], force[2] = row[0] * zx, row[0] * zy, row[0] * zz
            force[3], force[4], force[5] = cross(row[1], row[2], row[3], zx, zy, zz)
        else:
            rx = out.origin[i, 0] - out.origin[0, 0]
            ry = out.origin[i, 1] - out.origin[0, 1]
            rz = out.origin[i, 2] - out.origin[0, 2]
            vx, vy, vz = cross(rx, ry, rz, zx, zy, zz)
            hx, hy, hz = cross(zx, zy, zz, row[1], row[2], row[3])
            force[0], force[1], force[2] = row[0] * vx + hx, row[0] * vy + hy, row[0] * vz + hz
            nx, ny, nz = cross(row[1], row[2], row[3], vx, vy, vz)
            force[3] = nx + row[4] * zx + row[5] * zy + row[6] * zz
            force[4] = ny + row[7] * zx + row[8] * zy + row[9] * zz
            force[5] = nz + row[10] * zx + row[11] * zy + row[12] * zz
        j = i
        while j > 0:
            if tree.sliding[j]:
                value = out.axes[j, 0, 2] * force[0] + out.axes[j, 1, 2] * force[1] + out.axes[j, 2, 2] * force[2]
            else:
                value = about(out, j, force)
            mass[at, FREE + j - 1] = mass[FREE + j - 1, at] = value
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
        vx, vy, vz = cross(axes[0, a], axes[1, a], axes[2, a], row[1], row[2], row[3])
        mass[3 + a, 0] = mass[0, 3 + a] = vx
        mass[3 + a, 1] = mass[1, 3 + a] = vy
        mass[3 + a, 2] = mass[2, 3 + a] = vz
        for b in range(3):
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
            at, axes = FREE + j - 1, out.axes[j]
            zx, zy, zz = axes[0, 2], axes[1, 2], axes[2, 2]
            if tree.sliding[j]:
                jacobian[0, at], jacobian[1, at], jacobian[2, at] = zx, zy, zz
            else:
                rx, ry, rz = tip[0] - out.origin[j, 0], tip[1] - out.origin[j, 1], tip[2] - out.origin[j, 2]
                jacobian[0, at], jacobian[1, at], jacobian[2, at] = cross(zx, zy, zz, rx, ry, rz)
                jacobian[3, at], jacobian[4, at], jacobian[5, at] = zx, zy, zz
            j = tree.parent[j]
        rx, ry, rz = tip[0] - out.origin[0, 0], tip[1] - out.origin[0, 1], tip[2] - out.origin[0, 2]
        for a in range(3):
            jacobian[a, a] = 1.0
            zx, zy, zz = out.axes[0, 0, a], out.axes[0, 1, a], out.axes[0, 2, a]
            jacobian[0, 3 + a], jacobian[1, 3 + a], jacobian[2, 3 + a] = cross(zx, zy, zz, rx, ry, rz)
            jacobian[3, 3 + a], jacobian[4, 3 + a], jacobian[5, 3 + a] = zx, zy, zz
        for r in range(6):
            total = 0.0
            for c in range(jacobian.shape[1]):
                total += jacobian[r, c] * state.speed[c]
            out.tip_speed[limb, r] = total
        w, t, o = out.spin[i], out.turning[i], out.origin[i]
        rx, ry, rz = tip[0] - o[0], tip[1] - o[1], tip[2] - o[2]
        ux, uy, uz = cross(w[0], w[1], w[2], rx, ry, rz)
        cx, cy, cz = cross(w[0], w[1], w[2], ux, uy, uz)
        tx, ty, tz = cross(t[0], t[1], t[2], rx, ry, rz)
        rates = out.tip_bias[limb]
        rates[0] = out.acceleration[i, 0] + tx + cx
        rates[1] = out.acceleration[i, 1] + ty + cy
        rates[2] = out.acceleration[i, 2] + tz + cz
        for a in range(3):
            rates[3 + a] = t[a]


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
