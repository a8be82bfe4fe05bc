"""What a climb meets that nobody told its controller: ranges by name, and what a seed draws from them."""

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import numpy.typing as npt

from ....sim.limb_flaws import LimbFlaws
from ....trials.noise import NoiseError, NoiseKind, NoiseWidths, stream_of
from ....types import Floats, Ints, Json
from ....units import DEGREE, GRAVITY
from ..planning.task import LimbedTask
from ..robot.robot import Limb, LimbedRobot
from ..sim.climber_model import HookShape

WAVES: Final = 3
"""Waves that a warp is made of, along each axis."""
LENGTHS: Final = (4.0, 8.0)
"""Of these waves, over the robot's longest reach (chosen): neighbouring holds move alike, those of another stance differently."""
ABSENT: Final = (0.0, -100.0)
"""Where a hold that is missing is put, from where it would be [m]."""


def centre_of(task: LimbedTask) -> Floats:
    """Where the robot starts: there the map is right, and displacements count from there; shape (2,) [m]."""
    return np.array((task.start.x, task.start.y))


def warp(task: LimbedTask, rng: np.random.Generator) -> Floats:
    """A smooth displacement of every hold, none at the start, within -1 to 1 along each axis; shape (n_holds, 2) [-]."""
    places = np.vstack((task.world.positions(), centre_of(task)))
    shortest, longest = (part * task.robot.longest_reach for part in LENGTHS)
    out = np.zeros(places.shape)
    for axis in range(2):
        shares = rng.dirichlet(np.ones(WAVES))
        turns, phases = rng.uniform(0.0, math.tau, (2, WAVES))
        waves = math.tau / rng.uniform(shortest, longest, WAVES)
        along = places @ np.array((np.cos(turns), np.sin(turns)))
        out[:, axis] = 0.5 * (shares * np.sin(along * waves + phases)).sum(axis=1)
    return np.asarray(out[:-1] - out[-1])


def turned(task: LimbedTask, angle: float) -> Floats:
    """Displacement of every hold of a board that is turned about the start by an angle [rad], shape (n_holds, 2) [m]."""
    arms = task.world.positions() - centre_of(task)
    c, s = math.cos(angle), math.sin(angle)
    return np.asarray(arms @ np.array(((c, s), (-s, c))) - arms)


def may_be_missing(task: LimbedTask) -> npt.NDArray[np.bool_]:
    """Holds other than those that the robot starts on or a goal names, shape (n_holds,)."""
    kept = {*task.start.holds.values(), *(number for goal in task.goals for number in goal.holds.values())}
    return np.array([hold.number not in kept for hold in task.world.holds])


def terrain_covariance(task: LimbedTask, warped: float, tilt: float) -> Floats | None:
    """What a controller knows of a terrain: common uncertainty of the holds' places, x and y in turn, shape (2 n, 2 n) [m^2].

    A warp counts as a Gaussian process of that size and smoothness that is nothing at the start, a turn as one angle for all.

    Args:
        task: With the board as mapped.
        warped: Largest displacement, either way along each axis [m].
        tilt: Largest angle, either way [rad].

    Returns:
        None where the board is as mapped.
    """
    if warped == 0.0 and tilt == 0.0:
        return None
    places, centre = task.world.positions(), centre_of(task)
    # of waves of these lengths in any direction: the mean of (k . d)^2 is (2 pi d)^2 / (2 L_0 L_1)
    smooth = math.sqrt(2.0 * LENGTHS[0] * LENGTHS[1]) * task.robot.longest_reach / math.tau

    def alike(a: Floats, b: Floats) -> Floats:
        squares = ((a[:, None] - b[None]) ** 2).sum(axis=2)
        return np.asarray(np.exp(-squares / (2.0 * smooth**2)))

    to_start = alike(places, centre[None])
    common = warped**2 / 6.0 * (alike(places, places) - to_start @ to_start.T)
    arms = places - centre
    swept = np.stack((-arms[:, 1], arms[:, 0]), axis=1).ravel()
    return np.asarray(np.kron(common, np.eye(2)) + tilt**2 / 3.0 * np.outer(swept, swept))


NOISE: Final[dict[str, NoiseKind]] = {
    "peg_error": NoiseKind(dimension="length", width=0.00635, words="place of each peg, along each axis", many=True),
    "backlash": NoiseKind(dimension="angle", width=0.5 * DEGREE, words="true play of all joints, about the file's"),
    "assumed_backlash": NoiseKind(
        dimension="angle", width=0.5 * DEGREE, words="play that is reckoned with, about the file's"
    ),
    "friction": NoiseKind(dimension="ratio", width=0.3, words="Coulomb friction of all joints alike", below_one=True),
    "joint_friction": NoiseKind(
        dimension="ratio", width=0.0, words="the same of each joint by itself", below_one=True, many=True
    ),
    "payload": NoiseKind(dimension="ratio", width=0.1, words="mass on the body, of the whole weight", below_one=True),
    "hook_play": NoiseKind(dimension="length", width=0.0005, words="width of the hooks' slots, about 1 mm of play"),
    "hook_friction": NoiseKind(dimension="ratio", width=0.25, words="friction of hooks on pegs", below_one=True),
    "body_angle": NoiseKind(dimension="angle", width=1.0 * DEGREE, words="zero of the body's encoder"),
    "joint_angle": NoiseKind(dimension="angle", width=0.3 * DEGREE, words="zero of each joint's encoder", many=True),
    "terrain": NoiseKind(
        dimension="length", width=0.0, words="warp of the board: neighbouring pegs alike, none at the start", many=True
    ),
    "tilt": NoiseKind(dimension="angle", width=0.0, words="turn of the whole board about the start"),
    "missing": NoiseKind(
        dimension="ratio", width=0.0, words="part of the pegs that are not there", below_one=True, many=True
    ),
}
"""Key -> what deviates, evenly spread over its width to either side. Zeros of encoders: half a turn of a motor at a joint, and what an
inclinometer is off; hook friction: the 0.15 to 0.25 that are plausible. The rest as issue and thesis state it."""


class Noise(NoiseWidths):
    """A width for every key, either way, in SI."""

    __slots__ = ()
    kinds = NOISE

    def words(self) -> str:
        """What deviates, in one line."""
        told = [f"{key} {kind.shown(self.widths[key])}" for key, kind in NOISE.items() if self.widths[key] > 0.0]
        return ", ".join(told) or "none"


NO_NOISE: Final = Noise.of("none")


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """What a seed made of a noise: deviations from what is believed, in SI; ratios are shares of the nominal value."""

    pegs: Floats
    """Shape (n_holds, 2) [m]."""
    backlash: float
    assumed_backlash: float
    friction: float
    joint_friction: Floats
    """Shape (limbs, 2) [-]."""
    payload: float
    hook_play: float
    hook_friction: float
    body_angle: float
    joint_angle: Floats
    """Shape (limbs, 2) [rad]."""
    terrain: Floats
    """Shape (n_holds, 2) [m]."""
    tilt: float
    missing: npt.NDArray[np.bool_]
    """Shape (n_holds,)."""

    def to_json(self, pegs: Ints | None = None) -> Json:
        """One number for each key: the deviation, and of many alike the largest: of pegs the distance, of joints the size.

        Args:
            pegs: Indices of those that count; None: all.
        """
        told = {key: getattr(self, key) for key in NOISE if key not in ("peg_error", "terrain", "missing")}
        told["terrain"] = float(np.hypot(self.terrain[:, 0], self.terrain[:, 1]).max(initial=0.0))
        told["missing"] = int(self.missing.sum())
        told["joint_friction"] = float(np.abs(self.joint_friction).max())
        told["joint_angle"] = float(np.abs(self.joint_angle).max())
        off = np.hypot(self.pegs[:, 0], self.pegs[:, 1])
        return {"peg_error": float((off if pegs is None else off[pegs]).max(initial=0.0))} | told


def draw(noise: Noise, robot: LimbedRobot, n_holds: int, seed: int) -> Drawn:
    """What a seed makes of a noise.

    Each key draws from a stream of its own, and its draw is a share of its width: whatever becomes of other keys, it stays.

    Args:
        noise: Widths.
        robot: As believed.
        n_holds: Of the board; those that the robot is put on at the start are as far off as any. Their terrain is even here.
        seed: Of all draws.
    """
    n = len(robot.limbs)
    return Drawn(
        terrain=np.zeros((n_holds, 2)),
        missing=np.zeros(n_holds, np.bool_),
        pegs=noise.share("peg_error", seed, n_holds, 2),
        joint_friction=noise.share("joint_friction", seed, n, 2),
        joint_angle=noise.share("joint_angle", seed, n, 2),
        **{key: float(noise.share(key, seed)) for key, kind in NOISE.items() if not kind.many},
    )


def draw_for(task: LimbedTask, noise: Noise, seed: int) -> Drawn:
    """What a seed makes of a noise for a task (`draw`), of its terrain, too: that needs to know where its holds are."""
    drawn = draw(noise, task.robot, len(task.world.holds), seed)
    bent, gone = (stream_of(key, seed) for key in ("terrain", "missing"))
    lacking = may_be_missing(task) & (gone.uniform(size=len(task.world.holds)) < noise.widths["missing"])
    return replace(drawn, terrain=noise.widths["terrain"] * warp(task, bent), missing=lacking)


def true_places(task: LimbedTask, drawn: Drawn) -> Floats:
    """Where the holds truly are, shape (n_holds, 2) [m]; those that are missing are far away."""
    places: Floats = task.world.positions() + drawn.pegs + drawn.terrain + turned(task, drawn.tilt)
    places[drawn.missing] += ABSENT
    return places


def check_noise(noise: Noise, robot: LimbedRobot, flaws: LimbFlaws) -> None:
    """Make sure that whatever is drawn can be built.

    Raises:
        NoiseError: If a width is more than what there is of it.
    """
    links = GRAVITY * sum(sum(limb.link_masses) for limb in robot.limbs)
    for key, most in (
        ("backlash", flaws.backlash),
        ("assumed_backlash", robot.motor.backlash),
        ("hook_play", HookShape().side_play),
        ("payload", 1.0 - links / robot.weight),
    ):
        if noise.widths[key] > most:
            there = f"must be at most {NOISE[key].shown(most)}, all that there is"
            raise NoiseError(key, NOISE[key].shown(noise.widths[key]), there)


def drawn_robot(robot: LimbedRobot, drawn: Drawn) -> LimbedRobot:
    """The robot as it truly is: its load spread over the body, the friction of its joints and hooks."""
    limbs = tuple(_drawn_limb(limb, drawn, i) for i, limb in enumerate(robot.limbs))
    return replace(robot, weight=robot.weight * (1.0 + drawn.payload), limbs=limbs)


def _drawn_limb(limb: Limb, drawn: Drawn, i: int) -> Limb:
    shoulder, elbow = (
        replace(joint, friction=joint.friction * (1.0 + drawn.friction) * (1.0 + float(drawn.joint_friction[i, j])))
        for j, joint in enumerate((limb.shoulder, limb.elbow))
    )
    end = limb.end
    if end.friction is not None:
        end = replace(end, friction=end.friction * (1.0 + drawn.hook_friction))
    return replace(limb, shoulder=shoulder, elbow=elbow, end=end)


def drawn_flaws(flaws: LimbFlaws, drawn: Drawn) -> LimbFlaws:
    """The flaws with the true backlash."""
    return flaws.with_changes(backlash=max(0.0, flaws.backlash + drawn.backlash))


def drawn_hook(drawn: Drawn) -> HookShape:
    """The hooks' slots as they truly are."""
    return HookShape(side_play=max(0.0, HookShape().side_play + drawn.hook_play))


def encoder_offsets(drawn: Drawn) -> Floats:
    """What every encoder tells too much: the body's first, then each limb's joints, shape (1 + 2 limbs,) [rad]."""
    return np.concatenate([[drawn.body_angle], drawn.joint_angle.ravel()])


def assumed_backlash(robot: LimbedRobot, drawn: Drawn) -> float:
    """The play that the controller reckons with [rad]."""
    return max(0.0, robot.motor.backlash + drawn.assumed_backlash)
