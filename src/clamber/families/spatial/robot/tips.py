"""Where a limb that was found ends, which way it points and how it stands: guesses, each with its reason."""

import re
from dataclasses import dataclass
from typing import Final

import numpy as np

from ....types import Floats
from ....units import DEGREE
from .finding import Chain, Part, end_points
from .tree import Joint, Link, Posture, Site, Tree, turn

ENDS: Final = re.compile(
    r"foot|feet|toe|sole|tip|hand|palm|grip|tool|flange|(^|[_-])(ee|eef|tcp)([_-]|$)|wrist|fist|hook|clamp|magnet", re.I
)
"""Names of frames at tips."""
SENSES: Final = re.compile(r"imu|cam|sens|force|(^|[_-])ft([_-]|$)|rotor|optical|joint|protector|finger", re.I)
"""Names of frames that are no ends."""
SEGMENT: Final = 0.25
"""A limb points the way that its last segment of this part of its length does [-]."""
AXIAL: Final = 0.95
"""An end that lies along its last joint's axis by this part of its distance is a wrist's [-]."""
FLAT: Final = 5e-3
"""Points that are within this of the outermost one are the face that touches [m]."""
UPRIGHT: Final = 25 * DEGREE
"""A direction this near to an axis of its link is that axis [rad]."""
SAMPLES: Final = 512
WIDEST: Final = 120 * DEGREE
"""Nominal angles are looked for within this of 0, where the limits allow [rad]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TipGuess:
    """The end of a limb."""

    frame: str
    """Site or link."""
    offset: Floats
    """From there to the tip [m]."""
    out: Floats
    """Out of the limb, unit, in that frame."""
    why: str
    """What it was guessed from."""


def guess_tip(tree: Tree, chain: Chain) -> TipGuess:
    """Tip and direction of a limb."""
    posture = Posture.of(tree)
    out = _outward(posture, chain)
    frame, named = _frame(posture, chain.end, out)
    if isinstance(frame, Site):
        at = posture.site(frame)
        z = at.axes[:, 2]
        axis = z if float(z @ out) > 0.5 else out
        return TipGuess(frame=frame.name, offset=np.zeros(3), out=_on_axis(at.axes.T @ axis), why=named)
    at = posture.frame(frame)
    inside = _on_axis(at.axes.T @ out)
    place, shape = _face(posture, chain.end, frame, at.axes @ inside, by_name=named.startswith("named"))
    why = f"{named}, {shape}"
    return TipGuess(frame=frame.name, offset=np.zeros(3) if place is None else at.within(place), out=inside, why=why)


def _outward(posture: Posture, chain: Chain) -> Floats:
    """Direction of a limb's last joint where its end lies along that, otherwise of its last long segment, unit."""
    anchors = [posture.axis(joint)[0] for joint in chain.joints]
    points = np.array(list(end_points(posture, chain.end)))
    far = points[np.argmax(np.linalg.norm(points - anchors[-1], axis=1))]
    axis = posture.axis(chain.joints[-1])[1]
    along = float((far - anchors[-1]) @ axis)
    if abs(along) > AXIAL * float(np.linalg.norm(far - anchors[-1])) > 0.0:
        return _unit(axis * np.sign(along))
    end = far if np.linalg.norm(far - anchors[-1]) >= SEGMENT * chain.length else anchors[-1]
    for anchor in reversed(anchors):
        if np.linalg.norm(end - anchor) >= SEGMENT * chain.length:
            return _unit(end - anchor)
    return _unit(far - anchors[0]) if np.linalg.norm(far - anchors[0]) > 1e-6 else np.array([0.0, 0.0, -1.0])


def _frame(posture: Posture, end: Part, out: Floats) -> tuple[Site | Link, str]:
    """The site or link that a tip is told from, and why."""
    names = {link.name for link in end.links}
    sites = [site for site in posture.tree.sites if site.link in names and not SENSES.search(site.name)]
    telling = [site for site in sites if ENDS.search(site.name)] or (sites if len(sites) == 1 else [])
    if telling:
        site = max(telling, key=lambda one: float(posture.site(one).place @ out))
        return site, "the site on its last link"
    ends = [link for link in end.links if ENDS.search(link.name) and not SENSES.search(link.name)]
    if ends:
        # feet and soles before wrists and tools that carry them, and the outermost of those
        link = max(ends, key=lambda one: float(posture.frame(one).place @ out))
        return link, "named as an end"
    return end.links[0], "its last link"


def _face(posture: Posture, end: Part, link: Link, out: Floats, *, by_name: bool) -> tuple[Floats | None, str]:
    """Middle of the face that is outermost on a part, and what that was taken from; None: the frame itself."""
    own = list(posture.shapes(frozenset([link.name]))) if by_name else []
    bodies = own or list(posture.shapes(frozenset(one.name for one in end.links)))
    if bodies:
        points = np.concatenate([points + shape.radius * out for points, shape in bodies])
        along = points @ out
        face = points[along >= along.max() - FLAT]
        return face.mean(axis=0), "moved to where its shape ends"
    if by_name:
        return None, "no shape to tell more"
    places = [posture.frame(one).place for one in end.links]
    farthest = max(places, key=lambda place: float(place @ out))
    origin = posture.frame(link).place
    if float((farthest - origin) @ out) > 1e-3:
        return farthest, "moved to its outermost frame, for it has no shape"
    centre = posture.frame(link).at(link.centre)
    if float((centre - origin) @ out) > 1e-3:
        return origin + 2.0 * (centre - origin), "moved to twice its centre of mass, for it has no shape"
    return None, "no shape to tell more"


def _on_axis(direction: Floats) -> Floats:
    """A unit vector, or the axis that it is nearly along."""
    k = int(np.argmax(np.abs(direction)))
    axis = np.zeros(3)
    axis[k] = np.sign(direction[k])
    return axis if float(direction @ axis) >= np.cos(UPRIGHT) else direction


def _unit(vector: Floats) -> Floats:
    made: Floats = vector / np.linalg.norm(vector)
    return made


def guess_nominal(tree: Tree, joints: tuple[Joint, ...], limits: list[tuple[float, float]], tip: Floats) -> list[float]:
    """A posture away from limits in which the tip can move every way, and hangs as with all joints at 0.

    Args:
        tree: With the base as its root.
        joints: Of the limb, from the base.
        limits: Positions that each may take [rad] or [m].
        tip: With all joints at 0, model's frame [m].
    """
    low = np.array(
        [
            lower if joint.sliding else max(lower, min(-WIDEST, upper))
            for joint, (lower, upper) in zip(joints, limits, strict=True)
        ]
    )
    high = np.array(
        [
            upper if joint.sliding else min(upper, max(WIDEST, lower))
            for joint, (lower, upper) in zip(joints, limits, strict=True)
        ]
    )
    low = np.minimum(low, high)
    best, best_score = (low + high) / 2, -1.0
    for row in _spread(SAMPLES, len(joints)):
        positions = low + row * (high - low)
        if (score := _ease(joints, positions, low, high, tip)) > best_score:
            best, best_score = positions, score
    width = (high - low) / 8
    while width.max() > 0.01:  # rad, or of a slide 1 cm
        tried = best_score
        for k in range(len(joints)):
            for step in (-width[k], width[k]):
                moved = best.copy()
                moved[k] = np.clip(moved[k] + step, low[k], high[k])
                if (score := _ease(joints, moved, low, high, tip)) > best_score:
                    best, best_score = moved, score
        width = width / 2 if best_score <= tried else width
    return [float(value) for value in best]


def _ease(joints: tuple[Joint, ...], positions: Floats, low: Floats, high: Floats, tip: Floats) -> float:
    """How well a tip moves every way from a posture, less near limits and where it points elsewhere than at 0 [-]."""
    place = tip.copy()
    for joint, position in zip(reversed(joints), reversed(positions), strict=True):
        axis, anchor = np.array(joint.axis), np.array(joint.anchor)
        place = place + axis * position if joint.sliding else anchor + turn(axis, position) @ (place - anchor)
    columns, rotation, shift = [], np.eye(3), np.zeros(3)
    for joint, position in zip(joints, positions, strict=True):
        axis, anchor = rotation @ np.array(joint.axis), rotation @ np.array(joint.anchor) + shift
        columns.append(axis if joint.sliding else np.cross(axis, place - anchor))
        if joint.sliding:
            shift = shift + axis * position
        else:
            turned = turn(axis, position)
            rotation, shift = turned @ rotation, anchor + turned @ (shift - anchor)
    least = float(np.linalg.svd(np.array(columns), compute_uv=False)[min(3, len(joints)) - 1])
    start = np.array(joints[0].anchor)
    before, now = tip - start, place - start
    sizes = float(np.linalg.norm(before) * np.linalg.norm(now))
    along = float(before @ now) / sizes if sizes > 1e-9 else 0.0
    room = 4.0 * (positions - low) * (high - positions) / np.maximum((high - low) ** 2, 1e-12)
    return least * (1.0 + along) * float(np.clip(room, 0.0, 1.0).mean())


def _spread(count: int, dimensions: int) -> Floats:
    """Points that fill a unit cube evenly, shape (count, dimensions) (Kronecker sequence of the generalised golden ratio)."""
    ratio = 2.0
    for _ in range(30):
        ratio = (1.0 + ratio) ** (1.0 / (dimensions + 1))
    powers = ratio ** -np.arange(1.0, dimensions + 1)
    points: Floats = (0.5 + np.outer(np.arange(1, count + 1), powers)) % 1.0
    return points
