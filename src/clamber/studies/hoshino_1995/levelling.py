"""Figures 7 to 9: the plate inclined by its legs, kept level on a walk up a slope, and the direction in which it is steepest."""

import math
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from ...families.walker.control.gait import Y
from ...families.walker.control.posture import inclines_of_tilt, slope_of, tilt_of
from ...families.walker.execution import motions
from ...families.walker.execution.walk_trace import PHASES, TracedWalker, WalkTrace
from ...families.walker.pictures.walk_plots import Tilts, draw_directions, draw_inclining, draw_levelling
from ...families.walker.planning import load_walk
from ...families.walker.sim.walker_flaws import Inclinometers, WalkerFlaws
from ...families.walker.sim.walker_plant import WalkerSim
from ...families.walker.trials.noise import WalkNoise
from ...families.walker.trials.run_walk import WalkRun
from ...types import Floats
from ...units import DEGREE
from ..result import Cells, Compared, Figure, StudyResult, Table
from . import CAPTIONS, SIMULATED
from .walker import MM, hoshino, known_noise, run_changed

ANGLE: Final = 5.0
"""From level [deg]; the paper prints none."""
DIRECTIONS: Final = (0, 45, 90, 135, 180, 225, 270, 315)
"""Of the steepest ascent, from the plate's heading, one after another [deg]; then back to level."""
RESTS: Final = 8.0
"""For which the robot stands after each motion [s] ..."""
READ: Final = 4.0
"""... of which the inclinometers' readings are averaged over the last [s]: of readings 0.2 s apart, which their filter makes alike, 1 s
would leave 0.03 deg along each axis, a third of what is to be shown, and 4 s leave half of that."""
NOISE: Final = 0.05 * DEGREE
"""Of a reading [rad]."""
MOVES: Final = 0.005
"""A leg that goes farther in a motion than this counts [m]: motors make steps of 0.1 mm."""
ARRIVED: Final = 1e-5
"""Legs that have less left to go are where they are to be [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Inclining:
    """What happened, motion by motion."""

    trace: WalkTrace
    """Every tick."""
    wanted: Floats
    """Inclines that are wanted at each row, shape (rows, 2) [rad]."""
    begins: Floats
    """When each motion begins [s], shape (motions,)."""
    arrives: Floats
    """When its legs are where they are to be [s]."""
    ends: Floats
    """When the rest after it is over [s]."""

    def true_inclines(self) -> Floats:
        """How far the plate's axes truly rise, shape (rows, 2) [rad]."""
        assert self.trace.true_pose is not None, "the plant is simulated"
        return np.array([inclines_of_tilt(beta, gamma) for beta, gamma in self.trace.true_pose[:, 4:]])

    def read_errors(self) -> Floats:
        """Inclinometers from what is wanted, averaged over the end of each rest, shape (motions,) [rad]."""
        return self._at_ends(self.trace.inclines)

    def true_errors(self) -> Floats:
        """Likewise the plate itself."""
        return self._at_ends(self.true_inclines())

    def uneven(self) -> float:
        """Largest difference between legs in the share of their way that they have done half-way in time, of all motions [-]."""
        time, legs = self.trace.time, self.trace.commanded
        stands = self.trace.stands[0] > 0
        spreads = []
        for begin, arrive in zip(self.begins, self.arrives, strict=True):
            first, middle, last = np.searchsorted(time, (begin, 0.5 * (begin + arrive), arrive))
            way = (legs[last] - legs[first])[stands]
            far = np.abs(way) > MOVES
            spreads.append(float(np.ptp((legs[middle] - legs[first])[stands][far] / way[far])))
        return max(spreads)

    def _at_ends(self, inclines: Floats) -> Floats:
        time, off = self.trace.time, inclines - self.wanted
        means = [off[(time > end - READ) & (time <= end)].mean(axis=0) for end in self.ends]
        errors: Floats = np.hypot(*np.transpose(means))
        return errors


def incline(legs: Literal[3, 6], *, corrected: bool = True) -> Inclining:
    """Tilt the plate to each of `DIRECTIONS` and back to level.

    Args:
        legs: How many stand: those of the Delta-frame, or all.
        corrected: Whether the inclinometers' readings correct what the legs' lengths say.
    """
    walk = load_walk("level-walk")
    flaws = WalkerFlaws(inclinometers=Inclinometers(noise=NOISE), force_noise=2.0, seed=0)
    walker = TracedWalker(walk.robot, WalkerSim(walk.robot, walk.ground, flaws), every=1)
    walker.start(walk.start_pose(), walk.start_place(), walk.start_legs(), np.array(walk.arm))
    motions.find_ground(walker)
    motions.level(walker)
    if legs == 3:
        motions.lift(walker, Y, walker.frames()[Y])
    motions.settle(walker)
    walker.inclination.frozen = not corrected
    marks: list[tuple[float, float, float]] = []
    wants: list[tuple[float, float]] = []
    for direction, angle in (*((each, ANGLE) for each in DIRECTIONS), (0, 0.0)):
        begin = walker.time
        walker.wanted[1:] = tilt_of(direction * DEGREE, angle * DEGREE)
        wants.append(inclines_of_tilt(*walker.wanted[1:]))
        walker.tick()
        while walker.left > ARRIVED:
            walker.tick()
        arrive = walker.time
        walker.wait(RESTS)
        marks.append((begin, arrive, walker.time))
    trace = walker.trace()
    begins, arrives, ends = np.transpose(marks)
    turn = np.clip(np.searchsorted(begins, trace.time, side="left") - 1, -1, None)
    wanted = np.where(turn[:, None] < 0, 0.0, np.array(wants)[turn])
    return Inclining(trace, wanted, begins, arrives, ends)


PRINTED: Final = 0.1
"""To which the error of the inclination is brought [deg]."""
STANCES: Final[tuple[Literal[3, 6], ...]] = (3, 6)


def compare_inclinations() -> StudyResult:
    """Eight directions and back to level, on three legs and on six, with and without the inclinometers."""
    runs = {legs: incline(legs) for legs in STANCES}
    blind = {legs: incline(legs, corrected=False) for legs in STANCES}
    read = {legs: float(run.read_errors().max()) / DEGREE for legs, run in runs.items()}
    true = {legs: float(run.true_errors().max()) / DEGREE for legs, run in runs.items()}
    slowest = {legs: float((run.arrives - run.begins).max()) for legs, run in runs.items()}
    holds = max(*read.values(), *true.values()) <= PRINTED
    return StudyResult(
        claim="Figure 7, section 4.2: legs that move at speeds proportional to their displacements incline the upper surface, and the "
        "error between the wanted inclination and what the inclinometers read is brought to 0.1 deg.",
        verdict="holds" if holds else "differs",
        compared=(
            *(Compared(f"{_word(legs)} legs: largest error as read, at rest [deg]", read[legs], PRINTED) for legs in STANCES),
            *(Compared(f"{_word(legs)} legs: largest true error, at rest [deg]", true[legs]) for legs in STANCES),
            *(
                Compared(
                    f"{_word(legs)} legs, by their lengths alone: largest true error, at rest [deg]",
                    float(blind[legs].true_errors().max()) / DEGREE,
                )
                for legs in STANCES
            ),
            *(Compared(f"{_word(legs)} legs: slowest motion [s]", slowest[legs]) for legs in STANCES),
            *(
                Compared(f"{_word(legs)} legs: largest difference of the legs' shares half-way [%]", 100.0 * runs[legs].uneven())
                for legs in STANCES
            ),
        ),
        deviations=(
            f"The figure's curves are not at hand, and the paper prints no inclinations: {ANGLE:g} deg in eight directions, one after "
            "another and back to level, are ours. The verdict is on the 0.1 deg, as read and as it truly is.",
            f"Readings are averaged over {READ:g} s of rest: one alone has a noise of {NOISE / DEGREE:g} deg (assumed). Their offset is "
            "taken for calibrated; the paper does not say how its were.",
            f"Legs of {hoshino().legs.speed * MM:g} mm/s and motors of {hoshino().legs.resolution * MM:g} mm a step, which is 0.03 deg "
            "over the frame, are assumed. The motors' steps and the correction on the way are what keeps the legs' shares from being the "
            "same.",
            "Whether three legs stand or six is not printed: the section's title says three.",
            "By the legs' lengths alone the plate comes as near on ground that is even and as hard as believed. On a slope, which only the "
            "inclinometers tell, it would not: see fig-8.",
            SIMULATED,
        ),
        table=Table(
            ("legs", "direction [deg]", "angle [deg]", "took [s]", "error as read [deg]", "true error [deg]"),
            tuple(row for legs, run in runs.items() for row in _rows(legs, run)),
        ),
        figures=(
            Figure(
                "inclines",
                "How far the plate's axes rise, wanted (black) and as read, and the error; grey where legs move.",
                lambda path: draw_inclining(
            {f"on {_word(legs)} legs": _course(run) for legs, run in runs.items()}, within=PRINTED, path=path
        ),
            ),
        ),
    )  # fmt: skip


def _word(legs: int) -> str:
    return {3: "three", 6: "six"}[legs]


def _rows(legs: int, run: Inclining) -> list[Cells]:
    wants = (*((direction, ANGLE) for direction in DIRECTIONS), (0, 0.0))
    columns = zip(wants, run.arrives - run.begins, run.read_errors(), run.true_errors(), strict=True)
    return [(legs, *want, float(took), float(a) / DEGREE, float(b) / DEGREE) for want, took, a, b in columns]


def _course(run: Inclining) -> Tilts:
    moves = list(zip(run.begins, run.arrives, strict=True))
    return Tilts(run.trace.time, run.wanted / DEGREE, run.trace.inclines / DEGREE, run.true_inclines() / DEGREE, moves)


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
    level = {name: _walk(uphill, WalkNoise.of("usual")) for name, uphill in WAYS.items()}
    tilted = {name: _walk(uphill, known_noise(), "level=false", "start.plate=ground") for name, uphill in WAYS.items()}
    ends = all(run.done for run in level.values())
    rests = max(_at_rest(run) for run in level.values())
    rows: list[Cells] = [
        (name, "level" if kept is level else "as the slope", *_row(run))
        for kept in (level, tilted)
        for name, run in kept.items()
    ]
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
            Figure("courses", "Tilt and margin of balance along the way, level; the margin if the plate lies as the slope.",
                   lambda path: draw_levelling(level, tilted, within=LEVEL, path=path)),
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


def _row(run: WalkRun) -> Cells:
    rests = _at_rest(run)
    return (
        _yes(run.done), run.tilt / DEGREE, rests if np.isfinite(rests) else None, _margin(run), len(run.report.steps),
        run.report.seconds, run.reason,
    )  # fmt: skip


def _yes(done: bool) -> str:
    return "yes" if done else "no"


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
            tuple(_direction_row(beta, gamma) for beta, gamma in SHOWN),
        ),
        figures=(
            Figure(
                "directions",
                "Which way is up in the plate, its x to the right and y up, by its tilt: truly, and by the arctan of equation 6.",
                lambda path: draw_directions(tilts, ours[..., 1] / DEGREE, ours[..., 0], printed, path),
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


def _direction_row(beta: float, gamma: float) -> Cells:
    eta, xi = slope_of(beta * DEGREE, gamma * DEGREE)
    printed = None if beta == 0.0 else round(equation_6(beta * DEGREE, gamma * DEGREE) / DEGREE, 4)
    return beta, gamma, round(eta / DEGREE, 4), round(xi / DEGREE, 4), printed
