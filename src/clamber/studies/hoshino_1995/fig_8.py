"""Figure 8 of section 5 (9 by its caption): the walk on a slope of 10 deg with the upper surface kept level."""

from pathlib import Path
from typing import Final

import numpy as np

from ...families.walker.execution.walk_trace import PHASES
from ...families.walker.trials.noise import WalkNoise, named_walk_noise
from ...families.walker.trials.run_walk import WalkRun
from ...types import Floats
from ...units import DEGREE
from ..result import Compared, Figure, StudyResult, Table, Value
from . import CAPTIONS, SIMULATED
from .walker import MM, known_noise, run_changed

WAYS: Final = {"up": 0.0, "across": 90.0, "down": 180.0}
"""Name -> direction of the steepest ascent, from the robot's heading [deg]."""
DISTANCE: Final = "1 m"
LEVEL: Final = 0.1
"""Within which the plate counts as level [deg]: what section 4.2 prints."""
SLOPE: Final = 10.0
"""[deg]; printed."""
SETTLE: Final = PHASES.index("settle")


def walk_level() -> StudyResult:
    """Up, across and down with everything as noisy as usual; and the same walks with the plate left parallel to the slope."""
    level = {name: _walk(uphill, named_walk_noise("usual")) for name, uphill in WAYS.items()}
    known = known_noise()
    tilted = {name: _walk(uphill, known, "level=false", "start.plate=ground") for name, uphill in WAYS.items()}
    ends = all(run.done for run in level.values())
    rests = max(_at_rest(run) for run in level.values())
    rows: list[tuple[Value, ...]] = [
        (name, "level" if kept is level else "as the slope", *_row(run))
        for kept in (level, tilted)
        for name, run in kept.items()
    ]

    def courses(path: Path) -> None:
        from ...families.walker.pictures.walk_plots import draw_levelling

        draw_levelling(level, tilted, within=LEVEL, path=path)

    return StudyResult(
        claim="Figure 8, section 5: a walk on a slope of 10 deg while the upper surface is kept level; on the whole it could be.",
        verdict="holds" if ends and rests <= LEVEL else "differs",
        compared=(
            Compared("slope [deg]", SLOPE, SLOPE),
            *(Compared(f"{name}: came to its end", _yes(run.done)) for name, run in level.items()),
            *(Compared(f"{name}: largest tilt at rest on six feet [deg]", _at_rest(run)) for name, run in level.items()),
            *(Compared(f"{name}: largest tilt in any phase [deg]", run.tilt / DEGREE) for name, run in level.items()),
            *(Compared(f"{name}: least margin of balance [mm]", _margin(run)) for name, run in level.items()),
            *(Compared(f"{name}, not levelled: came to its end", _yes(run.done)) for name, run in tilted.items()),
            *(Compared(f"{name}, not levelled: least margin of balance [mm]", _margin(run)) for name, run in tilted.items()),
        ),
        deviations=(
            CAPTIONS,
            f"The paper prints the slope and no other number. The verdict is on walks of {DISTANCE} up, across and down that come to their "
            f"end, with the plate within {LEVEL:g} deg of level at rest between the steps, the number that section 4.2 prints; every "
            "phase is told besides.",
            "Noise as `clamber trials` has it, one seed; docs/walks.md has many. The robot calibrates its inclinometers before it walks; "
            "without levelling it has no use for them, and their offsets are 0.",
            "Section 4.1 says that the posture has to be controlled on rough ground, and shows no walk without. Ours leaves the plate "
            "parallel to the slope: the centre of mass, some 0.4 m above the feet, is 70 mm downhill of where it is on level ground.",
            SIMULATED,
        ),
        table=Table(
            ("way", "plate", "ended", "largest tilt [deg]", "at rest [deg]", "least margin [mm]", "steps", "time [s]", "why it ended"),
            tuple(rows),
        ),
        figures=(
            Figure("courses", "Tilt and margin of balance along the way, level; the margin if the plate lies as the slope.", courses),
        ),
    )  # fmt: skip


def _walk(uphill: float, noise: WalkNoise, *changes: str) -> WalkRun:
    return run_changed("slope-walk", (f"way.0.distance={DISTANCE}", f"ground.uphill={uphill}deg", *changes), noise)


def _at_rest(run: WalkRun) -> float:
    """Largest tilt of the plate at the end of a step, when it has settled on six feet [deg]; infinite without a step."""
    trace = run.trace
    last = np.flatnonzero((trace.phase == SETTLE) & (np.append(np.diff(trace.step), 1) != 0))
    tilts: Floats = trace.tilt()[last]
    return float(tilts.max(initial=0.0)) / DEGREE if len(last) else np.inf


def _margin(run: WalkRun) -> float | None:
    """Least margin of balance from the first step on, as long as three feet were on the ground [mm]; None where it made none."""
    margins = run.true.margins[run.walking]
    margins = margins[np.isfinite(margins)]
    return float(margins.min()) * MM if len(margins) else None


def _row(run: WalkRun) -> tuple[Value, ...]:
    rests = _at_rest(run)
    return (
        _yes(run.done), run.tilt / DEGREE, rests if np.isfinite(rests) else None, _margin(run), len(run.report.steps),
        run.report.seconds, run.reason,
    )  # fmt: skip


def _yes(done: bool) -> str:
    return "yes" if done else "no"
