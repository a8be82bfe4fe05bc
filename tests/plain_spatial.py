"""Statics of a limbed robot in space a second time: matrices, potential energy and HiGHS; slow, obvious, nothing shared."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog, lsq_linear

from clamber.families.spatial.robot.chains import Chains
from clamber.families.spatial.robot.contacts import Contact
from clamber.types import Floats

LEAST_WEIGHT = 0.0980665


def turn_about(axis: Floats, angle: float) -> Floats:
    """Rotation matrix by Rodrigues' formula."""
    x, y, z = axis
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turn: Floats = np.eye(3) + np.sin(angle) * k + (1.0 - np.cos(angle)) * (k @ k)
    return turn


def frames(chains: Chains, limb: int, posture: Floats, base: Floats) -> list[Floats]:
    """4 x 4 frames of all links and of the end effector in the world; the joint's motion in each."""
    found = []
    here = base
    n = chains.n_joints[limb]
    for k in range(n + 1):
        step = np.eye(4)
        step[:3, :3], step[:3, 3] = chains.rotation[limb, k], chains.offset[limb, k]
        here = here @ step
        if k < n:
            motion = np.eye(4)
            if chains.sliding[limb, k]:
                motion[2, 3] = posture[k]
            else:
                motion[:3, :3] = turn_about(np.array([0.0, 0.0, 1.0]), posture[k])
            here = here @ motion
        found.append(here)
    return found


def joints(chains: Chains, limb: int, posture: Floats, base: Floats) -> Floats:
    """Places of a limb's joints and tip [m], shape (joints + 1, 3)."""
    return np.array([frame[:3, 3] for frame in frames(chains, limb, posture, base)])


def links(chains: Chains, limb: int, at: Floats) -> list[tuple[Floats, float]]:
    """Ends and radius of each link but the first, which lies beside others' [m]; `at` has a limb's joints."""
    return [(at[k : k + 2], float(chains.radius[limb, k])) for k in range(1, int(chains.n_joints[limb]))]


def limb_gap(chains: Chains, limb: int, at: Floats, others: Mapping[int, Floats]) -> float:
    """Smallest gap between the links of a limb and those of others [m]."""
    return min(
        gap_of_segments(p, q) - a - b
        for other, there in others.items()
        for p, a in links(chains, limb, at)
        for q, b in links(chains, other, there)
    )


def base_gap(chains: Chains, limb: int, at: Floats) -> float:
    """Smallest gap between the base's box and a limb's links but the first two, joints in the base frame [m]."""
    least = math.inf
    for ends, radius in links(chains, limb, at)[1:]:
        points = ends[0] + np.linspace(0.0, 1.0, 501)[:, None] * (ends[1] - ends[0])
        least = min(least, float(depth_in_box(points, chains.base_half).min()) - radius)
    return least


def tip(chains: Chains, limb: int, posture: Floats, base: Floats) -> Floats:
    place: Floats = frames(chains, limb, posture, base)[-1][:3, 3]
    return place


def limb_energy(chains: Chains, limb: int, posture: Floats, base: Floats, gravity: Floats) -> float:
    """Potential energy of a limb's links [J]."""
    total = 0.0
    for k, frame in enumerate(frames(chains, limb, posture, base)[:-1]):
        place = (frame @ np.append(chains.centre[limb, k], 1.0))[:3]
        total -= float(chains.mass[limb, k] * gravity @ place)
    return total


def stretch(chains: Chains, limb: int) -> float:
    n = chains.n_joints[limb]
    slides = [max(abs(chains.lower[limb, k]), abs(chains.upper[limb, k])) for k in range(n) if chains.sliding[limb, k]]
    return sum(float(np.linalg.norm(chains.offset[limb, k])) for k in range(1, n + 1)) + float(sum(slides))


@dataclass(frozen=True)
class PlainStance:
    """A stance as the statics was handed it, with its posture."""

    base: Floats
    """T_world_base, shape (4, 4)."""
    gravity: Floats
    wrench: Floats
    posture: Floats
    places: Floats
    """Of the contacts, shape (limbs, 3), world frame."""
    normals: Floats
    along: Floats
    """Of bars and the like; zeros where the end effector's x is the first tangent."""
    bears: list[bool]
    strength: Floats
    friction: Floats


def contact_axes(end: Floats, normal: Floats, along: Floats) -> Floats:
    """Rows normal, tangent, tangent of a contact, world frame, by Gram and Schmidt."""
    first = along if along.any() else end[:3, 0] if abs(end[:3, 0] @ normal) <= 0.9 else end[:3, 1]
    first = first - (first @ normal) * normal
    first = first / np.linalg.norm(first)
    return np.array([normal, first, np.cross(normal, first)])


def gap_of_segments(first: Floats, second: Floats) -> float:
    """Distance of two segments, each of shape (2, 3), by bounded least squares."""
    across = np.column_stack([first[1] - first[0], second[0] - second[1]])
    found = lsq_linear(across, second[0] - first[0], (0.0, 1.0), tol=1e-14)
    return float(np.sqrt(2.0 * found.cost))


def depth_in_box(points: Floats, half: Floats) -> Floats:
    """Signed distance of points from a box about the origin, shape (n,)."""
    over = np.abs(points) - half
    found: Floats = np.linalg.norm(np.maximum(over, 0.0), axis=1) + np.minimum(over.max(axis=1), 0.0)
    return found


def plain_margins(chains: Chains, contacts: list[Contact], stance: PlainStance) -> dict[str, float]:
    """Margins of a stance in the posture that it states, without any room or need that rules ask for: distances are signed."""
    limbs = range(len(contacts))
    placed = [frames(chains, limb, stance.posture[limb], stance.base) for limb in limbs]
    reach = max(float(np.linalg.norm(placed[limb][-1][:3, 3] - stance.places[limb])) for limb in limbs)
    joint, tilt, limb_limb, limb_body = math.inf, math.inf, math.inf, math.inf
    inverse = np.linalg.inv(stance.base)
    for limb in limbs:
        n = chains.n_joints[limb]
        q = stance.posture[limb, :n]
        joint = min(joint, *(q - chains.lower[limb, :n]), *(chains.upper[limb, :n] - q))
        if stance.bears[limb]:
            cosine = float(np.clip(-placed[limb][-1][:3, 2] @ stance.normals[limb], -1.0, 1.0))
            tilt = min(tilt, contacts[limb].tilt - math.acos(cosine))
        mine = np.array([frame[:3, 3] for frame in placed[limb]])
        for other in range(limb):
            theirs = np.array([frame[:3, 3] for frame in placed[other]])
            for k in range(1, n):
                for h in range(1, chains.n_joints[other]):
                    gap = gap_of_segments(mine[k : k + 2], theirs[h : h + 2])
                    limb_limb = min(limb_limb, gap - chains.radius[limb, k] - chains.radius[other, h])
        own = mine @ inverse[:3, :3].T + inverse[:3, 3]
        for k in range(2, n):
            points = own[k] + np.linspace(0.0, 1.0, 2001)[:, None] * (own[k + 1] - own[k])
            limb_body = min(limb_body, float(depth_in_box(points, chains.base_half).min()) - chains.radius[limb, k])
    s = solve_forces(chains, contacts, stance)
    return {
        "reach": -reach,
        "joint": joint,
        "tilt": tilt,
        "limb_limb": limb_limb,
        "limb_body": limb_body,
        "equilibrium": s,
    }


def solve_forces(chains: Chains, contacts: list[Contact], stance: PlainStance) -> float:
    """Largest s of the stance by HiGHS; minus infinity if no forces balance. Unknowns are forces and moments in newtons, world frame."""
    limbs = len(contacts)
    size = max(stretch(chains, limb) for limb in range(limbs))
    mass = chains.total_mass
    weight = max(
        mass * max(float(np.linalg.norm(stance.gravity)), LEAST_WEIGHT),
        float(np.linalg.norm(stance.wrench[:3])),
        float(np.linalg.norm(stance.wrench[3:])) / size,
    )
    origin = stance.base[:3, 3]
    force = mass * stance.gravity + stance.wrench[:3]
    centre = np.append(chains.base_centre, 1.0)
    moment = np.cross((stance.base @ centre)[:3] - origin, chains.base_mass * stance.gravity) + stance.wrench[3:]
    for limb in range(limbs):
        for k, frame in enumerate(frames(chains, limb, stance.posture[limb], stance.base)[:-1]):
            place = (frame @ np.append(chains.centre[limb, k], 1.0))[:3]
            moment = moment + np.cross(place - origin, chains.mass[limb, k] * stance.gravity)
    wide = [(contacts[limb].components if stance.bears[limb] else 0) for limb in range(limbs)]
    starts = np.concatenate([[0], np.cumsum(wide)])
    n = int(starts[-1])
    balance = np.zeros((6, n))
    rows, bound = [], []
    for limb in range(limbs):
        frame_list = frames(chains, limb, stance.posture[limb], stance.base)
        end = frame_list[-1][:3, 3]
        if stance.bears[limb]:
            at = slice(starts[limb], starts[limb + 1])
            arm = stance.places[limb] - origin
            axes = contact_axes(frame_list[-1], stance.normals[limb], stance.along[limb])
            for c in range(wide[limb]):
                unit = np.eye(3)[c % 3]
                column = np.concatenate([unit, np.cross(arm, unit)] if c < 3 else [np.zeros(3), unit])
                balance[:, starts[limb] + c] = column
            cosine = float(np.clip(-frame_list[-1][:3, 2] @ stance.normals[limb], -1.0, 1.0))
            kind = contacts[limb]
            kept = kind.pull * max(0.0, 1.0 - kind.tilt_loss * math.acos(cosine)) if kind.tilt_loss else kind.pull
            matrix, limit = kind.polytope(float(stance.friction[limb]), min(kept, float(stance.strength[limb])))
            for row, (coefficients, most) in enumerate(zip(matrix, limit, strict=True)):
                slack = contacts[limb].rows[row].slack
                line = np.zeros(n + 1)
                world = np.concatenate([coefficients[:3] @ axes, coefficients[3:] @ axes])
                line[at] = world[: wide[limb]]
                line[-1] = slack[0] * weight + slack[1]
                rows.append(line)
                bound.append(most)
        for k in range(chains.n_joints[limb]):
            step = 1e-5
            q = stance.posture[limb].copy()
            q[k] += step
            more = limb_energy(chains, limb, q, stance.base, stance.gravity)
            q[k] -= 2 * step
            less = limb_energy(chains, limb, q, stance.base, stance.gravity)
            load = -(more - less) / (2 * step)
            line = np.zeros(n + 1)
            if stance.bears[limb]:
                axis = frame_list[k][:3, 2]
                arm = end - frame_list[k][:3, 3]
                for c in range(wide[limb]):
                    unit = np.eye(3)[c % 3]
                    by_hinge = axis @ (np.cross(arm, unit) if c < 3 else unit)
                    by_slide = axis @ unit if c < 3 else 0.0
                    line[starts[limb] + c] = by_slide if chains.sliding[limb, k] else by_hinge
            for sign in (1.0, -1.0):
                signed = sign * line
                signed[-1] = chains.torque[limb, k]
                rows.append(signed)
                bound.append(chains.torque[limb, k] - sign * load)
    wanted = -np.concatenate([force, moment])
    cost = np.zeros(n + 1)
    cost[-1] = -1.0
    scaled = np.array(rows) / np.array(rows)[:, -1:]
    limits = np.array(bound) / np.array(rows)[:, -1]
    scaled[:, :-1] *= weight  # unknown forces per weight: solvers' tolerances are absolute
    equations = np.column_stack([balance, np.zeros(6)])
    equations[3:] /= size
    goal = wanted / weight
    goal[3:] /= size
    found = linprog(cost, scaled, limits, equations, goal, (None, None), method="highs")
    return float(found.x[-1]) if found.status == 0 else -math.inf
