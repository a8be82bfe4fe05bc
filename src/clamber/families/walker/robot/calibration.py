"""The sizes of a two-frame mechanism from what is published of it: its range of angles, its longest step, the best directions.

Attachments on circles have four sizes: both radii, the Y-frame's offset, and the length of a drawn-in actuator; three numbers are printed.
Best directions decide nothing but how the whole is turned (`first`): steps of any such mechanism repeat every 60 deg.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from operator import attrgetter
from typing import Annotated, Final

import numpy as np

from ....json_form import HIDDEN, Count, Key
from ....types import Floats
from ....units import DEGREE
from .geometry import TwoFrames
from .mechanism import THIRD
from .turning import turning_range
from .workspace import Workspace, workspace

MM: Final = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Published:
    """What is printed of a mechanism, and how finely."""

    least: float = -18.0 * DEGREE
    """Least angle of the Y-frame in the Delta-frame, turning on the spot [rad]."""
    most: float = 48.0 * DEGREE
    """Largest [rad]."""
    step: float = 160.0 * MM
    """Longest step [m]."""
    direction: float = 30.0 * DEGREE
    """Of the longest step, up to multiples of 60 deg [rad]."""
    stroke: float = 250.0 * MM
    """Of the actuators [m]."""
    angle_rounding: float = 0.5 * DEGREE
    """Half of the last place printed of an angle [rad]."""
    step_rounding: float = 0.5 * MM
    """Half of the last place printed of the step [m]."""


HOSHINO_1995: Final = Published()
"""Hoshino and others, sections 3.1 and 3.2: theta -48 to 18 deg (mirrored here), S 160 mm at 30 + 60 n deg, stroke 0 to 250 mm."""


@dataclass(frozen=True, slots=True)
class Sizes:
    """A mechanism with attachments on circles."""

    radius: float
    """Of the Delta-frame's circle [m]."""
    ratio: float
    """Radius of the Y-frame's circle over it [-]."""
    offset: float
    """Direction of the Y-frame's first attachment less that of the Delta-frame's [rad]."""
    shortest: float
    """Length of a drawn-in actuator [m]."""

    def frames(self, stroke: float, first: float = 0.0) -> TwoFrames:
        """The mechanism, its Delta-frame's first attachment in the direction `first` [rad]."""
        thirds = first + THIRD * np.arange(3)
        delta = self.radius * np.stack([np.cos(thirds), np.sin(thirds)], axis=1)
        turned = thirds + self.offset
        y = self.radius * self.ratio * np.stack([np.cos(turned), np.sin(turned)], axis=1)
        return TwoFrames(delta, y, self.shortest, self.shortest + stroke, 1.0)


def _longest(measure: Callable[[float], float]) -> tuple[float, float]:
    """Largest of a function of direction that repeats every 60 deg, and where."""
    width = math.pi / 3.0 / 24
    values = [measure(k * width) for k in range(24)]
    peak = int(np.argmax(values))
    low, high = (peak - 1) * width, (peak + 1) * width
    while high - low > 1e-8:
        a, b = low + 0.382 * (high - low), low + 0.618 * (high - low)
        low, high = (low, b) if measure(a) >= measure(b) else (a, high)
    return measure(0.5 * (low + high)), 0.5 * (low + high)


def _through_centre(region: Workspace, direction: float) -> float:
    low, high = region.chord(direction)
    return high - low


def _one_way(region: Workspace, direction: float) -> float:
    low, high = region.chord(direction)
    return max(high, -low)


def _whole_width(region: Workspace, direction: float) -> float:
    low, high = region.extent(direction)
    return high - low


READINGS: Final[dict[str, tuple[Callable[[Workspace, float], float], bool]]] = {
    "chord through the centre, theta = 0": (_through_centre, False),
    "from the centre one way, theta = 0": (_one_way, False),
    "width of the region, theta = 0": (_whole_width, False),
    "chord through the centre, mid range": (_through_centre, True),
}
"""What the printed step may mean -> its length along a direction [m], and whether at the middle of the angles; the first is ours."""
OURS: Final = next(iter(READINGS))


@dataclass(frozen=True, slots=True)
class Family:
    """Which sizes are free, and how the step is read."""

    name: str
    free: tuple[str, ...]
    """Of the fields of `Sizes`, in order."""
    fixed: tuple[tuple[str, float], ...]
    """The others."""
    reading: str = OURS


ALIKE: Final = (("ratio", 1.0), ("offset", -60.0 * DEGREE))
FAMILIES: Final = (
    Family("equal circles, neighbouring tips", ("radius", "shortest"), ALIKE),
    Family("the same, drawn-in length 0", ("radius",), (*ALIKE, ("shortest", 0.0))),
    Family("circles of two sizes", ("radius", "ratio", "shortest"), (("offset", -60.0 * DEGREE),)),
    Family("equal circles, any offset", ("radius", "offset", "shortest"), (("ratio", 1.0),)),
    Family("circles of two sizes, any offset", ("radius", "ratio", "offset", "shortest"), ()),
    *(Family("equal circles, neighbouring tips", ("radius", "shortest"), ALIKE, name) for name in list(READINGS)[1:]),
)
"""The rivals; the first is the one that the robot file states."""
RANGES: Final = {
    "radius": (0.05, 1.0),
    "ratio": (0.3, 3.0),
    "offset": (-math.pi, 0.0),
    "shortest": (0.0, 1.0),
}
"""Where free sizes are looked for."""


OFF: Final = 1e4
"""Misfit of sizes that do not allow theta = 0 at all [-]."""
DRAWS: Final = 200
"""Random sizes of which the best is where a fit starts."""


@dataclass(frozen=True, slots=True)
class Fit:
    """The best sizes of a family from one start."""

    family: Annotated[Family, HIDDEN]
    seed: int
    sizes: Annotated[
        Sizes,
        Key("radius_delta_m", get=attrgetter("radius"), kind=float),
        Key("radius_y_m", get=lambda sizes: sizes.radius * sizes.ratio, kind=float),
        Key("offset_rad", get=attrgetter("offset"), kind=float),
        Key("shortest_m", get=attrgetter("shortest"), kind=float),
    ]
    least: Annotated[float, Key("least_rad", after="first_rad")]
    """Least angle of the Y-frame that it gives [rad]."""
    most: Annotated[float, Key("most_rad", after="least_rad")]
    """Largest angle that it gives [rad]."""
    step: Annotated[float, Key("step_m", after="most_rad")]
    """Longest step it gives [m]."""
    first: Annotated[float, Key("first_rad", after="shortest_m")]
    """Direction of the Delta-frame's first attachment that puts the best directions where they are printed, up to 60 deg, in
    [-30, 30] deg [rad]."""
    misfit: float
    """Largest difference from what is printed, in half last places: 1 and below rounds to what is printed [-]."""


def fit_of(sizes: Sizes, published: Published = HOSHINO_1995, family: Family = FAMILIES[0], seed: int = 0) -> Fit:
    """What given sizes make of the printed numbers."""
    least, most, step, direction = measure_sizes(sizes, published, family.reading)
    first = math.remainder(published.direction - direction, math.pi / 3.0)
    misfit = float(abs(_misfits(least, most, step, published)).max())
    return Fit(family, seed, sizes, least, most, step, first, misfit)


def _misfits(least: float, most: float, step: float, published: Published) -> Floats:
    if math.isnan(step):
        return np.full(3, OFF)
    off = np.array([least - published.least, most - published.most, step - published.step])
    return off / (published.angle_rounding, published.angle_rounding, published.step_rounding)


def measure_sizes(sizes: Sizes, published: Published, reading: str) -> tuple[float, float, float, float]:
    """Least and largest angle [rad], longest step [m] and its direction [rad] with the first attachment at 0; nan where 0 is no angle."""
    frames = sizes.frames(published.stroke)
    turn = turning_range(frames, (0.0, 0.0, 0.0))
    if turn.span <= 0.0:
        return math.nan, math.nan, math.nan, math.nan
    measure, at_middle = READINGS[reading]
    region = workspace(frames, 0.5 * (turn.least + turn.most) if at_middle else 0.0)
    step, direction = _longest(partial(measure, region))
    return turn.least, turn.most, step, direction


def fit_family(family: Family, published: Published, seed: int) -> Fit:
    """Least squares in half last places, from the best of random sizes.

    Args:
        family: What is free.
        published: What is to be met.
        seed: Of the random sizes.
    """
    from scipy.optimize import least_squares

    rng = np.random.default_rng(seed)
    low, high = np.array([RANGES[name] for name in family.free]).T
    fixed = dict(family.fixed)

    def sizes_of(values: Floats) -> Sizes:
        return Sizes(**{**fixed, **dict(zip(family.free, map(float, values), strict=True))})

    def misfits(values: Floats) -> Floats:
        least, most, step, _ = measure_sizes(sizes_of(values), published, family.reading)
        return _misfits(least, most, step, published)

    starts = rng.uniform(low, high, (DRAWS, len(low)))
    start = starts[int(np.argmin([float(abs(misfits(values)).max()) for values in starts]))]
    found = least_squares(misfits, start, bounds=(low, high), x_scale=0.1 * (high - low), xtol=1e-12, ftol=1e-12)
    return fit_of(sizes_of(found.x), published, family, seed)


@dataclass(frozen=True, slots=True)
class Rivals:
    """What a family makes of the printed numbers, from several random starts."""

    family: Annotated[
        Family,
        Key("free", get=attrgetter("free"), kind=tuple[str, ...]),
        Key("family", get=attrgetter("name"), kind=str),
        Key("step_is", get=attrgetter("reading"), kind=str, meaning="How the printed step is read."),
    ]
    fits: Annotated[tuple[Fit, ...], Key(after="seeds_that_fit")]
    """The best first, then those that also round to what is printed with other sizes (radius off by over 1 %)."""
    good: Annotated[Count, Key("seeds_that_fit", after="seeds")]
    """Seeds whose fit rounds to what is printed."""
    seeds: Annotated[Count, Key(after="step_is")]
    """Seeds in all."""


def fit_families(
    published: Published = HOSHINO_1995,
    seeds: Sequence[int] = range(8),
    families: Sequence[Family] = FAMILIES,
    progress: Callable[[int, int], None] = lambda fit, fits: None,
) -> list[Rivals]:
    """Fits of every family from every seed; `progress` is told each that begins, from 1, and how many there are."""
    out: list[Rivals] = []
    for family in families:
        fits: list[Fit] = []
        for seed in seeds:
            progress(len(out) * len(seeds) + len(fits) + 1, len(families) * len(seeds))
            fits.append(fit_family(family, published, seed))
        fits.sort(key=attrgetter("misfit"))
        told = fits[:1]
        for fit in fits[1:]:
            if fit.misfit <= 1.0 and all(abs(fit.sizes.radius / one.sizes.radius - 1.0) > 0.01 for one in told):
                told.append(fit)
        out.append(Rivals(family, tuple(told), sum(fit.misfit <= 1.0 for fit in fits), len(fits)))
    return out
