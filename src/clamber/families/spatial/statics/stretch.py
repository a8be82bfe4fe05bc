"""How far limbs are stretched: where a knee is all but straight, a millimetre decides to which side it gives way."""

import math
from functools import lru_cache
from typing import Final

import numpy as np

from ....types import Floats
from ..robot.chains import Chains

POSTURES: Final = np.array((0.13, 0.38, 0.62, 0.87))
"""From which a limb is stretched, and in which it must not be stretched already, of all its joints' turns [-]."""
SWEEPS: Final = 40
"""Over a limb's joints, each of which is put where it stretches the limb most, the others as they are."""
NEAR: Final = 1e-12
"""Share of a length by which a sweep lengthens it at least, or it was the last [-]."""
MOST: Final = 2.0 / 3.0
"""Of a limb's full length lies behind a joint at least whose distance from the tip counts [-]: wrists may be straight."""


def stretched(chains: Chains, limb: int) -> float:
    """Length of a limb from its first joint to its tip when no joint bends it, slides run out [m]; no more is in reach."""
    n = int(chains.n_joints[limb])
    lengths = float(np.linalg.norm(chains.offset[limb, 1 : n + 1], axis=1).sum())
    slides = chains.sliding[limb, :n] * np.maximum(abs(chains.lower[limb, :n]), abs(chains.upper[limb, :n]))
    return lengths + float(slides.sum())


def farthest_tips(chains: Chains, limb: int) -> Floats:
    """Largest distance of a limb's tip from each of its joints that a stance may ask for [m], shape (joints,).

    It is `chains.stretch` of the largest that there is, were its hinges free to turn. Infinite for joints behind which less than `MOST` of
    the limb lies, for those behind which nothing bends, and where a slide makes the limb longer, which is not stretched before its end.
    """
    n = int(chains.n_joints[limb])
    if chains.stretch >= 1.0 or chains.sliding[limb, :n].any():
        return np.full(n, np.inf)
    links = chains.offset[limb, 1 : n + 1].tobytes(), chains.rotation[limb, 1 : n + 1].tobytes()
    return np.array(_farthest(chains.stretch, *links))


@lru_cache(maxsize=64)
def _farthest(stretch: float, offset: bytes, rotation: bytes) -> tuple[float, ...]:
    """Those distances of a limb, from its frames' origins and axes behind the first: worked out once, however many tasks it has."""
    links = np.frombuffer(offset).reshape(-1, 3), np.frombuffer(rotation).reshape(-1, 3, 3)
    n = len(links[0])
    allowed = [math.inf] * n
    whole = 0.0
    for k in range(n - 1):
        bent, straight = np.array([_stretch(links, k, turn) for turn in 2.0 * np.pi * POSTURES]).T
        longest = float(straight.max())
        whole = max(whole, longest)
        if longest > MOST * whole and bent.min() < stretch * longest:
            allowed[k] = stretch * longest
    return tuple(allowed)


def _stretch(links: tuple[Floats, Floats], first: int, turn: float) -> tuple[float, float]:
    """Distances of a limb's tip from a joint [m]: with all joints turned alike, and the largest that turning one after the other gives."""
    n = len(links[0])
    q = np.full(n, turn)
    bent = length = float(np.linalg.norm(_places(links, first, q)[0][-1]))
    for _ in range(SWEEPS):
        for k in range(first + 1, n):
            places, axes = _places(links, first, q)
            axis, to, back = axes[k - first], places[-1] - places[k - first], -places[k - first]
            # seen along the axis, the tip is to lie opposite the first joint
            to, back = to - (to @ axis) * axis, back - (back @ axis) * axis
            q[k] += np.arctan2(-(np.cross(to, back) @ axis), -(to @ back))
        longer = float(np.linalg.norm(_places(links, first, q)[0][-1]))
        if longer <= length * (1.0 + NEAR):
            break
        length = longer
    return bent, length


def _places(links: tuple[Floats, Floats], first: int, q: Floats) -> tuple[Floats, Floats]:
    """Origins of a limb's frames from a joint on and of its tip [m], and the joints' axes, all in that joint's frame."""
    offset, rotation = links
    place, turn = np.zeros(3), np.eye(3)
    places, axes = [place], [turn[:, 2]]
    for k in range(first + 1, len(q) + 1):
        place, turn = place + turn @ offset[k - 1], turn @ rotation[k - 1]
        places.append(place)
        axes.append(turn[:, 2])
        if k < len(q):
            c, s = np.cos(q[k]), np.sin(q[k])
            turn = turn @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return np.array(places), np.array(axes)
