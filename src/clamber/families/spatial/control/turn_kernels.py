"""Rotations, as kernels."""

import math

from ....compiled import inlined, kernel


@inlined
def turn_by(x, y, z, matrix):
    """Turn the columns of a rotation by a rotation vector in world axes (Rodrigues)."""
    angle = math.sqrt(x * x + y * y + z * z)
    if angle < 1e-9:
        a, b = 1.0, 0.5
    else:
        a, b = math.sin(angle) / angle, (1.0 - math.cos(angle)) / (angle * angle)
    for c in range(3):
        u, v, w = matrix[0, c], matrix[1, c], matrix[2, c]
        cx, cy, cz = y * w - z * v, z * u - x * w, x * v - y * u
        dx, dy, dz = y * cz - z * cy, z * cx - x * cz, x * cy - y * cx
        matrix[0, c] = u + a * cx + b * dx
        matrix[1, c] = v + a * cy + b * dy
        matrix[2, c] = w + a * cz + b * dz


@inlined
def shift_by(x, y, z, ex, ey, ez, vector):
    """A vector turned by a small rotation in world axes, less an error."""
    u, v, w = vector[0], vector[1], vector[2]
    cx, cy, cz = y * w - z * v, z * u - x * w, x * v - y * u
    vector[0] = u + cx + 0.5 * (y * cz - z * cy) - ex
    vector[1] = v + cy + 0.5 * (z * cx - x * cz) - ey
    vector[2] = w + cz + 0.5 * (x * cy - y * cx) - ez


@inlined
def write_axes(q, axes):
    """Axes of a frame with a unit quaternion w, x, y, z, as columns, shape (3, 3)."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    axes[0, 0] = w * w + x * x - y * y - z * z
    axes[1, 1] = w * w - x * x + y * y - z * z
    axes[2, 2] = w * w - x * x - y * y + z * z
    axes[0, 1], axes[1, 0] = 2.0 * (x * y - w * z), 2.0 * (x * y + w * z)
    axes[0, 2], axes[2, 0] = 2.0 * (x * z + w * y), 2.0 * (x * z - w * y)
    axes[1, 2], axes[2, 1] = 2.0 * (y * z - w * x), 2.0 * (y * z + w * x)


@kernel
def write_quaternion(r, q):
    """Unit quaternion w, x, y, z of a rotation, w not negative, by the largest of its parts (Shepperd 1978)."""
    parts = (r[0, 0] + r[1, 1] + r[2, 2], r[0, 0], r[1, 1], r[2, 2])
    largest = 0
    for k in range(1, 4):
        if parts[k] > parts[largest]:
            largest = k
    if largest == 0:
        q[0] = 1.0 + parts[0]
        q[1], q[2], q[3] = r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]
    else:
        i = largest - 1
        j, k = (i + 1) % 3, (i + 2) % 3
        q[0] = r[k, j] - r[j, k]
        q[1 + i], q[1 + j], q[1 + k] = 1.0 + 2.0 * r[i, i] - parts[0], r[j, i] + r[i, j], r[k, i] + r[i, k]
    length = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    if q[0] < 0.0:
        length = -length
    for k in range(4):
        q[k] /= length
