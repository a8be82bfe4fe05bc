"""Sections 3.2 and 7: walks in every direction and turns about any point, on level ground in contact dynamics."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from ...families.walker.robot import TwoFrames
from ...families.walker.robot.turning import turning_range
from ...families.walker.robot.workspace import stride
from ...families.walker.trials.run_walk import WalkRun
from ...units import DEGREE
from ..result import Compared, Figure, StudyResult, Table, Value, Verdict
from . import PAPER, SIMULATED
from .walker import MM, hoshino, known_noise, run_changed

DIRECTIONS: Final = tuple(range(0, 360, 30))
"""Of the walks [deg]."""
DISTANCE: Final = 0.5
"""Of each of them [m]."""
CENTRES: Final = ((0.0, 0.0), (0.25, 0.0), (0.0, 0.5), (-0.5, 0.0), (0.0, -1.0), (0.7, 0.7))
"""Points that are turned about, in the Delta-frame at the start [m]."""
TURN: Final = 45.0
"""About each, one way and the other by turns [deg]."""
STRAYS: Final = 1.0
"""Of direction, heading and turn that is still as asked for [deg]."""
CENTRE_KEPT: Final = 0.01
"""So far may the point that is turned about have moved [m]."""
NOISE: Final = (
    "Noise is as usual but for the inclinometers' offset, which is known: on level ground it decides nothing here."
)


@dataclass(frozen=True, slots=True)
class Strayed:
    """What became of a walk in the plane, as it truly was."""

    done: bool
    direction: float
    """Of the walk from that asked for [deg]; 0 for a turn."""
    turned: float
    """Heading at the end from that asked for [deg]."""
    centre: float
    """How far the point that is turned about has moved [m]; 0 for a straight walk."""
    steps: int


def judge_strayed(walks: Sequence[Strayed]) -> Verdict:
    """The verdict: every walk came to its end and went where it was asked to go, or not."""
    kept = all(
        walk.done and abs(walk.direction) <= STRAYS and abs(walk.turned) <= STRAYS and walk.centre <= CENTRE_KEPT
        for walk in walks
    )
    return "holds" if kept and walks else "differs"


def walk_everywhere(directions: tuple[int, ...] = DIRECTIONS) -> StudyResult:
    """Half a metre in each of twelve directions [deg], the heading kept."""
    runs = {
        direction: _walk(f'[{{ direction = "{direction} deg", distance = "{DISTANCE} m" }}]', direction)
        for direction in directions
    }
    walks = {direction: strayed(run, direction * DEGREE, 0.0, None) for direction, run in runs.items()}
    frames = TwoFrames.of(hoshino().mechanism)
    rows: tuple[tuple[Value, ...], ...] = tuple(
        (
            direction,
            stride(frames, 0.0, direction * DEGREE).length * MM,
            "yes" if walk.done else runs[direction].reason,
            walk.steps,
            walk.direction,
            walk.turned,
            runs[direction].report.seconds,
        )
        for direction, walk in walks.items()
    )

    def paths(path: Path) -> None:
        from ...families.walker.pictures.walk_plots import draw_paths

        draw_paths({f"{direction} deg": run for direction, run in runs.items()}, {}, path)

    return StudyResult(
        paper=PAPER,
        result="walk-directions",
        claim="Sections 2, 3 and 7: the robot can walk in all directions.",
        verdict=judge_strayed(list(walks.values())),
        compared=(
            Compared(
                f"walks of {DISTANCE:g} m that came to their end, of {len(walks)}",
                sum(walk.done for walk in walks.values()),
                "all",
            ),
            Compared(
                "true direction from that asked for, most [deg]", max(abs(walk.direction) for walk in walks.values())
            ),
            Compared(
                "heading at the end from that at the start, most [deg]",
                max(abs(walk.turned) for walk in walks.values()),
            ),
        ),
        deviations=(
            f"The paper prints no directions, distances or accuracy. Twelve directions, {DISTANCE:g} m each, are ours. Holds if every walk "
            f"comes to its end, its true direction and heading within {STRAYS:g} deg of those asked for; the rule was fixed before the "
            "walks were made.",
            f"{NOISE} The seed of a walk is its direction in degrees.",
            SIMULATED,
        ),
        seeds=range(min(directions), max(directions) + 1, 30),
        table=Table(
            (
                "direction [deg]",
                "longest step [mm]",
                "came to its end",
                "slides",
                "direction off [deg]",
                "heading off [deg]",
                "time [s]",
            ),
            rows,
        ),
        figures=(Figure("paths", "Ways of the Delta-frame's origin from above, as they truly were.", paths),),
    )


def turn_anywhere(centres: tuple[tuple[float, float], ...] = CENTRES) -> StudyResult:
    """A turn on the spot and about points before, beside and behind the robot [m]."""
    runs: dict[tuple[float, float], WalkRun] = {}
    walks: dict[tuple[float, float], Strayed] = {}
    for k, (x, y) in enumerate(centres):
        turn = TURN if k % 2 == 0 else -TURN
        runs[x, y] = _walk(f'[{{ turn = "{turn} deg", about = ["{x} m", "{y} m"] }}]', k)
        walks[x, y] = strayed(runs[x, y], None, turn * DEGREE, (x, y))
    frames, guard = TwoFrames.of(hoshino().mechanism), hoshino().mechanism.guard
    spans = {
        centre: turning_range(frames, (0.0, 0.0, 0.0), about=centre, guard=guard).span / DEGREE for centre in centres
    }
    rows: tuple[tuple[Value, ...], ...] = tuple(
        (
            f"{x:g}, {y:g}",
            spans[x, y],
            "yes" if walk.done else runs[x, y].reason,
            walk.steps,
            walk.turned,
            walk.centre * MM,
            runs[x, y].report.seconds,
        )
        for (x, y), walk in walks.items()
    )

    def paths(path: Path) -> None:
        from ...families.walker.pictures.walk_plots import draw_paths

        names = {centre: f"about {centre[0]:g}, {centre[1]:g} m" for centre in runs}
        draw_paths({names[centre]: run for centre, run in runs.items()}, {names[c]: c for c in runs}, path)

    return StudyResult(
        paper=PAPER,
        result="turn-about-points",
        claim="Section 3.2: the robot can turn about an arbitrary point; on the spot the radius is smallest. Section 7: rotational walking "
        "was performed.",
        verdict=judge_strayed(list(walks.values())),
        compared=(
            Compared(
                f"turns by {TURN:g} deg that came to their end, of {len(walks)}",
                sum(walk.done for walk in walks.values()),
                "all",
            ),
            Compared("angle turned from that asked for, most [deg]", max(abs(walk.turned) for walk in walks.values())),
            Compared("the point turned about has moved, most [mm]", max(walk.centre for walk in walks.values()) * MM),
            *(
                Compared(f"from end to end of a turn about {x:g}, {y:g} m, one slide [deg]", span)
                for (x, y), span in spans.items()
            ),
        ),
        deviations=(
            f"The paper prints no points and no accuracy. Six points and turns of {TURN:g} deg, one way and the other by turns, are ours. "
            f"Holds if every turn comes to its end within {STRAYS:g} deg of the angle asked for, the point itself within "
            f"{CENTRE_KEPT * MM:g} mm of where it was; the rule was fixed before the turns were made.",
            f"{NOISE} The seed of a turn is its place in the table, from 0.",
            SIMULATED,
        ),
        seeds=range(len(centres)),
        table=Table(
            (
                "point [m]",
                "one slide, from end to end [deg]",
                "came to its end",
                "slides",
                "turn off [deg]",
                "point moved [mm]",
                "time [s]",
            ),
            rows,
        ),
        figures=(
            Figure("paths", "Ways of the Delta-frame's origin from above, as they truly were, and the points.", paths),
        ),
    )


def strayed(run: WalkRun, direction: float | None, turn: float, about: tuple[float, float] | None) -> Strayed:
    """A walk against what was asked of it.

    Args:
        run: What became of it.
        direction: That it was to go, from its heading [rad]; None: nowhere, it was to turn.
        turn: Of the heading that was asked for [rad].
        about: The point that it was to turn about, in the Delta-frame at the start [m]; None: none.
    """
    poses = run.true.pose[run.walking][:, [0, 1, 3]]
    if not len(poses):
        return Strayed(run.done, math.inf, math.inf, math.inf, 0)
    (x, y, heading), (to_x, to_y, to_heading) = poses[0], poses[-1]
    went = 0.0
    if direction is not None:
        went = math.remainder(math.atan2(to_y - y, to_x - x) - heading - direction, math.tau) / DEGREE
    turned = math.remainder(to_heading - heading - turn, math.tau) / DEGREE
    moved = 0.0
    if about is not None:
        before, after = (
            complex(one[0], one[1]) + complex(*about) * np.exp(1j * one[2]) for one in (poses[0], poses[-1])
        )
        moved = abs(after - before)
    return Strayed(run.done, went, turned, moved, len(run.report.steps))


def _walk(way: str, seed: int) -> WalkRun:
    return run_changed("level-walk", (f"way={way}",), known_noise(), seed)
