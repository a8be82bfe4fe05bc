"""A body on its stand: one law, one scenario, what happened tick by tick and what it comes to; many pushes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Annotated, Final

import numpy as np

from ....json_form import INLINE, Jsonable, Key, OrNull
from ....sim.limb_flaws import LimbFlaws
from ....types import Floats
from ..control.body_estimate import ENCODER, LINE, SECOND_TIP
from ..execution.body_gains import BodyGains
from ..execution.whole_body import WholeBody
from .body_stand import BodyScenario, BodyStand, push

SLOT: Final = 0.008
"""A peg farther than this from a hook's seat has left the straight walls of its slot: the hook is off [m]."""

ANGLES: Final = {"encoder": ENCODER, "line": LINE, "second-tip": SECOND_TIP}
"""Name -> source of the body's angle: its own encoder, the line between the tips, the height of the second tip (printed, 4.4.3)."""


@dataclass(frozen=True, slots=True)
class BodyEntry:
    """A way to control the body, under a label."""

    label: str
    gains: BodyGains
    angle: str = "encoder"
    """Source of the body's angle, a name of `ANGLES`."""
    first_limb: bool = False
    """Whether the first holding limb alone tells where the body is, as in the thesis (4.4.3); else all that hold do, unless the angle
    is that of the "second-tip"."""


@dataclass(frozen=True, slots=True, eq=False)
class BodyTrace:
    """What happened, row by row at the scenario's ticks; a run that leaves the finite numbers ends in NaN."""

    time: Floats
    """0 where the measured part begins, shape (ticks,) [s]."""
    aim: Floats
    """Shape (ticks, 3) [m], [rad]."""
    pose: Floats
    """True, shape (ticks, 3)."""
    believed: Floats
    """By encoders and holds, shape (ticks, 3)."""
    push: Floats
    """On the body, shape (ticks, 2) [N]."""
    torques: Floats
    """Of the motors, shape (ticks, limbs, 2) [N m]."""
    tips: Floats
    """True, shape (ticks, limbs, 2) [m]."""
    off: Floats
    """How far each holding limb's tip is from its peg, shape (ticks, holding) [m]."""

    @property
    def unhooked_at(self) -> float | None:
        """When the first hook came off [s]; None: never."""
        lost = (self.off > SLOT).any(axis=1) | ~np.isfinite(self.pose).all(axis=1)
        return float(self.time[np.argmax(lost)]) if lost.any() else None


@dataclass(frozen=True, slots=True, eq=False)
class BodyRun:
    """What one entry did."""

    entry: BodyEntry
    trace: BodyTrace


def run_body(
    stand: BodyStand,
    scenario: BodyScenario,
    entry: BodyEntry,
    flaws: LimbFlaws,
    *,
    pegs: Floats | None = None,
    map_errors: Floats | None = None,
) -> BodyRun:
    """Run one entry.

    Args:
        stand: Where the robot is held.
        scenario: What is asked of it.
        entry: Its control.
        flaws: Of the plant.
        pegs: Where the holds truly are, shape (n_holds, 2) [m]; None: as believed.
        map_errors: How far from there the control believes each limb's hold, the robot put on it where it is, shape (limbs, 2) [m].
    """
    climber, plant = stand.put(flaws, entry.gains, pegs=pegs)
    body = climber.body
    if map_errors is not None:
        for task, error in zip(body.tasks, map_errors, strict=True):
            task.place += error
    holding = [i for i, limb in enumerate(stand.robot.limbs) if limb.name in stand.holds]
    numbers = [hold.number for hold in stand.board.holds]
    places = stand.board.positions() if pegs is None else pegs
    seats = np.array([places[numbers.index(stand.holds[stand.robot.limbs[i].name])] for i in holding])
    ticks, n = len(scenario.aims), body.n
    pose, believed = np.full((ticks, 3), np.nan), np.full((ticks, 3), np.nan)
    torques, tips = np.full((ticks, n, 2), np.nan), np.full((ticks, n, 2), np.nan)
    for k in range(ticks):
        sensed = plant.sense()
        if not np.isfinite(sensed.q).all():
            break
        body.see(sensed.q, sensed.qd, sensed.angle, sensed.angle_speed, angle_from=ANGLES[entry.angle])
        if entry.first_limb:
            count_from(body, holding[0])
        body.aim[:], body.aim_speed[:] = scenario.aims[k], scenario.speeds[k]
        body.command()
        climber.drive()
        plant.push((float(scenario.pushes[k, 0]), float(scenario.pushes[k, 1])))
        plant.step()
        truth = plant.truth()
        pose[k], believed[k], torques[k], tips[k] = truth.pose, body.pose, truth.torques, truth.tips
    off = np.linalg.norm(tips[:, holding] - seats, axis=2)
    return BodyRun(entry, BodyTrace(scenario.time, scenario.aims, pose, believed, scenario.pushes, torques, tips, off))


def count_from(body: WholeBody, i: int) -> None:
    """Let the body be where one limb has it: its hold less its tip."""
    hold = body.tasks[i].place
    arm = hold - body.felt_tip(i)
    speed = body.tip_speed(i)  # that of a tip on its hold is none
    body.pose[:2] += arm
    body.twist[:2] -= speed


def run_bodies(
    stand: BodyStand, scenario: BodyScenario, entries: Sequence[BodyEntry], flaws: LimbFlaws
) -> list[BodyRun]:
    """Every entry alone, from the same start."""
    return [run_body(stand, scenario, entry, flaws) for entry in entries]


ALPHA: Final = "Least acceleration of a hook along its grab direction, for the limits that know one [m/s^2]."


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyMeasures(Jsonable):
    """Of the measured part, by the truth."""

    radial_rms: float | None
    """Of a circle: how far from it [m]; None for others."""
    behind_rms: OrNull
    """Distance from the aim [m]."""
    x_max: OrNull
    """Largest way along x from the aim, less that at the beginning [m]."""
    y_max: OrNull
    """[m]."""
    turn_max: OrNull
    """[rad]."""
    rest: OrNull
    """Distance from the aim at the end [m]."""
    off_max: OrNull
    """Largest distance of a holding tip from its peg [m]."""
    unhooked_at: float | None
    """When a hook came off [s]; None: never."""


@dataclass(frozen=True, slots=True)
class BodyControl:
    """One control of the body."""

    run: Annotated[
        BodyRun,
        Key("control", get=attrgetter("entry.label"), kind=str),
        Key(
            "kp", get=attrgetter("entry.gains.kp"), kind=list[float], meaning="Along x, y [N/m] and turning [N m/rad]."
        ),
        Key("kd", get=attrgetter("entry.gains.kd"), kind=list[float]),
        Key("limit", get=attrgetter("entry.gains.limit"), kind=str, meaning="Of the hooks' pulls."),
        Key("alpha", get=attrgetter("entry.gains.alpha"), kind=float, meaning=ALPHA),
    ]
    measures: Annotated[BodyMeasures, INLINE]


@dataclass(frozen=True, slots=True)
class BodyContest:
    """Controls compared on a body that limbs hold; exit code 1 where a hook came off."""

    kind: str
    controls: tuple[BodyControl, ...]

    @classmethod
    def of(cls, kind: str, runs: Sequence[BodyRun], measured: Sequence[BodyMeasures]) -> "BodyContest":
        """Runs of a kind of scenario, with what was measured of each."""
        return cls(kind, tuple(map(BodyControl, runs, measured)))


def measure_body(run: BodyRun, scenario: BodyScenario) -> BodyMeasures:
    """The measures of one run."""
    trace, begin = run.trace, scenario.begin
    error = trace.pose[begin:] - trace.aim[begin:]
    # a body pushed or lifted counts from where it stood; one on a circle has left its start long since
    moved = error - (0.0 if scenario.kind == "circle" else error[0])
    largest = np.abs(moved).max(axis=0)
    radial = None
    if scenario.centre is not None:
        radii = np.linalg.norm(trace.pose[begin:, :2] - scenario.centre, axis=1) - scenario.radius
        radial = float(np.sqrt(np.mean(radii**2)))
    return BodyMeasures(
        radial_rms=radial,
        behind_rms=float(np.sqrt(np.mean(np.sum(error[:, :2] ** 2, axis=1)))),
        x_max=float(largest[0]),
        y_max=float(largest[1]),
        turn_max=float(largest[2]),
        rest=float(np.linalg.norm(error[-1, :2])),
        off_max=float(trace.off.max()),
        unhooked_at=trace.unhooked_at,
    )


FRICTION = 0.3
"""Joint friction differs by up to this part [-]."""
WEIGHT = 0.1
"""Likewise the weight, which the controller does not know of [-]."""
HEIGHT = 0.005
"""The body stands higher or lower by up to this [m]."""
STRENGTH = 0.1
"""The push is stronger or weaker by up to this part [-]."""


@dataclass(frozen=True, slots=True)
class PushTrial(Jsonable):
    """One push."""

    seed: int
    side: int
    """1 towards +x, -1 towards -x."""
    measures: Annotated[BodyMeasures, INLINE]


def push_trials(
    stand: BodyStand,
    entry: BodyEntry,
    flaws: LimbFlaws,
    *,
    force: tuple[float, float],
    seconds: float,
    trials: int,
    seed: int = 0,
    progress: Callable[[int, int], None] | None = None,
) -> list[PushTrial]:
    """Push the body sideways, half a sine, seeds from `seed` on; even seeds push towards +x.

    Args:
        stand: Where the robot is held.
        entry: Its control.
        flaws: Of the plant before each trial's own friction.
        force: Largest; its x goes either way [N].
        seconds: How long it acts.
        trials: How many.
        seed: The first.
        progress: Told after each trial how many have ended, and how many there are.
    """
    out = []
    for k in range(seed, seed + trials):
        draw = np.random.default_rng(k)
        friction, weight, strength = (1.0 + draw.uniform(-part, part) for part in (FRICTION, WEIGHT, STRENGTH))
        side = 1 if k % 2 == 0 else -1
        pose = stand.pose + np.array((0.0, draw.uniform(-HEIGHT, HEIGHT), 0.0))
        scenario = push(pose, flaws.period, force=(side * strength * force[0], strength * force[1]), seconds=seconds)
        run = run_body(
            replace(stand, pose=pose, weight=weight),
            scenario,
            entry,
            flaws.with_changes(friction=flaws.friction * friction),
        )
        out.append(PushTrial(k, side, measure_body(run, scenario)))
        if progress is not None:
            progress(k - seed + 1, trials)
    return out
