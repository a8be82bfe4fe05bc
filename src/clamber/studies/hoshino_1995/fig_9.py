"""Figure 9 of section 4.2: the direction in which the upper surface is steepest, and the angle there."""

import math
from pathlib import Path
from typing import Final

import numpy as np

from ...families.walker.control.posture import slope_of, tilt_of
from ...types import Floats
from ...units import DEGREE
from ..result import Compared, Figure, StudyResult, Table, Value
from . import CAPTIONS

MOST: Final = 30.5
"""Of beta and gamma [deg]; half a degree off the axes, on which equation 6 divides by 0."""
APART: Final = 1.0
"""Tilts that are looked at [deg]."""
LOOKED_AT: Final = 720
"""Directions at which the surface's ascent is looked at, before the best is refined."""
SHOWN: Final = ((5.0, 0.0), (0.0, 5.0), (-5.0, 0.0), (5.0, 5.0), (-5.0, 5.0), (5.0, -5.0), (20.0, -10.0))
"""beta, gamma of the table [deg]."""


def compare_directions() -> StudyResult:
    """Closed forms against a search over directions on the plane of equation 3; equation 6 by its arctan against both."""
    tilts = np.arange(-MOST, MOST + 0.5 * APART, APART)
    found = np.array([[steepest(beta * DEGREE, gamma * DEGREE) for gamma in tilts] for beta in tilts])
    ours = np.array([[slope_of(beta * DEGREE, gamma * DEGREE) for gamma in tilts] for beta in tilts])
    printed = np.array([[equation_6(beta * DEGREE, gamma * DEGREE) for gamma in tilts] for beta in tilts])
    back = np.array([[tilt_of(eta, xi) for eta, xi in row] for row in ours]) - np.stack(
        np.meshgrid(tilts * DEGREE, tilts * DEGREE, indexing="ij"), axis=-1
    )
    direction_off = float(_between(ours[..., 0], found[..., 0]).max()) / DEGREE
    angle_off = float(np.abs(ours[..., 1] - found[..., 1]).max()) / DEGREE
    tangents = float(np.abs(np.sin(printed - found[..., 0])).max())
    downhill = _between(printed, found[..., 0])
    share = float((downhill > 0.5 * math.pi).mean())

    def directions(path: Path) -> None:
        from ...families.walker.pictures.walk_plots import draw_directions

        draw_directions(tilts, ours[..., 1] / DEGREE, ours[..., 0], printed, path)

    return StudyResult(
        claim="Figure 9, section 4.2, equations 3 to 7: the direction eta in which the upper surface inclines most has tan eta = "
        "-tan gamma / sin beta; eta and the angle xi there follow from beta and gamma, and the other way.",
        verdict="holds" if tangents < 1e-6 and direction_off < 1e-4 else "differs",
        compared=(
            Compared("equation 6: largest sine of its angle to the steepest line [-]", tangents),
            Compared("equation 6 by arctan: part of the tilts in which it points downhill [-]", share),
            Compared("closed form of eta, from a search over directions [deg]", direction_off),
            Compared("closed form of xi, from that search [deg]", angle_off),
            Compared("beta and gamma to eta and xi and back [deg]", float(np.abs(back).max()) / DEGREE),
        ),
        deviations=(
            CAPTIONS,
            "Equation 6 is right as a tangent: it gives the steepest line, not which way is up. By arctan alone it points downhill "
            "wherever beta is positive, and says nothing where beta is 0. Ours keeps the quadrant: eta = atan2(tan gamma / cos beta, "
            "-tan beta).",
            "What is legible of equation 5, tan gamma / cos beta cos eta + tan beta sin eta = 0, is the derivative of the ascent and "
            "leads to equation 6. Equations 4 and 7 are missing from the text at hand; cos xi = cos beta cos gamma, beta = -atan(tan xi "
            "cos eta) and gamma = atan(tan xi sin eta cos beta) are derived from equation 3.",
            "The text says that beta turns about the axis X_f. In the matrix of equation 8, and with equation 3, beta turns about y and "
            "gamma about x.",
        ),
        table=Table(
            ("beta [deg]", "gamma [deg]", "eta [deg]", "xi [deg]", "eta by equation 6 [deg]"),
            tuple(_row(beta, gamma) for beta, gamma in SHOWN),
        ),
        figures=(
            Figure(
                "directions",
                "Which way is up in the plate, its x to the right and y up, by its tilt: truly, and by the arctan of equation 6.",
                directions,
            ),
        ),
    )  # fmt: skip


def steepest(beta: float, gamma: float) -> tuple[float, float]:
    """Direction and angle of the steepest ascent of the plane of equation 3, by a search that knows nothing of equations 4 to 7 [rad]."""

    def ascent(eta: Floats) -> Floats:
        x, y = np.cos(eta), np.sin(eta)
        z: Floats = -(math.sin(beta) * math.cos(gamma) * x - math.sin(gamma) * y) / (math.cos(beta) * math.cos(gamma))
        return z

    step = math.tau / LOOKED_AT
    etas: Floats = step * np.arange(LOOKED_AT, dtype=np.float64)
    best = float(etas[int(np.argmax(ascent(etas)))])
    while step > 1e-9:
        etas = np.linspace(best - step, best + step, 41)
        best = float(etas[int(np.argmax(ascent(etas)))])
        step /= 10.0
    return best, math.atan(float(ascent(np.full(1, best))[0]))


def equation_6(beta: float, gamma: float) -> float:
    """The direction as it is printed, its arctan between -90 and 90 deg [rad]."""
    return math.atan(-math.tan(gamma) / math.sin(beta))


def _between(a: Floats, b: Floats) -> Floats:
    """Angles between directions [rad]."""
    off: Floats = np.abs(np.remainder(a - b + math.pi, math.tau) - math.pi)
    return off


def _row(beta: float, gamma: float) -> tuple[Value, ...]:
    eta, xi = slope_of(beta * DEGREE, gamma * DEGREE)
    printed = None if beta == 0.0 else round(equation_6(beta * DEGREE, gamma * DEGREE) / DEGREE, 4)
    return beta, gamma, round(eta / DEGREE, 4), round(xi / DEGREE, 4), printed
