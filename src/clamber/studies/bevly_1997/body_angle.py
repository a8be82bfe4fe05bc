"""Section 4.4.3: the body's pose from two legs on their pegs, by the height of the second, at every stance of the printed plans."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from ...families.climber.control.body_estimate import LINE, SECOND_TIP, estimate_body
from ...families.climber.control.limb_chain import legs_of
from ...families.climber.execution.postures import postures
from ...types import Floats
from ...units import DEGREE
from ...viewing.study_lines_plot import draw_angle_errors
from ..result import Cells, Compared, Figure, StudyResult, Table, Verdict
from . import MILLI
from .body_entries import PEG_ERROR
from .printed_plans import INFERRED, PLANS, Replayed, replay_printed

PLAY: Final = 1.0 * DEGREE
"""Half the printed backlash: where in its play each joint is, either way [rad]."""
DRAWS: Final = 40
"""Of pegs and play at each stance."""
SAME: Final = 1e-6
"""Poses nearer than this are the same [m], [rad]."""
NO_WORSE: Final = 1.5
"""RMS of the printed rule's errors of angle over that of the line rule up to which it does as well [-]."""
LOST: Final = 10.0 * DEGREE
"""An error of angle from which on a pose is of no use [rad]."""
CLIMBED: Final = "Table D.1, ladder"
"""The task that the thesis carried out."""


@dataclass(frozen=True, slots=True)
class Held:
    """A stance that two limbs carry, and how far each rule is off there."""

    inclined: float
    """Of the line between the two holds [rad], 0 to pi / 2."""
    exact: float
    """Largest error of the printed rule from the angle zero, with everything known [m], [rad]."""
    kept: float
    """The same from the true angle."""
    printed: Floats
    """Errors of x, y [m] and angle [rad] of the printed rule in each draw, shape (draws, 3)."""
    line: Floats
    """Likewise of the line between the tips."""


def judged(exact: Mapping[str, bool], ratio: Mapping[str, float]) -> Verdict:
    """holds: exact, and no worse than the line rule, in all plans; open: on the ladder, the plan that was climbed; differs: not there."""
    good = {plan for plan in exact if exact[plan] and ratio[plan] <= NO_WORSE}
    return "holds" if good == set(exact) else "open" if CLIMBED in good else "differs"


def find_poses() -> StudyResult:
    """Both rules at every stance of the printed plans that two limbs carry, with everything known and with pegs and play drawn."""
    rng = np.random.default_rng(0)
    found = {label: _stances(replay_printed(name, overrides), rng) for label, (name, overrides) in PLANS.items()}
    exact = {plan: all(one.exact < SAME for one in held) for plan, held in found.items()}
    rms = {
        plan: [_rms(np.concatenate([errors[:, 2] for errors in ways])) for ways in _both(held)]
        for plan, held in found.items()
    }
    ratio = {plan: printed / line for plan, (printed, line) in rms.items()}
    lost = {
        plan: [sum(int((np.abs(errors[:, 2]) > LOST).sum()) for errors in ways) for ways in _both(held)]
        for plan, held in found.items()
    }
    everything = [one for held in found.values() for one in held]
    return StudyResult(
        claim="Section 4.4.3: with two legs on known pegs the body's place follows from the first, its angle from turning the body about "
        "that peg, from zero, until the second leg is as high as its peg.",
        verdict=judged(exact, ratio),
        compared=(
            *(Compared(f"{plan}: stances that two limbs carry", len(held)) for plan, held in found.items()),
            *(Compared(f"{plan}: of them with the pose found, all known, from zero", sum(one.exact < SAME for one in held))
              for plan, held in found.items()),
            *(Compared(f"{plan}: the same from the angle before", sum(one.kept < SAME for one in held))
              for plan, held in found.items()),
            *(Compared(f"{plan}: RMS error of the angle, printed rule [deg]", printed / DEGREE)
              for plan, (printed, _) in rms.items()),
            *(Compared(f"{plan}: RMS error of the angle, line between the tips [deg]", line / DEGREE)
              for plan, (_, line) in rms.items()),
            *(Compared(f"{plan}: printed rule over line [-]", value) for plan, value in ratio.items()),
            Compared("largest inclination with all errors of the printed rule below 10 deg [deg]", _safe(everything)),
        ),
        deviations=(
            *INFERRED,
            f"Pegs up to {PEG_ERROR * MILLI:g} mm off along each axis and joints anywhere in 2 deg of play are drawn {DRAWS} times at each "
            "stance; from the angle before, so that only those errors count. The body's own encoder is not used.",
            "The verdict is holds if, with all known, the printed rule finds every pose of all six plans, and with errors its RMS error of "
            f"the angle is at most {NO_WORSE:g} times that of the line between the tips in each plan; open if so on the ladder, which is "
            "the plan that was climbed; differs if not even there.",
            '"From zero" is as printed: of the two angles that put the second leg at that height the one nearer to zero. Our control '
            "(`clamber body circle --angle second-tip`) takes the one nearer to the angle before.",
            "The line between the tips is our rule without the encoder: atan2 of both coordinates, and the place from the mean of both "
            "hooks.",
        ),
        table=Table(
            ("plan", "stances", "draws", "printed: off by over 10 deg", "line: off by over 10 deg",
             "printed: RMS of x [mm]", "line: RMS of x [mm]", "printed: RMS of y [mm]", "line: RMS of y [mm]"),
            tuple(_row(plan, held, lost[plan]) for plan, held in found.items()),
        ),
        figures=(_figure(everything),),
        seeds=range(1),
    )  # fmt: skip


def _both(held: list[Held]) -> tuple[list[Floats], list[Floats]]:
    return [one.printed for one in held], [one.line for one in held]


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _row(plan: str, held: list[Held], lost: list[int]) -> Cells:
    places = [_rms(np.concatenate([errors[:, k] for errors in ways])) * MILLI for k in (0, 1) for ways in _both(held)]
    return (plan, len(held), len(held) * DRAWS, *lost, *places)


def _safe(held: list[Held]) -> float | None:
    """The largest inclination below which the printed rule is nowhere lost [deg]."""
    lost = [one.inclined for one in held if np.abs(one.printed[:, 2]).max() > LOST]
    below = [one.inclined for one in held if one.inclined < min(lost, default=math.inf)]
    return max(below) / DEGREE if below else None


def _stances(replayed: Replayed, rng: np.random.Generator) -> list[Held]:
    """Every stance of a plan up to its first violation that two limbs carry, each once."""
    seen: dict[tuple[object, ...], Held] = {}
    places = replayed.task.world.positions()
    failed = np.flatnonzero(replayed.replay.reasons >= 0)
    for stance in replayed.replay.stances[: failed[0] + 1 if failed.size else None]:
        two = [i for i in range(len(replayed.task.robot.limbs)) if stance["carriers"] >> i & 1]
        pose = np.array((stance["x"], stance["y"], stance["angle"]))
        key = (*two, *stance["hold"][two], *pose.round(9))
        if len(two) == 2 and key not in seen:
            seen[key] = _held(replayed, two, pose, places[stance["hold"][two]], rng)
    return list(seen.values())


def _held(replayed: Replayed, two: list[int], pose: Floats, places: Floats, rng: np.random.Generator) -> Held:
    robot = replayed.task.robot
    legs = legs_of(robot)[two]
    q = np.array([postures(robot.limbs[i], pose, place)[0].angles for i, place in zip(two, places, strict=True)])
    flat = np.array((0.0, 0.0, 0.0))

    def off(rule: int, before: Floats, angles: Floats, believed: Floats) -> Floats:
        out, spare = before.copy(), np.zeros((2, 2))
        joints, held = (angles, np.zeros((2, 2))), (np.ones(2), believed)
        estimate_body(legs, joints, held, (0.0, 0.0, rule), spare, spare.copy(), out, np.zeros(3))
        return out - pose

    exact, kept = (float(np.abs(off(SECOND_TIP, before, q, places)).max()) for before in (flat, pose))
    errors: list[list[Floats]] = [[], []]
    for _ in range(DRAWS):
        believed = places + rng.uniform(-PEG_ERROR, PEG_ERROR, (2, 2))
        angles = q + rng.uniform(-PLAY, PLAY, (2, 2))
        for kind, rule in enumerate((SECOND_TIP, LINE)):
            errors[kind].append(off(rule, pose, angles, believed))
    apart = np.abs(places[1] - places[0])
    return Held(math.atan2(apart[1], apart[0]), exact, kept, np.array(errors[0]), np.array(errors[1]))


def _figure(held: list[Held]) -> Figure:
    return Figure(
        "errors",
        "RMS error of the body's angle at each stance, by how steep the line between its two holds is.",
        lambda path: draw_angle_errors(
            np.array([one.inclined for one in held]) / DEGREE,
            {
                "height of the second tip (4.4.3)": [_rms(one.printed[:, 2]) / DEGREE for one in held],
                "line between the tips": [_rms(one.line[:, 2]) / DEGREE for one in held],
            },
            path,
        ),
    )
