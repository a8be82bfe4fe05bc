r"""Two limits of a law's gains: where its sampled linear loop turns unstable, and where the limb no longer comes to rest.

The limb at rest is H qdd + D qd + G q = tau, without Coulomb friction and without play, held constant between ticks and so exactly
discrete by one matrix exponential. The law is linearised numerically, memory included: central differences of the controller's own
torques. The loop is stable where the spectral radius of its tick-to-tick matrix is below 1. What the loop never moves (an integral that
nothing feeds, a flag) is left out, for it would stand there as an eigenvalue of 1.

Whether a law comes to rest is tried: the limb is stepped, led round circles, pushed and let go, and must then stand still. What counts is
the true tip, play included, from `QUIET_FROM` on: peak to peak. A law that limit-cycles, hunts or diverges fails at one threshold. The
wait is the link's, not the law's: where no weight presses it to one end of its play it coasts through the play behind resting motors, and
slows down in 2.2 s (its inertia of 0.011 kg m^2 over `sim.limb_model.PLAY_DAMPING`). Seven seconds after the last command what is left of
2 deg of play at 0.27 m is at most 0.4 mm, whatever the law; a loop that cycles is still at it.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal, TypeAlias

import numpy as np
from scipy.linalg import expm

from ..control.chain import Chain
from ..control.controller import Controller, still_aim
from ..control.law_settings import LawSettings, PerAxis
from ..errors import StatedError
from ..execution.closed_loop import close_loop
from ..execution.trace import LimbTrace
from ..sim.bench_limb import BenchLimb
from ..sim.limb_flaws import LimbFlaws, Push
from ..sim.mujoco_limb import MujocoLimb
from ..types import Floats, Records
from .scenario import Scenario, circle_scenario, step_scenario

NUDGE: Final = 1e-6
"""Of an angle [rad], a speed [rad/s] or a number in memory."""
SETTLING: Final = 4
"""Ticks at rest on the aim before the law is linearised: what it sets up at its first tick is then done."""
COUPLED: Final = 1e-9
"""A state counts as moved by another where its derivative is larger."""
GROWTH: Final = 2.0
LEAST: Final = 2.0**-40
MOST: Final = 2.0**40


class LimitError(StatedError):
    """A loop without a limit to find: names the law and what it does instead."""

    says = "{law}: {problem}"
    law: str
    problem: str


def scaled_gains(settings: LawSettings, factor: float) -> LawSettings:
    """A law with all gains of its motion multiplied: kp and kd, and the joint servo's where they are stated."""

    def times(value: PerAxis) -> PerAxis:
        return tuple(factor * part for part in value) if isinstance(value, tuple) else factor * value

    servo = {key: factor * value for key in ("joint_kp", "joint_kd") if (value := getattr(settings, key)) is not None}
    return replace(settings, kp=times(settings.kp), kd=times(settings.kd), **servo)


def loop_matrix(chain: Chain, settings: LawSettings, flaws: LimbFlaws, q: Floats) -> Floats:
    """The closed loop from one tick to the next, at rest on its aim at `q`, without Coulomb friction and play.

    Its state is joint angles and speeds, the last reading if speeds are differences, readings on their way, the law's memory.
    """
    n, period = chain.n, flaws.period
    forward, push = _held_plant(chain, flaws, q)
    pulls, updates = _linear_law(chain, settings, period, q)
    differences = flaws.encoder_counts > 0
    memory = updates.shape[0]
    before, ring = 2 * n, 3 * n
    kept = ring + 2 * n * flaws.delay
    size = kept + memory
    reading = np.zeros((2 * n, size))  # of the sensors, this tick
    reading[:n, :n] = np.eye(n)
    if differences:
        reading[n:, :n], reading[n:, before:ring] = np.eye(n) / period, -np.eye(n) / period
    else:
        reading[n:, n : 2 * n] = np.eye(n)
    used = reading
    if flaws.delay:
        used = np.zeros((2 * n, size))
        used[:, kept - 2 * n : kept] = np.eye(2 * n)
    seen = np.vstack((used, np.zeros((memory, size))))  # what the law reads: a reading, its memory
    seen[2 * n :, kept:] = np.eye(memory)
    out = np.zeros((size, size))
    out[: 2 * n, : 2 * n] = forward
    out[: 2 * n] += push @ (pulls @ seen)
    out[before:ring, :n] = np.eye(n)
    for k in range(flaws.delay):
        rows = slice(ring + 2 * n * k, ring + 2 * n * (k + 1))
        if k == 0:
            out[rows] = reading
        else:
            out[rows, rows.start - 2 * n : rows.start] = np.eye(2 * n)
    out[kept:] = updates @ seen
    return out


def spectral_radius(chain: Chain, settings: LawSettings, flaws: LimbFlaws, q: Floats) -> float:
    """Largest size of an eigenvalue of the loop at `q`, among what motion of the joints can reach; below 1 is stable."""
    matrix = loop_matrix(chain, settings, flaws, q)
    moved = np.zeros(matrix.shape[0], dtype=bool)
    moved[: 2 * chain.n] = True
    while True:
        reached = moved | (np.abs(matrix[:, moved]) > COUPLED).any(axis=1)
        if (reached == moved).all():
            break
        moved = reached
    return float(np.abs(np.linalg.eigvals(matrix[np.ix_(moved, moved)])).max())


def linear_limit(chain: Chain, settings: LawSettings, flaws: LimbFlaws, poses: Iterable[Floats]) -> float:
    """Factor on the gains of `settings` at which the first of the poses turns unstable, kd/kp kept.

    Args:
        chain: The limb.
        settings: A law; its gains set their ratios.
        flaws: Rate, delay, encoders, viscous friction, payload and weight count.
        poses: Joint angles, each of shape (n,) [rad].

    Raises:
        LimitError: If the loop is unstable however small its gains are, or stable however large.
    """
    places = list(poses)

    def stable(factor: float) -> bool:
        law = scaled_gains(settings, factor)
        return all(spectral_radius(chain, law, flaws, q) < 1.0 for q in places)

    low = 1.0
    while not stable(low):
        low /= GROWTH
        if low < LEAST:
            raise LimitError(settings.law, "is unstable at rest however small its gains are")
    high = low * GROWTH
    while stable(high):
        low, high = high, high * GROWTH
        if high > MOST:
            raise LimitError(settings.law, "is stable however large its gains are")
    while high > low * (1.0 + 1e-3):
        middle = float(np.sqrt(low * high))
        low, high = (middle, high) if stable(middle) else (low, middle)
    return low


def _held_plant(chain: Chain, flaws: LimbFlaws, q: Floats) -> tuple[Floats, Floats]:
    """Angles and speeds a period later, from those now and from a torque that is held."""
    n = chain.n
    carried = chain.with_payload(flaws.payload)
    inverse = np.linalg.inv(carried.inertia(q))
    weight = np.empty((n, n))
    for j, nudge in enumerate(NUDGE * np.eye(n)):
        rest = np.zeros(n)
        weight[:, j] = (carried.bias(q + nudge, rest) - carried.bias(q - nudge, rest)) / (2 * NUDGE)
    rates = np.zeros((3 * n, 3 * n))
    rates[:n, n : 2 * n] = np.eye(n)
    rates[n : 2 * n, :n] = -inverse @ weight
    rates[n : 2 * n, n : 2 * n] = -inverse * (chain.joints["damping"] * flaws.damping)
    rates[n : 2 * n, 2 * n :] = inverse
    step: Floats = expm(rates * flaws.period)
    return step[: 2 * n, : 2 * n], step[: 2 * n, 2 * n :]


def _linear_law(chain: Chain, settings: LawSettings, period: float, q: Floats) -> tuple[Floats, Floats]:
    """Derivatives of torques and of the memory after a tick, by reading and memory, shapes (n, 2n + m) and (m, 2n + m)."""
    n = chain.n
    controller = Controller(chain, settings, period=period)
    aim, states = still_aim(chain.place(q)), np.zeros((1, 2, n))
    states[0, 0] = q
    for _ in range(SETTLING):
        controller.command(aim, states)
    settled = controller.memory.copy()
    columns = 2 * n + settled.shape[1]

    def answer(nudge: Floats) -> Floats:
        states[0] = (q, np.zeros(n))
        states[0] += nudge[: 2 * n].reshape(2, n)
        controller.memory[0] = settled[0] + nudge[2 * n :]
        torques = controller.command(aim, states)[0]
        return np.concatenate((torques, controller.memory[0]))

    out = np.empty((n + settled.shape[1], columns))
    for j, nudge in enumerate(NUDGE * np.eye(columns)):
        out[:, j] = (answer(nudge) - answer(-nudge)) / (2 * NUDGE)
    return out[:n], out[n:]


QUIET_FROM: Final = 10.0
"""Seven seconds after the last command or push has ended [s]."""
SECONDS: Final = 12.0
"""Of a run [s]."""
STEADY: Final = 0.0005
"""Largest peak-to-peak motion of the tip that counts as rest [m]."""
RESTING: Final = 0.00005
"""Motors that move the tip by less than this are at rest [m]: a few encoder counts."""
STEP: Final = 0.02
"""Of the aim [m]."""
CIRCLE: Final = 0.05
"""Radius of the circles [m]."""
LAPS: Final = (3.0, 6.0)
"""Periods of the circles [s]; each is left after `CIRCLE_SECONDS`."""
CIRCLE_SECONDS: Final = 3.0
PUSH: Final = 10.0
"""Force on the tip, from 0.5 to 2 s [N]."""
REACHES: Final = (0.62, 0.7, 0.9)
"""Distances of the poses from the port, over the limb's length: folded, middling, stretched."""
Effort: TypeAlias = Literal["search", "full", "fine"]


@dataclass(frozen=True, slots=True, eq=False)
class Situation:
    """A start, a command that ends before `QUIET_FROM`, and perhaps a push."""

    name: str
    q0: Floats
    """Joint angles [rad]."""
    aims: Records
    """Shape (ticks, 1)."""
    push: Push | None = None


def poses(limb: BenchLimb, reaches: Sequence[float] = REACHES, bearing: float = 0.0) -> list[Floats]:
    """Joint angles at some distances from the port, on both branches of the elbow as far as the joints' limits allow [rad]."""
    joints = limb.chain.joints
    out = []
    for reach in reaches:
        distance = reach * limb.reach[1]
        for branch in limb.branches(distance * math.cos(bearing), distance * math.sin(bearing)):
            q = np.array(branch)
            if (joints["lower"] <= q).all() and (q <= joints["upper"]).all():
                out.append(q)
    return out


def situations(limb: BenchLimb, rate: float, effort: Effort) -> list[Situation]:
    """What a law has to come to rest after.

    "search" and "full": steps of 2 cm in four directions and a push at each pose, and two circles on each branch. "fine": other poses
    off the axis, six directions, another push.
    """
    fine = effort == "fine"
    places = poses(limb, (0.65, 0.8, 0.92), 0.35) if fine else poses(limb)
    directions, pushes = (6, (0.8,)) if fine else (4, (0.0,))
    out = []
    for q in places:
        at = replace(limb, q0=q)
        where = "({:.3f}, {:.3f}) m, elbow {:+.0f} deg".format(*at.start, math.degrees(q[1]))
        for k in range(directions):
            turn = math.tau * k / directions
            command = step_scenario(at, rate, dx=STEP * math.cos(turn), dy=STEP * math.sin(turn), seconds=SECONDS)
            out.append(Situation(f"step to {math.degrees(turn):.0f} deg at {where}", q, command.aims))
        for turn in pushes:
            still = np.stack([still_aim(at.start)] * round(SECONDS * rate))
            push = Push(x=PUSH * math.cos(turn), y=PUSH * math.sin(turn), start=0.5, end=2.0)
            out.append(Situation(f"push to {math.degrees(turn):.0f} deg at {where}", q, still, push))
    return out + _circles(limb, rate)


def _circles(limb: BenchLimb, rate: float) -> list[Situation]:
    """Circles about the middle of the reach, from their outermost point, on each branch; the aim stops after `CIRCLE_SECONDS`."""
    length = limb.reach[1]
    centre = (0.7 * length, 0.0)
    out = []
    for q in poses(limb, (0.7 + CIRCLE / length,)):
        at = replace(limb, q0=q)
        for lap in LAPS:
            led = circle_scenario(at, rate, centre=centre, radius=CIRCLE, lap=lap, laps=math.ceil(SECONDS / lap))
            out.append(Situation(f"circle in {lap:g} s, elbow {math.degrees(q[1]):+.0f} deg", q, _stopped(led, rate)))
    return out


def _stopped(led: Scenario, rate: float) -> Records:
    aims = led.aims[: round(SECONDS * rate)].copy()
    last = round(CIRCLE_SECONDS * rate)
    aims[last:] = aims[last]
    for key in ("twist", "acceleration"):
        aims[key][last:] = 0.0
    return aims


def run_situations(
    limb: BenchLimb, settings: LawSettings, flaws: LimbFlaws, chosen: Sequence[Situation]
) -> list[tuple[list[Situation], LimbTrace]]:
    """Run a law through situations, those with the same push in one batch on one thread; a run that diverges ends in NaN."""
    groups: dict[Push | None, list[Situation]] = {}
    for situation in chosen:
        groups.setdefault(situation.push, []).append(situation)
    out = []
    for push, group in groups.items():
        batch = len(group)
        plant = MujocoLimb(limb.chain, flaws.with_changes(push=push), gears=limb.gears, batch=batch, threads=1)
        controller = Controller(limb.chain, settings, period=flaws.period, batch=batch)
        starts = np.stack([situation.q0 for situation in group])
        plant.reset(starts if batch > 1 else starts[0])
        aims = np.concatenate([situation.aims for situation in group], axis=1)
        out.append((group, close_loop(plant, controller, aims, keep=True)))
    return out


def peak_to_peak(trace: LimbTrace, since: float = QUIET_FROM, *, motors: bool = False) -> Floats:
    """Longer side of the box that the tip stays in from `since` on, shape (batch,) [m]; inf where a run diverged.

    The tip is the true one, or the one where the motors' encoders place it.
    """
    late = (trace.sensed if motors else trace.true)[trace.time >= since]
    places = np.array([[trace.chain.place(state[0])[:2] for state in row] for row in late])
    sides: Floats = np.ptp(places, axis=0).max(axis=-1)
    return np.where(np.isfinite(sides), sides, np.inf)


@dataclass(frozen=True, slots=True)
class Unrest:
    """The least steady of many runs."""

    peak_to_peak: float
    """Of the true tip after `QUIET_FROM` [m]; inf where a run diverged."""
    situation: str
    """Where that was."""

    @property
    def steady(self) -> bool:
        """Whether every run came to rest."""
        return self.peak_to_peak <= STEADY


SEED: Final = 0
"""Draws on which side of its play each joint of each run starts."""
FRICTIONS: Final[dict[Effort, tuple[float, ...]]] = {
    "search": (0.7,),
    "full": (0.7, 1.0, 1.3),
    "fine": (0.7, 1.0, 1.3),
}
"""Coulomb friction over the file's: the search takes the least, which calms least; the others prove it."""


def unrest(
    limb: BenchLimb,
    settings: LawSettings,
    flaws: LimbFlaws,
    effort: Effort,
    *,
    stop: bool = True,
    since: float = QUIET_FROM,
) -> Unrest:
    """The least steady run of a law through the situations, at each friction of `effort`.

    Args:
        limb: On the bench.
        settings: The law.
        flaws: The plant; its friction is multiplied.
        effort: Which situations and frictions.
        stop: Whether to end at the first friction at which a run is unsteady.
        since: From when on the tip must be still [s].
    """
    worst = Unrest(0.0, "none")
    chosen = situations(limb, flaws.control_rate, effort)
    for friction in FRICTIONS[effort]:
        worn = flaws.with_changes(friction=friction * flaws.friction, seed=SEED)
        for group, trace in run_situations(limb, settings, worn, chosen):
            sizes = peak_to_peak(trace, since)
            k = int(np.argmax(sizes))
            if sizes[k] > worst.peak_to_peak:
                worst = Unrest(float(sizes[k]), f"{group[k].name}, friction {friction:g}")
        if stop and not worst.steady:
            break
    return worst


def overshoot(limb: BenchLimb, settings: LawSettings, flaws: LimbFlaws) -> float:
    """How far the motors' tip goes beyond the aim, over the step, at most over the steps of the search [-].

    By the encoders, without what play and friction make of the standing error.
    """
    steps = [each for each in situations(limb, flaws.control_rate, "search") if each.name.startswith("step")]
    ((_, trace),) = run_situations(limb, settings, flaws, steps)
    worst = 0.0
    for k, place in enumerate(np.moveaxis(trace.sensed_places(), 1, 0)):
        aim = trace.aims["place"][-1, k, :2]
        asked = aim - place[0, :2]
        beyond = (place[:, :2] - aim) @ asked / (asked @ asked)
        worst = max(worst, float(beyond.max()))
    return worst
