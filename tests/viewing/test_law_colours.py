"""Every law has a colour of its own, and every matching a line."""

from itertools import combinations

import numpy as np
import pytest

from clamber.control.law_settings import LAWS
from clamber.limb_bench.entries import MATCHES
from clamber.types import Floats
from clamber.viewing.style import LAW_COLOURS, MATCH_LINES, OUTSIDE

SEEN = {
    "all": np.eye(3),
    "no green cones": np.array([[0.367, 0.861, -0.228], [0.280, 0.673, 0.047], [-0.012, 0.043, 0.969]]),
    "no red cones": np.array([[0.152, 1.053, -0.205], [0.115, 0.786, 0.099], [-0.004, -0.048, 1.052]]),
}
"""Linear RGB as it is seen (Machado, Oliveira, Fernandes, IEEE TVCG 15, 2009, severity 1)."""
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
"""Of linear sRGB (IEC 61966-2-1)."""


def lab(colour: str, seen: Floats) -> Floats:
    """CIELAB of a colour as it is seen."""
    srgb = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    x, y, z = np.cbrt(XYZ @ np.clip(seen @ linear, 0.0, 1.0) / (0.9505, 1.0, 1.089))
    return np.array((116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)))


@pytest.mark.parametrize(("who", "apart"), [("all", 30.0), ("no green cones", 8.0), ("no red cones", 8.0)])
def test_no_two_laws_have_nearly_one_colour(who: str, apart: float) -> None:
    # a difference of about 2 is the least that is seen side by side
    colours = {name: lab(colour, SEEN[who]) for name, colour in (LAW_COLOURS | {"another package's": OUTSIDE}).items()}
    near = {(a, b): float(np.linalg.norm(colours[a] - colours[b])) for a, b in combinations(colours, 2)}
    assert {pair: round(distance) for pair, distance in near.items() if distance < apart} == {}


def test_every_law_has_a_colour_of_its_own() -> None:
    assert set(LAW_COLOURS) == set(LAWS)
    assert len(set(LAW_COLOURS.values())) == len(LAWS)


def test_every_matching_has_a_line_of_its_own() -> None:
    assert set(MATCH_LINES) == set(MATCHES)
    assert len(set(map(str, MATCH_LINES.values()))) == len(MATCHES)
