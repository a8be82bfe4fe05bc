r"""The linear limit of a sampled law: how far its gains may grow before the loop of law, hold, delay and differences is unstable.

The limb at rest is H qdd + D qd + G q = tau, without Coulomb friction and without play, held constant between ticks and so exactly
discrete by one matrix exponential. The law is linearised numerically, memory included: central differences of the controller's own
torques. The loop is stable where the spectral radius of its tick-to-tick matrix is below 1. What the loop never moves (an integral that
nothing feeds, a flag) is left out, for it would stand there as an eigenvalue of 1.
"""

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

import numpy as np
from scipy.linalg import expm

from ..control.chain import Chain
from ..control.controller import Controller, still_aim
from ..control.law_settings import LawSettings, PerAxis
from ..errors import ClamberError
from ..sim.limb_flaws import LimbFlaws
from ..types import Floats

NUDGE: Final = 1e-6
"""Of an angle [rad], a speed [rad/s] or a number in memory."""
SETTLING: Final = 4
"""Ticks at rest on the aim before the law is linearised: what it sets up at its first tick is then done."""
COUPLED: Final = 1e-9
"""A state counts as moved by another where its derivative is larger."""
GROWTH: Final = 2.0
LEAST: Final = 2.0**-40
MOST: Final = 2.0**40


class LimitError(ClamberError):
    """A loop without a limit to find: names the law and what it does instead."""

    def __init__(self, law: str, problem: str) -> None:
        super().__init__(law, problem)
        self.law, self.problem = law, problem

    def __str__(self) -> str:
        return f"{self.law}: {self.problem}"


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


def linear_limit(
    chain: Chain, settings: LawSettings, flaws: LimbFlaws, poses: Iterable[Floats], *, precision: float = 1e-3
) -> float:
    """Factor on the gains of `settings` at which the first of the poses turns unstable, kd/kp kept.

    Args:
        chain: The limb.
        settings: A law; its gains set their ratios.
        flaws: Rate, delay, encoders, viscous friction, payload and weight count.
        poses: Joint angles, each of shape (n,) [rad].
        precision: Of the factor, relative.

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
    while high > low * (1.0 + precision):
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
