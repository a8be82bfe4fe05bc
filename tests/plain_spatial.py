"""Statics of a limbed robot in space a second time: matrices, potential energy and HiGHS; slow, obvious, nothing shared."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog

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
    frames: Floats
    """Rows normal, tangent, tangent of each contact, world frame, shape (limbs, 3, 3)."""
    bears: list[bool]
    strength: Floats
    friction: Floats


@dataclass(frozen=True)
class PlainForces:
    """Largest s, and the rows that it was found with."""

    s: float
    matrix: Floats
    bound: Floats
    balance: Floats
    wanted: Floats


def solve_forces(chains: Chains, contacts: list[Contact], stance: PlainStance) -> PlainForces:
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
            for c in range(wide[limb]):
                unit = np.eye(3)[c % 3]
                column = np.concatenate([unit, np.cross(arm, unit)] if c < 3 else [np.zeros(3), unit])
                balance[:, starts[limb] + c] = column
            matrix, limit = contacts[limb].polytope(float(stance.friction[limb]), float(stance.strength[limb]))
            for row, (coefficients, most) in enumerate(zip(matrix, limit, strict=True)):
                slack = contacts[limb].rows[row].slack
                line = np.zeros(n + 1)
                world = np.concatenate([coefficients[:3] @ stance.frames[limb], coefficients[3:] @ stance.frames[limb]])
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
    s = float(found.x[-1]) if found.status == 0 else -np.inf
    return PlainForces(s, scaled, limits, equations, goal)
