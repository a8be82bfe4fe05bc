"""Inertia, damping and Coulomb friction of one joint by robust regression of the weak form, with errors from a bootstrap."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.optimize import least_squares

from ...types import Floats
from .estimate import Estimate
from .links import LinkLoad
from .motion import Motion
from .samples import JointSamples
from .weak_form import MOST_LAG, STRIDE, Rows, rows_of

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
        if rows is None or rows.centres.size < LEAST_ROWS:
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
