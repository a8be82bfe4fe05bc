"""Holds that are generated on surfaces: the same seed makes the same world on every machine."""

import math
from typing import Annotated

import numpy as np
from pydantic import Field

from ....specs import spec
from ....types import Floats
from ....units import (
    Length,
    NonNegativeAngle,
    NonNegativeLength,
    NonNegativeRatio,
    Place,
    PositiveForce,
    PositiveLength,
    Quantity,
)
from .guide import GRAIN
from .solids import Direction, frame_about, unit

Span = tuple[Length, Length]
Seed = Annotated[int, Field(strict=True, ge=0)]


@spec
class Patch:
    """A flat surface somewhere."""

    at: Place
    """Its origin, world frame."""
    x: Direction
    """Along it."""
    normal: Direction
    """Out of it."""

    @property
    def frames(self) -> Floats:
        """As those of a guide along x, shape (2, 12)."""
        axes = frame_about(unit(self.normal), unit(self.x))
        return np.stack([np.concatenate((np.array(self.at) + k * GRAIN * axes[0], axes.ravel())) for k in range(2)])


@spec
class Pattern:
    """A jittered grid of holds on the surface that a guide runs over, or on a flat patch somewhere."""

    on: Patch | None = None
    """None: on the guide."""
    along: Span
    """From where to where along the guide, or the patch's x [m]; beyond its ends a guide goes straight on."""
    across: Span
    """From where to where across it [m]."""
    spacing: PositiveLength
    """Distance of neighbours before the jitter [m]."""
    jitter: NonNegativeLength = 0.0
    """Both coordinates move by up to this much either way [m]."""
    bumps: NonNegativeLength = 0.0
    """Largest height of bumps above and below the surface [m]."""
    bump_length: PositiveLength = 0.3
    """Distance over which bumps rise and fall [m]."""
    tilt: NonNegativeAngle = 0.0
    """Largest angle by which a normal leans from that of the bumpy surface [rad]."""
    height: Length = 0.0
    """Of the surface over the guide [m]."""
    left_out: Annotated[float, Quantity("ratio", at_least=0.0, at_most=0.95)] = 0.0
    """Share of the holds that are missing, chosen at random [-]."""
    friction: NonNegativeRatio | None = None
    """Of the surface; None: that of the end effector."""
    strength: PositiveForce | None = None
    """Of every hold [N]; None: any."""
    radius: PositiveLength = 0.01
    """Of every hold's patch, as it is drawn [m]; no check reads it."""
    seed: Seed = 0

    @property
    def grid(self) -> float:
        """Holds that it makes, about, those that are missing left out."""
        rows, columns = (_number(span, self.spacing) for span in (self.along, self.across))
        return rows * columns * (1.0 - self.left_out)

    def points(self, frames: Floats, seed: int = 0) -> list[tuple[Floats, Floats]]:
        """Place and normal of each hold, world frame, row by row along the guide.

        Args:
            frames: Of the guide, shape (n, 12).
            seed: Of the world, added to the pattern's own.
        """
        rng = np.random.default_rng(self.seed + seed)
        frames = frames if self.on is None else self.on.frames
        waves = _waves(rng, self.bump_length) if self.bumps > 0.0 else None
        made = []
        for along in _steps(self.along, self.spacing):
            for across in _steps(self.across, self.spacing):
                u, v = np.array((along, across)) + rng.uniform(-self.jitter, self.jitter, 2)
                lean, way, kept = (
                    rng.uniform(0.0, self.tilt),
                    rng.uniform(0.0, math.tau),
                    rng.uniform() >= self.left_out,
                )
                if not kept:
                    continue
                height, slope = _bump(waves, u, v, self.bumps)
                frame = frame_at(frames, float(u))
                axes = frame[3:].reshape(3, 3)
                normal = np.array((-slope[0], -slope[1], 1.0))
                normal += math.tan(lean) * np.linalg.norm(normal) * np.array((math.cos(way), math.sin(way), 0.0))
                place = frame[:3] + v * axes[1] + (self.height + height) * axes[2]
                made.append((place, (normal / np.linalg.norm(normal)) @ axes))
        return made


def frame_at(frames: Floats, along: float) -> Floats:
    """The frame of a guide at a distance along it [m], which may lie before its start or behind its end, shape (12,)."""
    last = GRAIN * (len(frames) - 1)
    at = min(max(along, 0.0), last) / GRAIN
    k = min(int(at), len(frames) - 2)
    frame: Floats = (1.0 - (at - k)) * frames[k] + (at - k) * frames[k + 1]
    frame[:3] += (along - min(max(along, 0.0), last)) * frame[3:6]
    return frame


def _steps(span: Span, spacing: float) -> Floats:
    return np.linspace(span[0], span[1], _number(span, spacing))


def _number(span: Span, spacing: float) -> int:
    return max(1, round((span[1] - span[0]) / spacing) + 1)


def _waves(rng: np.random.Generator, length: float) -> Floats:
    """Twelve sine waves, rows of wave numbers along and across [1/m], phase, and weight; the weights add up to one."""
    ways, lengths = rng.uniform(0.0, math.tau, 12), length * rng.uniform(0.7, 2.0, 12)
    weights = rng.uniform(0.5, 1.0, 12)
    numbers = math.tau / lengths
    return np.column_stack(
        (numbers * np.cos(ways), numbers * np.sin(ways), rng.uniform(0.0, math.tau, 12), weights / weights.sum())
    )


def _bump(waves: Floats | None, u: float, v: float, size: float) -> tuple[float, tuple[float, float]]:
    """Height and slopes of a sum of waves, at most `size` high [m]."""
    if waves is None:
        return 0.0, (0.0, 0.0)
    phase = waves[:, 0] * u + waves[:, 1] * v + waves[:, 2]
    weight = size * waves[:, 3]
    swing = weight * np.cos(phase)
    return float((weight * np.sin(phase)).sum()), (
        float((swing * waves[:, 0]).sum()),
        float((swing * waves[:, 1]).sum()),
    )
