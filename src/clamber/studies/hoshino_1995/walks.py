"""Sections 3.2 and 7: walks in every direction, turns about any point, and steps of different levels, in contact dynamics."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from ...families.walker.pictures.walk_plots import draw_paths
from ...families.walker.robot import TwoFrames
from ...families.walker.robot.turning import turning_range
from ...families.walker.robot.workspace import stride
from ...families.walker.trials.max_setting import Most, Tried, find_most
from ...families.walker.trials.run_walk import WalkRun
from ...units import DEGREE
from ...viewing.pictures import draw_run
from ..result import Cells, Compared, Figure, StudyResult, Table, Value, Verdict
from . import SIMULATED
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
    rows: tuple[Cells, ...] = tuple(
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
    return StudyResult(
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
        figures=(
            Figure(
                "paths",
                "Ways of the Delta-frame's origin from above, as they truly were.",
                lambda path: draw_paths({f"{direction} deg": run for direction, run in runs.items()}, {}, path),
            ),
        ),
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
    rows: tuple[Cells, ...] = tuple(
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

    names = {centre: f"about {centre[0]:g}, {centre[1]:g} m" for centre in runs}
    return StudyResult(
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
            Figure(
                "paths",
                "Ways of the Delta-frame's origin from above, as they truly were, and the points.",
                lambda path: draw_paths(
                    {names[centre]: run for centre, run in runs.items()}, {names[c]: c for c in runs}, path
                ),
            ),
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


LEVELS: Final = ((0.6, 15.0), (1.1, 45.0), (1.6, 0.0))
"""Where the ground changes its height [m], and to what [mm]: steps of 15 and 30 mm up, and one of 45 mm down."""
STEPS_DISTANCE: Final = 2.6
"""Of the walk over them; both frames end behind the last [m]."""
SEEDS: Final = range(3)
SINGLE: Final = tuple(range(20, 141, 20))
"""Heights of a single step up that are tried, by bisection [mm]."""
AHEAD: Final = 1.4
"""Of the walk over a single step at 0.6 m [m]."""


def judge_steps(walks: Sequence[Tried]) -> Verdict:
    """The verdict: every walk passed all steps in balance, or not."""
    return "holds" if walks and all(walk.borne for walk in walks) else "differs"


def pass_steps() -> StudyResult:
    """A walk over three steps of different heights with some seeds, and the highest single step."""
    runs = {seed: _step_walk(LEVELS, STEPS_DISTANCE, seed) for seed in SEEDS}
    walks = {seed: Tried.of(f"seed {seed}", run) for seed, run in runs.items()}
    most = find_most(
        [f"{height} mm" for height in SINGLE],
        lambda value: Tried.of(value, _step_walk(((0.6, float(value.split()[0])),), AHEAD, 0)),
    )
    rows: list[Cells] = [
        (*_row(walk), runs[seed].report.kicks, len(runs[seed].report.steps)) for seed, walk in walks.items()
    ]
    rows += [(*_row(tried), None, None) for tried in most.tried]
    shown = runs[SEEDS[0]]
    return StudyResult(
        claim="Section 7: the robot has a high performance of passing over obstacles with steps of different levels.",
        verdict=judge_steps(list(walks.values())),
        compared=(
            Compared(
                f"walks over steps of 15, 30 and 45 mm that came to their end in balance, of {len(walks)}",
                sum(walk.borne for walk in walks.values()),
            ),
            Compared("least margin of balance on the way [mm]", min(_mm(walk.margin) for walk in walks.values())),
            Compared("largest tilt of the plate on the way [deg]", max(walk.tilt for walk in walks.values()) / DEGREE),
            Compared("highest single step passed, of those tried [mm]", _value(most, passed=True)),
            Compared("lowest not passed [mm]", _value(most, passed=False)),
            Compared("lift of the feet [mm]", hoshino().legs.lift * MM),
        ),
        deviations=(
            "The paper prints no sizes of the steps. Ours are 15 and 30 mm up and 45 mm down, as walls, half a metre apart; the robot is "
            f"told nothing of them. Holds if the walk comes to its end with its centre of mass inside the feet with {len(SEEDS)} seeds; "
            "the rule was fixed before the walks were made. The highest single step is shown beside it and decides nothing.",
            "Noise is as usual but for the inclinometers' offset, which is known.",
            SIMULATED,
        ),
        seeds=SEEDS,
        table=Table(
            ("walk", "passed in balance", "least margin [mm]", "largest tilt [deg]", "why not", "kicks", "slides"),
            tuple(rows),
        ),
        figures=(
            Figure(
                "course",
                "The walk over steps of 15, 30 and 45 mm, from the side and from above.",
                lambda path: draw_run(shown, path),
            ),
        ),
    )


def _step_walk(levels: Sequence[tuple[float, float]], distance: float, seed: int) -> WalkRun:
    ends = (*(at for at, _ in levels[1:]), 10.0)
    blocks = ", ".join(
        f'{{ x_min = "{at} m", x_max = "{end} m", y_min = "-10 m", y_max = "10 m", height = "{height} mm" }}'
        for (at, height), end in zip(levels, ends, strict=True)
    )
    title = f"Over steps, the ground then {', '.join(f'{height:g} mm' for _, height in levels)} high"
    changes = (f"ground.blocks=[{blocks}]", f"way.0.distance={distance}m", f"title={title}")
    return run_changed("step-walk", changes, known_noise(), seed)


def _row(tried: Tried) -> Cells:
    margin = None if tried.margin is None else tried.margin * MM
    return tried.value, "yes" if tried.borne else "no", margin, tried.tilt / DEGREE, tried.reason


def _mm(margin: float | None) -> float:
    return -np.inf if margin is None else margin * MM


def _value(most: Most, *, passed: bool) -> Value:
    one = most.borne if passed else most.refused
    return "none" if one is None else one.value.split()[0]
