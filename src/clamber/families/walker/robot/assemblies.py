"""Forward kinematics of the planar 3-RPR mechanism: every pose that has the given lengths of the actuators."""

import math
from typing import Final

import numpy as np

from ....types import Complexes, Floats
from .two_frames import actuator_lengths, length_jacobian

ON_CIRCLE: Final = 1e-3
"""A root counts as an angle if its size is within this of 1: a double root splits by the square root of rounding [-]."""
EXACT: Final = 1e-10
"""Largest error of a length in a solution, relative to the mechanism's size [-]."""
APART: Final = 1e-6
"""Solutions that differ by less are one: relative to the mechanism's size, and [rad]."""


def assemblies(delta: Floats, y: Floats, lengths: Floats) -> Floats:
    """All real poses of the Y-frame in the Delta-frame with these lengths: at most four for similar triangles, else at most six.

    Args:
        delta, y: Attachments of both frames, each in its own frame [m], shape (3, 2).
        lengths: Of the actuators [m], shape (3,).

    Returns:
        x, y [m] and theta in (-pi, pi] [rad] of each, by theta, shape (n, 3).
    """
    size = max(float(np.ptp(delta, axis=0).max()), float(np.ptp(y, axis=0).max()), float(lengths.max()))
    found: list[Floats] = []
    for guess in similar_poses(delta, y, lengths) if are_similar(delta, y) else general_poses(delta, y, lengths):
        pose = _polish(delta, y, lengths, guess, size)
        if pose is not None and not any(_same(pose, other, size) for other in found):
            found.append(pose)
    return np.array(sorted(found, key=lambda pose: (pose[2], pose[0], pose[1]))).reshape(-1, 3)


def are_similar(delta: Floats, y: Floats) -> bool:
    """Whether the triangles of the attachments are directly similar and no lines, so that the closed form holds."""
    a, b = _complex(delta), _complex(y)
    u, v = a[1:] - a[0], b[1:] - b[0]
    spread = abs(u).max() * abs(v).max()
    corners = abs((np.conj(u[0]) * u[1]).imag) > 1e-9 * abs(u).max() ** 2
    return bool(corners and abs(u[0] * v[1] - u[1] * v[0]) <= 1e-12 * spread)


def similar_poses(delta: Floats, y: Floats, lengths: Floats) -> list[Floats]:
    """The closed form for directly similar triangles, at most four poses.

    About the triangles' circumcentres, in complex numbers, B_i = k A_i and |A_i| = a, so c_i = z A_i with z = k e^(i theta) - 1. Then
    L_i^2 = |p|^2 + 2 A_i . w + |z|^2 a^2 with w = conj(z) p is linear in w and m = |p|^2 + |z|^2 a^2, and |w| = |z| |p| makes of m a
    quadratic in |z|^2, each root of which has two angles.
    """
    a, b = _complex(delta), _complex(y)
    middle_a, middle_b = circumcentre(a), circumcentre(b)
    a, b = a - middle_a, b - middle_b
    ratio = complex((b[1] - b[0]) / (a[1] - a[0]))
    solved = np.linalg.solve(np.column_stack([2.0 * a.real, 2.0 * a.imag, np.ones(3)]), lengths**2)
    w, mean, square = complex(solved[0], solved[1]), float(solved[2]), abs(a[0]) ** 2
    under = mean * mean - 4.0 * square * abs(w) ** 2
    poses = []
    for sign in (1.0, -1.0):
        z_square = (mean + sign * math.sqrt(max(0.0, under))) / (2.0 * square)
        cosine = (1.0 + abs(ratio) ** 2 - z_square) / (2.0 * abs(ratio))
        if under < -1e-9 * mean * mean or abs(cosine) > 1.0 + 1e-9:
            continue
        for turn in (1.0, -1.0):
            theta = turn * math.acos(min(1.0, max(-1.0, cosine))) - math.atan2(ratio.imag, ratio.real)
            z = ratio * complex(math.cos(theta), math.sin(theta)) - 1.0
            if abs(z) <= 1e-12:  # all c_i vanish: the frame may then be anywhere on a circle, or nowhere
                continue
            p = w / z.conjugate() + middle_a - middle_b * complex(math.cos(theta), math.sin(theta))
            poses.append(np.array([p.real, p.imag, theta]))
    return poses


def general_poses(delta: Floats, y: Floats, lengths: Floats) -> list[Floats]:
    """Any attachments: at most six poses, from a polynomial in e^(i theta).

    Seen from the first attachments, with d_i = R b_i - a_i: |p| = L_1 and p . d_i = g_i = (L_i^2 - L_1^2 - |d_i|^2) / 2 for i = 2, 3.
    In complex numbers Cramer's rule gives p = n / (d_2 x d_3) with n = i (g_3 d_2 - g_2 d_3), so |n|^2 = L_1^2 (d_2 x d_3)^2, which is
    trigonometric of degree three.
    """
    a, b = _complex(delta), _complex(y)
    turned = np.zeros((2, 3), complex)  # d_i as a polynomial in e^(i theta), from power -1 to 1
    turned[:, 1], turned[:, 2] = -(a[1:] - a[0]), b[1:] - b[0]
    pull = np.zeros((2, 3), complex)  # g_i
    pull[:, 1] = (lengths[1:] ** 2 - lengths[0] ** 2 - abs(turned[:, 1]) ** 2 - abs(turned[:, 2]) ** 2) / 2.0
    pull[:, 2] = -turned[:, 2] * np.conj(turned[:, 1]) / 2.0
    pull[:, 0] = np.conj(pull[:, 2])
    cross = (np.convolve(_conj(turned[0]), turned[1]) - np.convolve(turned[0], _conj(turned[1]))) / 2j  # powers -2 to 2
    top = 1j * (np.convolve(pull[1], turned[0]) - np.convolve(pull[0], turned[1]))
    polynomial = np.convolve(top, _conj(top)) - lengths[0] ** 2 * np.convolve(cross, cross)  # powers -4 to 4
    roots = np.roots(polynomial[1:-1][::-1])  # d_i has no power -1, so the product has none of size 4
    poses = []
    for root in roots[abs(abs(roots) - 1.0) < ON_CIRCLE]:
        theta = math.atan2(root.imag, root.real)
        turn = complex(math.cos(theta), math.sin(theta))
        powers = turn ** np.arange(-1, 2)
        d, g = turned @ powers, (pull @ powers).real
        divisor = float((np.conj(d[0]) * d[1]).imag)
        if abs(divisor) > 1e-9 * float(abs(d[0]) * abs(d[1])):
            places = [1j * (g[1] * d[0] - g[0] * d[1]) / divisor]
        else:  # both lines are one: its two points at the right distance
            longer = d[int(np.argmax(abs(d)))]
            if abs(longer) == 0.0:
                continue
            along = complex(g[int(np.argmax(abs(d)))] / np.conj(longer))
            off = math.sqrt(max(0.0, float(lengths[0]) ** 2 - abs(along) ** 2)) * 1j * longer / abs(longer)
            places = [along + off, along - off]
        for place in places:
            p = place + a[0] - turn * b[0]
            poses.append(np.array([p.real, p.imag, theta]))
    return poses


def circumcentre(points: Complexes) -> complex:
    """Middle of the circle through three points [m]; they must not be on a line."""
    u, v = points[1] - points[0], points[2] - points[0]
    return complex(points[0] + 1j * (abs(v) ** 2 * u - abs(u) ** 2 * v) / (2.0 * (u.conjugate() * v).imag))


def _complex(points: Floats) -> Complexes:
    return points[:, 0] + 1j * points[:, 1]


def _conj(polynomial: Complexes) -> Complexes:
    """Complex conjugate of a polynomial in e^(i theta) with powers from -n to n."""
    return np.conj(polynomial)[::-1]


def _polish(delta: Floats, y: Floats, lengths: Floats, guess: Floats, size: float) -> Floats | None:
    """The solution next to a guess by Newton's method (least squares where it is singular); None if there is none."""
    pose = guess.copy()
    now, jacobian = np.empty(3), np.empty((3, 3))
    for _ in range(30):
        actuator_lengths(delta, y, pose[0], pose[1], pose[2], now)
        if now.min() <= 0.0:
            break
        length_jacobian(delta, y, pose[0], pose[1], pose[2], now, jacobian)
        jacobian[:, 2] /= size
        change = np.linalg.lstsq(jacobian, lengths - now, rcond=1e-12)[0]
        pose += change * (1.0, 1.0, 1.0 / size)
        if abs(change).max() < 1e-15 * size:
            break
    actuator_lengths(delta, y, pose[0], pose[1], pose[2], now)
    if not abs(now - lengths).max() <= EXACT * size:
        return None
    pose[2] -= math.tau * math.ceil((pose[2] - math.pi) / math.tau)
    return pose


def _same(one: Floats, other: Floats, size: float) -> bool:
    turn = (one[2] - other[2] + math.pi) % math.tau - math.pi
    return bool(np.hypot(*(one - other)[:2]) < APART * size and abs(turn) < APART)
