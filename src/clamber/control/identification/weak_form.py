r"""The equation of a geared joint in its weak form, which needs no derivative of a measured angle.

Equation 3.28 of Bevly 1997, with the signs of its friction put right, is I qdd + d qd + tau_f sign(qd) + tau_0 = tau(t - L): L is how
late the angle is behind the torque, tau_0 what pulls one way. Times a smooth function phi that is zero outside a short window, and
integrated by parts (modulating functions, Shinbrot 1957), it reads

    I int phi'' q - d int phi' q + tau_f int phi sign(qd) + tau_0 int phi = int phi(t + L) tau(t) dt,

one row of a linear regression for each window. Windows in which the joint may stand still are left out: there friction is any
torque up to tau_f.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.signal import fftconvolve

from ...types import Floats
from .links import LinkLoad
from .motion import Motion
from .samples import JointSamples

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
