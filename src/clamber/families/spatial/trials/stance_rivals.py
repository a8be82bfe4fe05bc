"""Stances of robots in space that checks are timed on, and what other software says of them.

A quadruped as jet-leg knows it, and robots that come with Clamber; HiGHS of our programme, jet-leg, hpp-centroidal-dynamics, and OMPL
between stances.
"""

import ctypes
import importlib.util
import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any, Final, TypeAlias

import numpy as np

from ....tasks.robots import read_robot
from ....types import Floats, Records
from ..robot.chains import Chains
from ..robot.contacts import Contact, Row, line
from ..robot.kinematics import Posed, link_centres, link_frames
from ..robot.robot import build_robot
from ..statics.judging import REACHED, Statics, rules_record

FRICTION: Final = 0.8
MASS: Final = 85.0
"""Of the quadruped [kg]: jet-leg's default, all of it in the trunk."""
TORQUE: Final = 60.0
"""Of each of its motors [N m]: about half of the stances stand."""
HIP: Final = (0.3735, 0.207)
"""From the centre of the trunk to a hip, ahead and aside [m]: HyQ, as jet-leg has it."""
LENGTHS: Final = (0.08, 0.35, 0.341)
"""From the hip's roll to its pitch, thigh, shank [m]: HyQ, as jet-leg has it."""
SIDES: Final = ((1, 1), (1, -1), (-1, 1), (-1, -1))
"""Ahead and aside of legs in jet-leg's order: LF, RF, LH, RH."""
SPREAD: Final = 0.25
"""Of random postures about the nominal one, in parts of each joint's range."""
Verdict: TypeAlias = Callable[[int], bool]
"""Whether a stance of a batch stands, by its index."""
LEAST_GRAVITY: Final = 0.01 * 9.80665
"""Gravity that forces are counted in at least [m/s^2], as in our programme."""
PROJECTIONS: Final = "pypoman"
"""jet-leg imports it for projections, which the check of one stance does not use; it has to be built where no wheel of its own fits."""
FRAMES: Final = 4
"""Numbers of a path between two stances: forward, aside, up, turn about the base's z."""


@dataclass(frozen=True, slots=True)
class Stances:
    """Stances of one robot, ready to be judged."""

    name: str
    chains: Chains
    kinds: tuple[Contact, ...]
    statics: Statics
    bodies: Records
    contacts: Records

    def __len__(self) -> int:
        return len(self.bodies)


def pyramid(friction: float) -> Contact:
    """A point foot whose friction cone is the pyramid of four sides around it that jet-leg counts with."""
    rows = tuple(
        Row(coefficients=tangent, per_friction=line(n=-1.0))
        for sign in (1.0, -1.0)
        for tangent in (line(f1=sign), line(f2=sign))
    )
    return Contact(kind="foot", rows=rows, friction=friction)


def jet_quadruped() -> Chains:
    """HyQ as jet-leg has it: legs of a roll and two pitches without a mass, knees bent inwards."""
    offset, rotation = np.zeros((4, 4, 3)), np.tile(np.eye(3), (4, 4, 1, 1))
    each = np.ones((4, 3))
    nominal = np.zeros((4, 3))
    for leg, (ahead, aside) in enumerate(SIDES):
        offset[leg, 0] = ahead * HIP[0], aside * HIP[1], 0.0
        rotation[leg, 0] = np.array(((0, 0, -1), (0, -1, 0), (-1, 0, 0)))  # z against the trunk's x, x down
        rotation[leg, 1] = np.array(((1, 0, 0), (0, 0, -1), (0, 1, 0)))  # z to the left of the trunk
        rotation[leg, 3] = np.array(((0, 0, 1), (0, 1, 0), (-1, 0, 0)))  # z along the shank
        nominal[leg] = 0.0, 0.75 * ahead, -1.5 * ahead
        for k, length in enumerate(LENGTHS):
            offset[leg, k + 1, 0] = length
    return Chains(
        name="hyq of jet-leg",
        limb_names=("LF", "RF", "LH", "RH"),
        joint_names=tuple((f"{leg}_HAA", f"{leg}_HFE", f"{leg}_KFE") for leg in ("LF", "RF", "LH", "RH")),
        n_joints=np.full(4, 3, np.int32),
        offset=offset,
        rotation=rotation,
        sliding=np.zeros((4, 3), np.int32),
        lower=np.where(nominal < 0.0, nominal - 0.9, nominal - 0.7),
        upper=np.where(nominal < 0.0, nominal + 0.7, nominal + 0.9),
        torque=TORQUE * each,
        speed=math.inf * each,
        nominal=nominal,
        mass=0.0 * each,
        centre=np.zeros((4, 3, 3)),
        radius=0.0 * each,
        base_mass=MASS,
        base_centre=np.zeros(3),
        base_half=np.array((0.3, 0.1, 0.05)),
    )


def jet_stances(n: int, seed: int = 1) -> Stances:
    """The quadruped level on feet at various places, each fourth stance without one of them."""
    chains, kind = jet_quadruped(), pyramid(FRICTION)
    made = _stances("HyQ", chains, (kind,) * 4, n, seed)
    made.contacts["normal"] = 0.0, 0.0, 1.0
    made.contacts["along"] = 1.0, 0.0, 0.0
    made.contacts["bears"][np.arange(0, n, 4), np.arange(0, n, 4) // 4 % 4] = 0
    return made


def shipped_stances(robot: str, n: int, seed: int = 1) -> Stances:
    """A robot that comes with Clamber on holds about its nominal tips, normals leaning at random."""
    built = build_robot(read_robot(robot))
    return _stances(robot, built.chains, tuple(built.contacts), n, seed)


def _stances(name: str, chains: Chains, kinds: tuple[Contact, ...], n: int, seed: int) -> Stances:
    statics, rng = Statics(chains, kinds), np.random.default_rng(seed)
    noise = rng.uniform(-0.5, 0.5, (n, *chains.nominal.shape)) * SPREAD * (chains.upper - chains.lower)
    postures = np.clip(chains.nominal + noise, chains.lower + 0.02, chains.upper - 0.02)
    places = link_frames(chains, Posed(np.zeros((n, 3)), np.tile(np.eye(3), (n, 1, 1)), postures)).tips
    normals = rng.normal(size=places.shape) * 0.15 + (0.0, 0.0, 1.0)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    aligned = statics.robot["aligned"][0, : places.shape[1]]
    normals[:, aligned == 1] = 0.0, 0.0, 1.0
    contacts: Any = statics.contacts(places, normals)
    return Stances(name, chains, kinds, statics, statics.bodies(n), contacts)


def programme(stances: Stances, i: int, judged: np.void) -> tuple[Floats, ...]:
    """Our linear programme of a stance in numpy, unknown forces per weight: rows, their bounds, equations, their right sides.

    Args:
        stances: The batch.
        i: The stance.
        judged: What came of judging it; its posture alone is used.
    """
    chains, contacts, body = stances.chains, stances.contacts[i], stances.bodies[i]
    base = body["rotation"].reshape(3, 3)
    gravity = base.T @ body["gravity"]
    size = float(stances.statics.robot["size"][0])
    weight = chains.total_mass * max(float(np.linalg.norm(gravity)), LEAST_GRAVITY)
    wide = [kind.components if bears else 0 for kind, bears in zip(stances.kinds, contacts["bears"], strict=True)]
    at = np.concatenate(([0], np.cumsum(wide)))
    balance, rows, bounds = np.zeros((6, at[-1] + 1)), [], []
    load = chains.base_mass * np.concatenate((gravity, np.cross(chains.base_centre, gravity)))
    limbs, most = chains.lower.shape
    frames = link_frames(chains, Posed(np.zeros(3), np.eye(3), judged["posture"][:limbs, :most]))
    all_centres = link_centres(chains, frames)
    for limb, kind in enumerate(stances.kinds):
        n, columns = int(chains.n_joints[limb]), wide[limb]
        places, turns, centres = frames.origins[limb], frames.axes[limb], all_centres[limb, :n]
        tip = base.T @ (contacts["place"][limb] - body["place"])
        weights = chains.mass[limb, :n, None] * gravity
        for centre, pull in zip(centres, weights, strict=True):
            load += np.concatenate((pull, np.cross(centre, pull)))
        here = slice(at[limb], at[limb] + columns)
        if columns:
            normal, along = base.T @ contacts["normal"][limb], base.T @ contacts["along"][limb]
            end = turns[n]
            first = along if along.any() else end[:, 0] if abs(end[:, 0] @ normal) <= 0.9 else end[:, 1]
            first = first - (first @ normal) * normal
            first /= np.linalg.norm(first)
            axes = np.array((normal, first, np.cross(normal, first)))
            skew = np.cross(np.broadcast_to(tip, (3, 3)), np.eye(3)).T
            balance[:, here] = np.block([[np.eye(3), np.zeros((3, 3))], [skew, np.eye(3)]])[:, :columns]
            matrix, limit = kind.polytope(float(contacts["friction"][limb]), float(contacts["strength"][limb]))
            for row, coefficients, most in zip(kind.rows, matrix, limit, strict=True):
                made = np.zeros(at[-1] + 1)
                made[here] = np.concatenate((coefficients[:3] @ axes, coefficients[3:] @ axes))[:columns] * weight
                made[-1] = row.slack[0] * weight + row.slack[1]
                rows.append(made / made[-1])
                bounds.append(most / made[-1])
        for k, place in enumerate(places[:n]):
            axis, most = turns[k, :, 2], chains.torque[limb, k]
            hinge = not chains.sliding[limb, k]
            arms = [np.cross(axis, centre - place) if hinge else axis for centre in centres[k:]]
            pulled = float(sum(arm @ pull for arm, pull in zip(arms, weights[k:], strict=True)))
            made = np.zeros(at[-1] + 1)
            if columns:
                moved = np.concatenate((np.cross(axis, tip - place), axis) if hinge else (axis, np.zeros(3)))
                made[here] = moved[:columns] * weight / most
            for sign in (1.0, -1.0):
                rows.append(np.append(sign * made[:-1], 1.0))
                bounds.append(1.0 - sign * pulled / most)
    scale = np.repeat((1.0, 1.0 / size), 3)
    return np.array(rows), np.array(bounds), balance * scale[:, None], -load * scale / weight


def highs(rows: Floats, bounds: Floats, equations: Floats, sides: Floats) -> float:
    """Largest s of a programme by HiGHS; minus infinity where no forces balance."""
    from scipy.optimize import linprog

    cost = np.zeros(rows.shape[1])
    cost[-1] = -1.0
    found = linprog(cost, rows, bounds, equations, sides, (None, None), method="highs")
    return float(found.x[-1]) if found.status == 0 else -np.inf


def jet_leg(stances: Stances) -> Verdict:
    """jet-leg's check of one stance: inverse kinematics, polytopes of torques, a linear programme of cvxopt."""
    if importlib.util.find_spec(PROJECTIONS) is None or importlib.util.find_spec("cdd") is None:
        sys.modules[PROJECTIONS] = ModuleType(PROJECTIONS)
    import cvxopt
    from jet_leg.dynamics.computational_dynamics import ComputationalDynamics
    from jet_leg.maths.iterative_projection_parameters import IterativeProjectionParameters

    cvxopt.solvers.options["show_progress"] = False
    dynamics, asked = ComputationalDynamics("hyq"), IterativeProjectionParameters()
    asked.setTorqueLims(np.full((4, 3), TORQUE))
    asked.setFrictionCoefficient(FRICTION)
    asked.setTotalMass(MASS)
    asked.setCoMPosWF(np.zeros(3))

    def verdict(i: int) -> bool:
        asked.setContactsPosWF(stances.contacts["place"][i])
        asked.setActiveContacts(stances.contacts["bears"][i])
        return bool(dynamics.check_equilibrium(asked)[0])

    return verdict


def hpp(stances: Stances) -> Verdict:
    """hpp-centroidal-dynamics: whether friction alone can balance the robot, by its linear programme of four generators a contact."""
    spec = importlib.util.find_spec("hpp_centroidal_dynamics")
    assert spec is not None and spec.origin is not None
    prefix = Path(spec.origin).parents[2]
    for library in sorted(prefix.glob("libhpp-centroidal-dynamics.so*")):  # its wheel names no place to find it in
        for needed in ("libCoinUtils", "libClp", "libqpOASES", "libcdd"):
            for part in sorted(prefix.glob(f"{needed}.so*")):
                ctypes.CDLL(str(part), mode=ctypes.RTLD_GLOBAL)
        ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    import hpp_centroidal_dynamics as centroidal

    solver = centroidal.Equilibrium("clamber", MASS, 4)
    algorithm, centre = centroidal.EquilibriumAlgorithm.EQUILIBRIUM_ALGORITHM_LP, np.zeros(3)

    def verdict(i: int) -> bool:
        bears = stances.contacts["bears"][i] == 1
        places, normals = stances.contacts["place"][i][bears], stances.contacts["normal"][i][bears]
        solver.setNewContacts(places, normals, FRICTION, algorithm)
        return bool(solver.computeEquilibriumRobustness(centre)[1] >= 0.0)

    return verdict


def connect(stances: Stances, i: int, goal: Floats, seconds: float) -> tuple[bool, int]:
    """OMPL's RRT-connect of a body from a stance to the same holds a little further on, each state judged by our check of a stance.

    Args:
        stances: The batch.
        i: The stance.
        goal: Where to: forward, aside, up [m], turn [rad], base frame, shape (4,).
        seconds: Most time [s].

    Returns:
        Whether it came there, and how many states it had judged.
    """
    from ompl import base, geometric, util

    util.setLogLevel(util.LogLevel.LOG_NONE)
    contacts, statics = stances.contacts[i : i + 1], stances.statics
    body, rules = stances.bodies[i : i + 1].copy(), rules_record(exact=0, reach=REACHED)
    start: Any = stances.bodies[i]
    asked = 0

    def stands(state: Any) -> bool:
        nonlocal asked
        asked += 1
        c, s = np.cos(state[3]), np.sin(state[3])
        turn = start["rotation"].reshape(3, 3)
        body["place"][0] = start["place"] + turn @ (state[0], state[1], state[2])
        body["rotation"][0] = (turn @ np.array(((c, -s, 0), (s, c, 0), (0, 0, 1)))).ravel()
        return bool(statics.judge(body, contacts, rules)[1][0] < 0)

    space = base.RealVectorStateSpace(FRAMES)
    limits = base.RealVectorBounds(FRAMES)
    for k in range(FRAMES):
        limits.setLow(k, -2.0 * abs(float(goal[k])) - 0.01)
        limits.setHigh(k, 2.0 * abs(float(goal[k])) + 0.01)
    space.setBounds(limits)
    setup = geometric.SimpleSetup(space)
    setup.setStateValidityChecker(stands)
    first, last = space.allocState(), space.allocState()
    for k in range(FRAMES):
        first[k], last[k] = 0.0, float(goal[k])
    setup.setStartAndGoalStates(first, last)
    setup.setPlanner(geometric.RRTConnect(setup.getSpaceInformation()))
    return bool(setup.solve(seconds)), asked
