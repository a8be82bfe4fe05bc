"""How a walker crosses a ditch: pivot to where its frames reach over, then slide frame by frame, the fewest slides first."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Final, Literal

import numpy as np

from ....json_form import HIDDEN, INLINE, Count, Key, OrNull, in_json
from ....types import Floats
from .ditch import Footing, FootingError, ditch_map
from .ditch_slides import fewest_slides
from .plane_poses import seen_from
from .region_ways import place_at, way_inside
from .turning import turning_range
from .workspace import workspace

DELTA, Y = 0, 1
SMALL = 1e-9
"""Turns below are none [rad]."""


def pivots(theta: float, aim: float, turn: float, limits: tuple[float, float]) -> tuple[tuple[int, float], ...]:
    """Pivots that turn the Delta-frame by `turn` and bring theta to `aim`: frame and by how much it turns [rad]."""
    low, high = limits
    moves: list[tuple[int, float]] = []
    while abs(turn) > SMALL:
        if low <= theta - turn <= high:
            step = turn
        elif low <= aim + turn <= high:
            moves.append((Y, aim + turn - theta))
            theta, step = aim + turn, turn
        else:  # wind up as far as it goes, then let the Delta-frame follow
            wound = high if turn > 0.0 else low
            moves.append((Y, wound - theta))
            theta = wound
            step = math.copysign(min(abs(turn), high - low), turn)
        moves.append((DELTA, step))
        theta, turn = theta - step, turn - step
    if abs(aim - theta) > SMALL:
        moves.append((Y, aim - theta))
    return tuple(move for move in moves if abs(move[1]) > SMALL)


SPARE: Final = 1e-6
"""Kept off the limits of the region, for rounding [m]."""
GRID: Final = math.radians(1.0)
"""Between the angles and directions that are looked at [rad]."""
SAMPLES: Final = 64
"""Places of a slide at which its margins are taken."""

Status = Literal["found", "impossible"]


@dataclass(frozen=True, slots=True, eq=False)
class Slide:
    """One slide: the other frame stands, this one is lifted, moved and put down."""

    frame: Annotated[int, Key(get=("delta", "y").__getitem__, kind=Literal["delta", "y"])]
    """0: the Delta-frame, 1: the Y-frame."""
    way: Annotated[Floats, Key(kind=list[tuple[float, float, float]])]
    """Poses of its origin on the ground, straight from one to the next: x, y [m], angle [rad], shape (n, 3); x across the ditch."""


@dataclass(frozen=True, slots=True)
class SlideMargins:
    """How far the worst place of a slide is from each limit; positive holds."""

    stroke: Annotated[float, Key("stroke_m")]
    """Actuators from the ends of their range [m]."""
    singular: OrNull
    """Guard less nearness [-]; infinite without a guard."""
    balance: Annotated[float, Key("balance_m")]
    """Centre of mass inside the standing feet, and inside both frames' when it has landed, less what is asked for [m]."""
    foothold: Annotated[float, Key("foothold_m")]
    """Feet from the ditch once it has landed, pads taken off [m]."""

    @property
    def least(self) -> float:
        """The worst of them."""
        return min(self.stroke, self.singular, self.balance, self.foothold)


@dataclass(frozen=True, slots=True, eq=False)
class JudgedSlide:
    """One frame moved while the other stands."""

    slide: Annotated[Slide, INLINE]
    margins: SlideMargins


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Crossing:
    """A way over a ditch 0 < x < width, or why there is none."""

    status: Status
    reason: str
    footing: Annotated[Footing, HIDDEN]
    width: Annotated[float, Key("width_m")]
    """Of the ditch [m]."""
    theta: Annotated[float, Key("theta_rad")]
    """Angle of the Y-frame in the Delta-frame while crossing [rad]."""
    direction: Annotated[float, Key("direction_rad")]
    """Of crossing, in the Delta-frame [rad]."""
    widest: Annotated[float, Key("widest_m")]
    """What could be crossed so [m]."""
    pivots: Count
    """How many of the slides turn a frame."""
    start: Annotated[Floats, Key(kind=list[tuple[float, float, float]])]
    """Poses of both frames on the ground, shape (2, 3)."""
    slides: Annotated[tuple[Slide, ...], HIDDEN]
    """Pivots first; none if there is no way."""

    @in_json(key="slides")
    def judged(self) -> tuple[JudgedSlide, ...]:
        """Pivots first; none if there is no way."""
        return tuple(map(JudgedSlide, self.slides, self.replay())) if self.status == "found" else ()

    def replay(self) -> tuple[SlideMargins, ...]:
        """Margins of every slide, from poses alone."""
        before = stances(self.start, self.slides)
        return tuple(
            slide_margins(self.footing, self.width, slide, poses)
            for slide, poses in zip(self.slides, before, strict=False)
        )

    def end(self) -> Floats:
        """Poses of both frames after all slides, shape (2, 3)."""
        return stances(self.start, self.slides)[-1]


def stances(start: Floats, slides: Iterable[Slide]) -> list[Floats]:
    """Poses of both frames on the ground before the first slide and after each, every one of shape (2, 3)."""
    out = [start]
    for slide in slides:
        assert np.allclose(slide.way[0], out[-1][slide.frame], atol=1e-9)
        poses = out[-1].copy()
        poses[slide.frame] = slide.way[-1]
        out.append(poses)
    return out


def slide_margins(footing: Footing, width: float, slide: Slide, poses: Floats) -> SlideMargins:
    """Margins of one slide, from poses alone.

    Args:
        footing: The robot.
        width: Of the ditch, 0 < x < width [m].
        slide: What is moved.
        poses: Of both frames on the ground before it, shape (2, 3).
    """
    now = poses.copy()
    stroke, singular, balance = math.inf, math.inf, math.inf
    for a, b in pairwise(slide.way):
        for share in np.linspace(0.0, 1.0, SAMPLES):
            now[slide.frame] = a + share * (b - a)
            place = seen_from(*now)
            stroke = min(stroke, footing.frames.room(place))
            if footing.guard > 0.0:
                singular = min(singular, footing.guard - footing.frames.nearness(place))
            balance = min(balance, footing.balance(now, 1 - slide.frame))
    balance = min(balance, footing.balance(now, slide.frame))  # it has landed, and may carry in turn
    across = footing.feet_at(now)[slide.frame][:, 0]
    foothold = float(np.maximum(-across, across - width).min()) - footing.pad_radius
    return SlideMargins(stroke, singular, balance - footing.margin, foothold)


def cross_ditch(
    footing: Footing,
    width: float,
    *,
    before: float,
    heading: float = 0.0,
    theta: float = 0.0,
    reserve: float = 0.0,
    aside: bool = True,
) -> Crossing:
    """Pivot as little as it takes, then cross a straight ditch in the fewest slides.

    Args:
        footing: The robot.
        width: Of the ditch, 0 < x < width [m].
        before: How far before the near edge the frames' origins start, on each other [m].
        heading: Angle of the Delta-frame to the crossing direction [rad].
        theta: Angle of the Y-frame in the Delta-frame at the start [rad].
        reserve: How much wider a ditch must still be crossable at the angles that are chosen [m].
        aside: Whether slides may also lead along the ditch.

    Returns:
        The crossing; `impossible`, with its reason, where no angles of a grid of 1 deg reach over, where the robot stands too near to
        turn, or where its start is no stance.

    Raises:
        FootingError: If width, distance or reserve are negative or not finite.
    """
    for what, value in (("width", width), ("before", before), ("reserve", reserve)):
        if not 0.0 <= value < math.inf:
            raise FootingError(what, value)
    start = np.array([[-before, 0.0, heading], [-before, 0.0, heading + theta]])

    def none(reason: str, widest: float = 0.0) -> Crossing:
        return Crossing(
            status="impossible", reason=reason, footing=footing, width=width, theta=theta, direction=-heading,
            widest=widest, start=start, slides=(), pivots=0,
        )  # fmt: skip

    guard = footing.guard or None
    if workspace(footing.frames, theta, guard=guard, besides=footing.balance_curves(theta)).central is None:
        return none(f"the frames cannot lie on each other at theta = {math.degrees(theta):.6g} deg")
    if footing.feet_at(start)[:, :, 0].max() > -footing.pad_radius:
        return none(f"a foot stands in the ditch at the start; start more than {before * 1e3:.6g} mm before it")
    turn = turning_range(footing.frames, (0.0, 0.0, theta), guard=guard)
    low, high = theta + turn.least, theta + turn.most
    aims = _aims(footing, width + reserve, heading, theta, (low, high), aside)
    if not aims:
        best = float(_map(footing, low, high, aside)[2].max())
        return none(f"the widest ditch that it crosses at any angle of a grid of 1 deg is {best * 1e3:.6g} mm", best)
    for aim in aims:
        turned = _as_slides(start, aim.moves)
        standing = stances(start, turned)
        before = all(footing.feet_at(poses)[:, :, 0].max() <= -footing.pad_radius for poses in standing)
        margins = (slide_margins(footing, width, *each) for each in zip(turned, standing, strict=False))
        if before and all(one.least >= -1e-9 for one in margins):
            break
    else:
        return none(
            "it cannot pivot where it stands, over its own feet and before the ditch; start farther off", aims[0].widest
        )
    slides = _slides(footing, width, standing[-1], aside)
    if slides is None:
        return none("from where it stands no row of slides leads across", aim.widest)
    return Crossing(
        status="found", reason="", footing=footing, width=width, theta=aim.theta, direction=aim.direction,
        widest=aim.widest, start=start, slides=(*turned, *slides), pivots=len(turned),
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class _Aim:
    theta: float
    direction: float
    widest: float
    moves: tuple[tuple[int, float], ...]
    """Frame and by how much it turns [rad]."""


def _map(footing: Footing, low: float, high: float, aside: bool) -> tuple[Floats, Floats, Floats]:
    thetas: Floats = np.arange(math.ceil(low / GRID), math.floor(high / GRID) + 1.0) * GRID
    directions: Floats = np.arange(-180.0, 180.0) * GRID
    return thetas, directions, ditch_map(footing, thetas, directions, aside=aside)


def _aims(
    footing: Footing, width: float, heading: float, theta: float, limits: tuple[float, float], aside: bool
) -> list[_Aim]:
    """Angles at which the ditch can be crossed, those with the fewest pivots and the least turning first."""
    here = float(ditch_map(footing, [theta], [-heading], aside=aside)[0, 0])
    found = [_Aim(theta, -heading, here, ())] if here >= width else []
    thetas, directions, widths = _map(footing, *limits, aside)
    for i, j in np.argwhere(widths >= width):
        turn = math.remainder(-heading - float(directions[j]), math.tau)
        moves = pivots(theta, float(thetas[i]), turn, limits)
        found.append(_Aim(float(thetas[i]), float(directions[j]), float(widths[i, j]), moves))
    return sorted(found, key=lambda aim: (len(aim.moves), sum(abs(move[1]) for move in aim.moves), -aim.widest))


def _as_slides(start: Floats, moves: Sequence[tuple[int, float]]) -> list[Slide]:
    poses, out = start.copy(), []
    for frame, turn in moves:
        after = poses[frame] + (0.0, 0.0, turn)
        out.append(Slide(frame, np.array([poses[frame], after])))
        poses[frame] = after
    return out


def _slides(footing: Footing, width: float, poses: Floats, aside: bool) -> list[Slide] | None:
    """The fewest slides from poses before the ditch to both frames behind it, their angles kept; None if there are none."""
    heading, theta = float(poses[0, 2]), float(poses[1, 2] - poses[0, 2])
    region = workspace(footing.frames, theta, guard=footing.guard or None, besides=footing.balance_curves(theta))
    low, high = region.extent(-heading) if aside else region.chord(-heading)
    flat = np.array([[0.0, 0.0, heading], [0.0, 0.0, heading + theta]])
    row = fewest_slides(
        footing.feet_at(flat)[:, :, 0], width, footing.pad_radius, poses[:, 0], (low + SPARE, high - SPARE)
    )
    if row is None:
        return None
    turn = np.array([[math.cos(heading), -math.sin(heading)], [math.sin(heading), math.cos(heading)]])
    now, place, out = poses.copy(), np.zeros(2), []
    for frame, across in row:
        apart = across - now[0, 0] if frame == 1 else now[1, 0] - across
        after = place_at(region, -heading, apart, aside)
        way = way_inside(region, place, after)
        if way is None:
            return None
        rows = np.column_stack([way @ turn.T, np.full(len(way), now[frame, 2])])
        rows[:, :2] = now[0, :2] + rows[:, :2] if frame == 1 else now[1, :2] - rows[:, :2]
        out.append(Slide(frame, rows))
        now[frame], place = rows[-1], after
    return out
