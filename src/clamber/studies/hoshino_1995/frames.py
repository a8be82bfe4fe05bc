"""Figures 4 and 5: where the frames can be to each other, and the widest ditch by their angle and the direction of crossing."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from ...families.walker.pictures.mechanism_plots import (
    draw_areas,
    draw_crossing,
    draw_ditch_curves,
    draw_ditch_maps,
    draw_regions,
)
from ...families.walker.robot import TwoFrames
from ...families.walker.robot.ditch import Footing, ditch_map
from ...families.walker.robot.ditch_plan import Crossing, cross_ditch
from ...families.walker.robot.turning import turning_range
from ...families.walker.robot.workspace import best_directions, workspace
from ...types import Floats
from ...units import DEGREE
from ..result import Cells, Compared, Figure, StudyResult, Table
from . import CALIBRATED, SIGNS
from .walker import ANGLES, CM2, MM, hoshino

SHOWN: Final = (-15, -10, 0, 10, 20, 30, 40, 46)
"""Angles of the panels and of the table [deg]."""


def draw_figure_4() -> StudyResult:
    """Regions by strokes alone, without singular poses, and with the guard of the robot's file."""
    frames = TwoFrames.of(hoshino().mechanism)
    curve = np.array([_areas(frames, theta) for theta in ANGLES])
    return StudyResult(
        claim="Figure 4, section 3.1: the larger the angle between the frames, the larger the range of their relative position; only the "
        "strokes of 0 to 250 mm limit it.",
        verdict="holds" if bool((np.diff(curve[:, 0]) > 0.0).all()) else "differs",
        compared=_compare(frames, curve),
        deviations=_deviations(frames, curve),
        table=_table(frames),
        figures=_pictures_of_regions(frames, curve),
    )


def _areas(frames: TwoFrames, theta: float) -> tuple[float, float, float, float]:
    """Of all parts and of the part around the centre by strokes, of the latter short of a singular pose and within the guard [cm^2]."""
    space = workspace(frames, theta * DEGREE)
    free, guarded = (workspace(frames, theta * DEGREE, guard=guard).central for guard in (1.0, frames.guard))
    parts = (space.central, free, guarded)
    return space.area * CM2, *(0.0 if part is None else part.area * CM2 for part in parts)  # type: ignore[return-value]


def _guard(frames: TwoFrames) -> str:
    return f"within {frames.guard:g} of the singular distance"


def _compare(frames: TwoFrames, curve: Floats) -> tuple[Compared, ...]:
    fine = (0.01 * k for k in range(3000, 4800))
    apart = next((theta for theta in fine if len(workspace(frames, theta * DEGREE).parts) > 1), None)
    peak, turn, at = int(np.argmax(curve[:, 3])), turning_range(frames, (0.0, 0.0, 0.0)), ANGLES.index
    guard = _guard(frames)
    return (
        *(Compared(f"area by strokes alone, theta = {theta} deg [cm^2]", curve[at(theta), 0]) for theta in SHOWN),
        *(Compared(f"area {guard}, theta = {theta} deg [cm^2]", curve[at(theta), 3]) for theta in SHOWN),
        Compared("angle of the largest guarded area [deg]", ANGLES[peak]),
        Compared("largest guarded area [cm^2]", curve[peak, 3]),
        Compared("angle from which on the centre is cut off from most of the range [deg]", apart),
        Compared("least angle [deg]", turn.least / DEGREE),
        Compared("largest angle [deg]", turn.most / DEGREE),
    )


def _deviations(frames: TwoFrames, curve: Floats) -> tuple[str, ...]:
    peak = ANGLES[int(np.argmax(curve[:, 3]))]
    return (
        "The figure's curves are not at hand, so the verdict is on what section 3.1 says of it, taken as it stands: strokes and nothing "
        "else.",
        f"What can be used grows only to {peak} deg. At |p| = rho, which shrinks as theta grows, the mechanism is singular: there the "
        "actuators cannot hold a push in one direction, and beyond it the frames are assembled the other way round. The paper leaves this "
        f"out. Kept {_guard(frames)}, the region shrinks again past {peak} deg, against the figure's growth.",
        "Beyond the angle named the strokes leave separate regions, and the frames with their origins on each other, as in a pivot, are "
        "in a small one.",
        CALIBRATED,
        SIGNS,
    )


def _table(frames: TwoFrames) -> Table:
    rows: list[Cells] = []
    for theta in SHOWN:
        steps = (best_directions(frames, theta * DEGREE, guard=guard)[1] * MM for guard in (None, frames.guard))
        parts = len(workspace(frames, theta * DEGREE).parts)
        rows.append((theta, *(round(one, 2) for one in _areas(frames, theta)), parts, *steps))
    titles = (
        "theta [deg]",
        "strokes [cm^2]",
        "around the centre [cm^2]",
        "short of singular [cm^2]",
        f"{_guard(frames)} [cm^2]",
        "parts",
        "longest step [mm]",
        "guarded [mm]",
    )
    return Table(titles, tuple(rows))


def _pictures_of_regions(frames: TwoFrames, curve: Floats) -> tuple[Figure, ...]:
    names = ("strokes alone", "part around the centre", "short of a singular pose", _guard(frames))
    places = "Places of the Y-frame's origin in the Delta-frame at eight angles; the dashed circle is singular."
    return (
        Figure("regions", places, lambda path: draw_regions(frames, SHOWN, path)),
        Figure(
            "areas",
            "Area of the region by the angle between the frames.",
            lambda path: draw_areas(ANGLES, dict(zip(names, curve.T, strict=True)), path),
        ),
    )


DIRECTIONS: Final = tuple(range(0, 361))
"""Of crossing, in the Delta-frame [deg]."""
WIDE: Final = 0.2
"""A ditch that takes a pivot [m]."""
BEFORE: Final = 0.35
"""Where its crossing starts: the frames' origins before the near edge [m]."""
SAME: Final = 1.0
"""Widths that differ by no more are the same, and vary where they differ by more [mm]."""
ZERO: Final = ANGLES.index(0)
MAPPED: Final = 121
"""Directions of the picture of maps, from 0."""
DRAWN: Final = (-10, 0, 10, 20, 30)
"""Angles of the frames in the picture of curves [deg]."""
DEVIATIONS: Final = (
    "The figure's curves are not at hand; the verdict is on what section 3.3 says of it: the width depends on both angles, repeats every "
    "60 deg to 1 mm, and a ditch too wide to cross ahead is crossed after a pivot.",
    "A ditch is crossed by partial steps: no foot that has landed is in it, its edges carry, and the centre of mass stays inside the "
    "feet of either frame. Widths are exact for these rules to 1e-10 m; how a frame is put down half-way over is where most of them come "
    "from.",
    "Straight means that both origins keep to one line along theta_w, as in the paper's straight walk. Sidesteps along the ditch let it "
    "cross wider ones at most angles. The paper does not say which it takes, nor whether its robot steps in parts.",
    "The feet are points at the radius of the joints (not printed, assumed), 60 % of the frames' 74 kg are at the Delta-frame's origin, "
    "the rest is at the Y-frame's, the arm's 6 kg are at rest as the robot's file says (all assumed), and poses keep within 0.9 of the "
    "singular distance. There balance never decides; without the guard it does, the map is then not quite periodic, and its widest is of "
    "theory only.",
    CALIBRATED,
    SIGNS,
)


@dataclass(frozen=True, slots=True, eq=False)
class Ditches:
    """Widest ditches [mm] by angle and direction, each of shape (angles, directions), and a wide one crossed."""

    straight: Floats
    aside: Floats
    """With sidesteps."""
    unguarded: Floats
    """With sidesteps, singular poses not kept away from."""
    crossing: Crossing

    @classmethod
    def found(cls) -> "Ditches":
        """Of the paper's robot."""
        footing = Footing.of(hoshino())
        thetas: Floats = np.array(ANGLES) * DEGREE
        directions: Floats = np.array(DIRECTIONS) * DEGREE
        return cls(
            ditch_map(footing, thetas, directions, aside=False) * MM,
            ditch_map(footing, thetas, directions) * MM,
            ditch_map(Footing.of(hoshino(), guard=0.0), thetas, directions) * MM,
            cross_ditch(footing, WIDE, before=BEFORE),
        )

    @property
    def changes(self) -> float:
        """Largest change of a width when the direction turns by 60 deg [mm]."""
        return max(
            float(abs(np.roll(one[:, :-1], 60, axis=1) - one[:, :-1]).max()) for one in (self.straight, self.aside)
        )

    @property
    def hold(self) -> bool:
        """Whether they are as section 3.3 says: periodic, not all alike, and wide ones crossed after a pivot within every limit."""
        least = min(one.least for one in self.crossing.replay())
        pivots = self.crossing.status == "found" and self.crossing.pivots > 0 and least >= -1e-9
        return self.changes <= SAME and float(np.ptp(self.straight[ZERO])) > SAME and pivots


def draw_figure_5() -> StudyResult:
    """The map of straight crossings and that with sidesteps, and a wide ditch crossed after a pivot."""
    ditches = Ditches.found()
    return StudyResult(
        claim="Figure 5, section 3.3: the widest ditch that the robot overcomes, lying across its way, depends on theta and on the walking "
        "direction theta_w, periodically in theta_w; before a wide one it has to pivot and change its walking direction.",
        verdict="holds" if ditches.hold else "differs",
        compared=(*_compare_widths(ditches), *_compare_crossing(ditches.crossing)),
        deviations=DEVIATIONS,
        table=Table(
            ("theta [deg], straight", *(f"theta_w = {k} [mm]" for k in range(0, 60, 10))),
            tuple(
                (theta, *(round(float(ditches.straight[ANGLES.index(theta), k]), 1) for k in range(0, 60, 10)))
                for theta in range(-15, 48, 5)
            ),
        ),
        figures=_figures(ditches),
    )


def _compare_widths(ditches: Ditches) -> tuple[Compared, ...]:
    straight, aside = ditches.straight, ditches.aside
    return (
        Compared("largest change when theta_w turns by 60 deg [mm]", ditches.changes),
        Compared("straight, theta = 0, theta_w = 0 [mm]", straight[ZERO, 0]),
        Compared("straight, theta = 0, theta_w = 30 deg [mm]", straight[ZERO, 30]),
        Compared("straight, theta = 0, least over theta_w [mm]", float(straight[ZERO].min())),
        Compared("straight, widest of all [mm]", _widest(straight)),
        Compared("with sidesteps, theta = 0, theta_w = 0 [mm]", aside[ZERO, 0]),
        Compared("with sidesteps, theta = 0, theta_w = 30 deg [mm]", aside[ZERO, 30]),
        Compared("with sidesteps, widest of all [mm]", _widest(aside)),
        Compared("with sidesteps and no guard against singular poses, widest of all [mm]", _widest(ditches.unguarded)),
    )


def _widest(widths: Floats) -> str:
    i, j = np.unravel_index(int(np.argmax(widths[:, :60])), (len(ANGLES), 60))
    return f"{widths[i, j]:.1f} at theta = {ANGLES[i]} deg, theta_w = {DIRECTIONS[j]} + 60 n deg"


def _compare_crossing(plan: Crossing) -> tuple[Compared, ...]:
    margins = plan.replay()
    return (
        Compared(f"a ditch of {WIDE * MM:g} mm ahead, theta = 0, theta_w = 0: pivots", plan.pivots),
        Compared("slides after them", len(plan.slides) - plan.pivots),
        Compared("angle of the frames in them [deg]", plan.theta / DEGREE),
        Compared("direction in them [deg]", plan.direction / DEGREE),
        Compared("widest ditch so [mm]", plan.widest * MM),
        Compared("least margin of stroke, all slides [mm]", min(one.stroke for one in margins) * MM),
        Compared("least margin of balance, all slides [mm]", min(one.balance for one in margins) * MM),
        Compared("least margin of feet from the ditch, all slides [mm]", min(one.foothold for one in margins) * MM),
    )


def _figures(ditches: Ditches) -> tuple[Figure, ...]:
    shown = {"straight": ditches.straight[:, :MAPPED], "with sidesteps": ditches.aside[:, :MAPPED]}
    return (
        Figure(
            "maps",
            "Widest ditch [mm] by the angle of the frames and the direction of crossing.",
            lambda path: draw_ditch_maps(ANGLES, DIRECTIONS[:MAPPED], shown, path),
        ),
        Figure(
            "curves",
            "Widest ditch crossed straight, by direction, at five angles of the frames.",
            lambda path: draw_ditch_curves(
                DIRECTIONS, {theta: ditches.straight[ANGLES.index(theta)] for theta in DRAWN}, path
            ),
        ),
        Figure(
            "crossing",
            "A ditch of 200 mm crossed after a pivot; every picture is the stance after a slide.",
            lambda path: draw_crossing(ditches.crossing, path),
        ),
    )
