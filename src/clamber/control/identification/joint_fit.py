r"""Inertia, damping and Coulomb friction of one joint by robust regression of the weak form, with errors from a bootstrap.

The weak form needs no derivative of a measured angle. Equation 3.28 of Bevly 1997, with the signs of its friction put right, is
I qdd + d qd + tau_f sign(qd) + tau_0 = tau(t - L): L is how late the angle is behind the torque, tau_0 what pulls one way. Times a smooth
function phi that is zero outside a short window, and integrated by parts (modulating functions, Shinbrot 1957), it reads

    I int phi'' q - d int phi' q + tau_f int phi sign(qd) + tau_0 int phi = int phi(t + L) tau(t) dt,

one row of a linear regression for each window. Windows in which the joint may stand still are left out: there friction is any
torque up to tau_f. What a limb's links ask of its joints is taken off first: what is left is the joints' own.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.optimize import least_squares
from scipy.signal import fftconvolve

from ...types import Floats
from ..chain import Chain
from ..kinematics import FRAME, accelerate, fill_inertia, place_chain
from ..records import AXES
from .samples import Estimate, JointSamples, Motion


@dataclass(frozen=True, slots=True, eq=False)
class LinkLoad:
    """The torque of the links at one joint: inertia . qdd + bias, at every sample."""

    inertia: Floats
    """The joint's row of the links' inertia matrix, shape (rows, n) [kg m^2]."""
    place: int
    """Which of the n joints it is, from 0."""
    bias: Floats
    """Coriolis, centrifugal and weight, shape (rows,) [N m]."""
    angles: Floats
    """Of all joints, behind the gear where that is measured, for links move with what is behind the play, shape (n, rows) [rad]."""


def link_loads(chain: Chain, angles: Sequence[Floats], speeds: Sequence[Floats]) -> list[LinkLoad]:
    """The load of a chain's links, without motors and friction, on each of its joints.

    Args:
        chain: The limb as its file states it.
        angles: Of each joint, behind the gear where that is measured [rad].
        speeds: Of each joint [rad/s].
    """
    joints = chain.joints.copy()
    for key in ("rotor", "damping", "friction"):
        joints[key] = 0.0
    q, qd = (np.ascontiguousarray(np.stack(list(parts), axis=1)) for parts in (angles, speeds))
    rows, n = q.shape
    frames, tip, drift, still = np.zeros((n, FRAME)), np.zeros(12), np.zeros(AXES), np.zeros(n)
    inertia, bias = np.zeros((rows, n, n)), np.zeros((rows, n))
    for k in range(rows):
        place_chain(joints, chain.root, q[k], frames, tip)
        fill_inertia(joints, frames, inertia[k])
        place_chain(joints, chain.root, q[k], frames, tip)
        accelerate(joints, chain.root, frames, tip, (qd[k], still), True, drift, bias[k])
    together = np.ascontiguousarray(q.T)
    return [LinkLoad(inertia[:, j], j, np.ascontiguousarray(bias[:, j]), together) for j in range(n)]


POWER: Final = 5
"""phi = (1 - s^2)^5 within |s| < 1: zero with four derivatives at the window's ends."""
STRIDE: Final = 4
"""Windows in the width of one: rows overlap."""
MOST_LAG: Final = 12.0
"""Largest lag looked for, of angle behind torque [samples]; half as much ahead."""
LEAST_HALF: Final = 8
"""Samples in half a window: fewer integrate phi'' badly."""


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """One row of the regression for each window of one width."""

    width: float
    """Of the windows [s]."""
    centres: Floats
    """Middle of each window [s]."""
    regressors: Floats
    """Of inertia, damping, friction and offset, shape (rows, 4)."""
    known: Floats
    """Torques already explained, by links and weight, shape (rows,) [N m]."""
    kernel: Floats
    """Offsets of samples from a window's middle [s]."""
    torque: Floats
    """At all samples [N m]."""
    picked: Floats
    """Numbers of the samples at the windows' middles, as integers."""
    sign: Floats
    """1 for a window in forward motion, -1 for one in backward motion."""

    def torques(self, lag: float, derivative: int = 0) -> Floats:
        """Right sides at a lag [s], or their derivative by it."""
        return _weighed(self.torque, _phi(self.kernel + lag, self.width, derivative), self.kernel, self.picked) - (
            self.known if derivative == 0 else 0.0
        )


def _phi(offset: Floats, width: float, derivative: int) -> Floats:
    """The function phi or a derivative of it by time; its integral is 1."""
    half = width / 2
    s = np.clip(offset / half, -1.0, 1.0)
    size = 693.0 / 512.0 / half  # 1 / int (1 - s^2)^5
    u = 1.0 - s * s
    if derivative == 0:
        out: Floats = size * u**POWER
    elif derivative == 1:
        out = size / half * -2 * POWER * s * u ** (POWER - 1)
    else:
        out = size / half**2 * (4 * POWER * (POWER - 1) * s * s * u ** (POWER - 2) - 2 * POWER * u ** (POWER - 1))
    return out


def _weighed(values: Floats, weights: Floats, kernel: Floats, picked: Floats) -> Floats:
    """Integrals of values times a function about each picked sample."""
    reach = kernel.size // 2
    period = kernel[1] - kernel[0]
    whole = fftconvolve(values, weights[::-1], mode="valid") * period
    out: Floats = whole[picked.astype(np.intp) - reach]
    return out


def rows_of(samples: JointSamples, motion: Motion, torque: Floats, links: LinkLoad | None, width: float) -> Rows | None:
    """The rows that evenly spaced samples give with windows of one width; None if there is no window in motion.

    Args:
        samples: Of one joint.
        motion: Of the same samples.
        torque: Of the motor at the joint [N m].
        links: What the limb's links ask of the joint; None where that is not known.
        width: Of a window [s].
    """
    period = samples.period
    half = round(width / 2 / period)
    reach = half + int(np.ceil(MOST_LAG)) + 1
    if half < LEAST_HALF or samples.time.size <= 2 * reach + 1:
        return None
    kernel: Floats = np.arange(-reach, reach + 1) * np.float64(period)
    inside = (np.abs(np.arange(-reach, reach + 1)) <= half).astype(np.float64)
    picked = np.arange(reach, samples.time.size - reach, max(1, 2 * half // STRIDE)).astype(np.float64)
    turning = _weighed(motion.forward, inside, kernel, picked) / period / (2 * half + 1)
    picked = picked[np.abs(turning) > 1.0 - 1e-6]
    if picked.size == 0:
        return None
    places = picked.astype(np.intp)
    curve, slope, plain = (_phi(kernel, width, k) for k in (2, 1, 0))
    regressors = np.column_stack(
        (
            _about_centre(samples.angle, curve, kernel, picked),
            -_about_centre(samples.angle, slope, kernel, picked),
            _weighed(motion.forward, plain, kernel, picked),
            np.ones(picked.size),
        )
    )
    return Rows(
        width=width,
        centres=samples.time[places],
        regressors=regressors,
        known=np.zeros(picked.size) if links is None else _load(links, curve, plain, kernel, picked),
        kernel=kernel,
        torque=torque,
        picked=picked,
        sign=motion.forward[places],
    )


def _load(links: LinkLoad, curve: Floats, plain: Floats, kernel: Floats, picked: Floats) -> Floats:
    """Windowed torques of the links; their inertia is taken as it is at a window's middle."""
    places = picked.astype(np.intp)
    out = _weighed(links.bias, plain, kernel, picked)
    for j, angle in enumerate(links.angles):
        out += links.inertia[places, j] * _about_centre(angle, curve, kernel, picked)
    return out


def _about_centre(angle: Floats, weights: Floats, kernel: Floats, picked: Floats) -> Floats:
    """Integrals of the angle from its value at the window's middle on: phi' and phi'' sum to zero only nearly."""
    period = kernel[1] - kernel[0]
    still = angle[picked.astype(np.intp)] * float(np.sum(weights)) * float(period)
    out: Floats = _weighed(angle, weights, kernel, picked) - still
    return out


WIDTHS: Final = (0.1, 0.2, 0.4, 0.8)
"""Of the windows tried [s]: the one with the least standard errors is taken."""
LEAST_ROWS: Final = 24
BOTH_WAYS: Final = 0.1
"""An offset is told from friction where each direction has this part of the rows."""
VAGUE: Final = 0.3
"""A parameter whose standard error is a larger part of it is not told by the log,"""
SMALL: Final = 0.02
"""unless what that error makes is a smaller part of the largest torque: then the parameter is told to be nearly 0."""
ALONE: Final = 1e-3
"""A regressor of which the others make up all but this part has no value of its own."""
RESAMPLES: Final = 300
BLOCK: Final = 8 * STRIDE
"""Rows that are resampled together, for neighbours share samples: eight windows."""
NAMES: Final = ("inertia", "damping", "friction", "offset")
UNITS: Final = ("kg m^2", "N m s/rad", "N m", "N m")
NEEDS: Final = (
    "speeds that change, one way, over 0.1 s or more",
    "two or more speeds, one way, over 0.1 s or more",
    "motion at two or more speeds, over 0.1 s or more",
    "motion both ways",
)


@dataclass(frozen=True, slots=True, eq=False)
class JointFit:
    """The regression of one joint."""

    estimates: tuple[Estimate, ...]
    """Inertia, damping, friction, offset."""
    lag: float
    """Of the angle behind the torque [s]; half a period of it is the torque being held."""
    values: Floats
    """What was fitted, in the order of `NAMES`, zeros where left out."""
    rows: Rows | None
    residual: float
    """Root mean square of the torque not explained, over the windows [N m]."""


def fit_joint(samples: JointSamples, motion: Motion, torque: Floats, links: LinkLoad | None, seed: int = 0) -> JointFit:
    """Fit the equation of motion to evenly spaced samples.

    Args:
        samples: Of one joint.
        motion: Of the same samples.
        torque: Of the motor at the joint [N m].
        links: What the limb's links ask of the joint; None where that is not known.
        seed: Of the bootstrap.
    """
    best: tuple[float, Rows, Floats, Floats, float, list[int]] | None = None
    for width in WIDTHS:
        rows = rows_of(samples, motion, torque, links, width)
        if rows is None or rows.centres.size < LEAST_ROWS or not torque.any():  # what no motor moves tells nothing
            continue
        columns = _columns(rows)
        first = _first_lag(rows, columns, samples.period)
        values, weights, lag = _robust(rows, columns, first, samples.period)
        draws = _bootstrap(rows, columns, lag, weights, seed)
        vague = float(np.sum((draws.std(axis=0)[:3] / np.maximum(np.abs(values[:3]), 1e-12)) ** 2))
        if best is None or vague < best[0]:
            best = vague, rows, values, draws, lag, columns
    if best is None:
        return JointFit(tuple(map(_missing, range(4))), 0.0, np.zeros(4), None, 0.0)
    _, rows, values, draws, lag, columns = best
    whole = np.zeros(4)
    whole[columns] = values
    residual = rows.torques(lag) - rows.regressors @ whole
    reach = np.abs(rows.regressors).max(axis=0) / max(float(np.abs(rows.torques(lag)).max()), 1e-300)
    alone = _alone(rows.regressors[:, columns])
    estimates = tuple(
        _estimate(k, whole[k], draws[:, columns.index(k)], rows.width, reach[k])
        if k in columns and alone[columns.index(k)] > ALONE
        else _missing(k)
        for k in range(4)
    )
    return JointFit(estimates, lag, whole, rows, float(np.sqrt(np.mean(residual**2))))


def _columns(rows: Rows) -> list[int]:
    forward = float(np.mean(rows.sign > 0.0))
    return [0, 1, 2, 3] if min(forward, 1.0 - forward) >= BOTH_WAYS else [0, 1, 2]


def _alone(design: Floats) -> Floats:
    """Part of each column that the others together do not make up."""
    scaled = design / np.maximum(np.linalg.norm(design, axis=0), 1e-300)
    out = np.empty(design.shape[1])
    for k in range(out.size):
        others = np.delete(scaled, k, axis=1)
        out[k] = np.linalg.norm(scaled[:, k] - others @ np.linalg.lstsq(others, scaled[:, k], rcond=None)[0])
    return out


def _first_lag(rows: Rows, columns: list[int], period: float) -> float:
    """The lag of a coarse grid at which the regression leaves least."""
    projector = np.linalg.qr(rows.regressors[:, columns])[0]

    def left(lag: float) -> float:
        right = rows.torques(lag)
        return float(np.mean(np.abs(right - projector @ (projector.T @ right))))

    grid = np.arange(-0.5 * MOST_LAG, MOST_LAG + 0.25, 0.5) * period
    return float(grid[int(np.argmin([left(lag) for lag in grid]))])


def _robust(rows: Rows, columns: list[int], lag: float, period: float) -> tuple[Floats, Floats, float]:
    """Regression with Huber's loss over parameters and lag: the parameters, the weights that it gave the rows, the lag."""
    design = rows.regressors[:, columns]
    scale = np.append(np.maximum(np.linalg.norm(design, axis=0), 1e-300), 1.0 / period)
    design = design / scale[:-1]
    right = rows.torques(lag)
    start = np.append(np.linalg.lstsq(design, right, rcond=None)[0], lag / period)
    rest = right - design @ start[:-1]
    spread = 1.4826 * float(np.median(np.abs(rest - np.median(rest))))
    edge = max(1.345 * spread, 1e-9 * float(np.max(np.abs(right))), 1e-300)

    def off(x: Floats) -> Floats:
        out: Floats = design @ x[:-1] - rows.torques(x[-1] * period)
        return out

    def slopes(x: Floats) -> Floats:
        return np.column_stack((design, -period * rows.torques(x[-1] * period, 1)))

    reach = np.full(start.size, np.inf)
    reach[-1] = 1.0
    found = least_squares(off, start, jac=slopes, bounds=(start - reach, start + reach), loss="huber", f_scale=edge)
    weights = np.minimum(1.0, edge / np.maximum(np.abs(found.fun), 1e-300))
    return found.x[:-1] / scale[:-1], weights, float(found.x[-1] * period)


def _bootstrap(rows: Rows, columns: list[int], lag: float, weights: Floats, seed: int) -> Floats:
    """Answers to resampled blocks of rows, shape (RESAMPLES, columns); the lag is free to first order in each."""
    design = np.column_stack((rows.regressors[:, columns], -rows.torques(lag, 1)))
    right = rows.torques(lag)
    n, width = design.shape
    block = min(BLOCK, max(1, n // 8))
    starts = np.arange(0, n - block + 1)
    # Normal equations of every block, so that a resample is a sum
    weighed = design * weights[:, None]
    squares = np.einsum("ij,ik->ijk", weighed, design).reshape(n, -1)
    sides = weighed * right[:, None]
    totals = np.cumsum(np.vstack((np.zeros(squares.shape[1] + width), np.hstack((squares, sides)))), axis=0)
    blocks = totals[starts + block] - totals[starts]
    rng = np.random.default_rng(seed)
    out = np.empty((RESAMPLES, len(columns)))
    scale = np.maximum(np.sqrt(np.diag(totals[-1, : width * width].reshape(width, width))), 1e-300)
    for k in range(RESAMPLES):
        drawn = blocks[rng.integers(0, starts.size, -(-n // block))].sum(axis=0)
        matrix = drawn[: width * width].reshape(width, width) / np.outer(scale, scale)
        out[k] = (np.linalg.lstsq(matrix, drawn[width * width :] / scale, rcond=1e-12)[0] / scale)[: len(columns)]
    return out


def _estimate(k: int, value: float, draws: Floats, width: float, reach: float) -> Estimate:
    """`reach` is the largest part of the torques that one unit of the parameter makes."""
    error = float(draws.std())
    nearly_zero = k > 0 and error * reach <= SMALL  # an inertia of nearly 0 would only mean that nothing accelerates
    if error > VAGUE * abs(value) and not nearly_zero:
        return _missing(k)
    low, high = np.quantile(draws, (0.025, 0.975))
    return Estimate(
        NAMES[k], UNITS[k], float(value), error, float(low), float(high), f"weak form, windows of {width:g} s"
    )


def _missing(k: int) -> Estimate:
    return Estimate(NAMES[k], UNITS[k], needs=NEEDS[k])
