"""Section 4.4.6: a virtual potential that keeps limbs off the body, and the sequence that grabs a peg."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from ...families.climber.control import hook_push
from ...families.climber.execution.body_gains import BodyGains
from ...families.climber.execution.hook import NEAR
from ...families.climber.robot.robot import LimbedRobot
from ...families.climber.trials.body_rung import climb_rung
from ...families.climber.trials.body_stand import BodyStand, bench_flaws, ladder_stand
from ...plane import segment_polygon
from ...types import Floats
from ...viewing.study_lines_plot import Points, draw_panels
from ..result import Compared, Figure, StudyResult, Table, Verdict
from . import MILLI
from .body_entries import PLANT, TABLE_4_1

SAFE: Final = 0.01
"""Gap between link and body that is a safe distance [m] (chosen)."""
STRENGTH: Final = 0.5
"""F_0 over the weight [-] (chosen)."""
SEED: Final = 3
"""Of the rung that is climbed with the potential and without."""
WAY: Final = 1.5
"""In which a reference goes to its target [s], and then stays for as long."""
WITHOUT, WITH = "no potential", "potential"
STRENGTHS: Final = {WITHOUT: 0.0, WITH: STRENGTH}


@dataclass(frozen=True, slots=True, eq=False)
class Crossing:
    """A free limb whose reference crosses the body."""

    time: Floats
    gap: Floats
    """Between its second link and the body, by the truth; negative where they overlap [m]."""
    left: float
    """Between tip and reference at the end [m]."""

    @property
    def least(self) -> float:
        """Least gap [m]."""
        return float(self.gap.min())


def judged(without: list[float], kept: list[float]) -> Verdict:
    """holds: with the potential no limb is too near, without it one meets the body; open: none does; differs: one is too near with it.

    Args:
        without: Least gaps without the potential [m].
        kept: With it [m].
    """
    if min(kept) < SAFE:
        return "differs"
    return "holds" if min(without) < 0.0 else "open"


def cross_body() -> StudyResult:
    """The free limb told to go to places on and beyond the body, with the potential and without; and a rung climbed with both."""
    stand = ladder_stand(fixed=True)
    runs = {(name, place): _cross(stand, target, replace(TABLE_4_1, limit="none", potential=strength))
            for name, strength in STRENGTHS.items() for place, target in targets(stand.robot).items()}  # fmt: skip
    least = {name: [run.least for (one, _), run in runs.items() if one == name] for name in STRENGTHS}
    rungs = {name: climb_rung(BodyGains(potential=strength), SEED) for name, strength in STRENGTHS.items()}
    reach = BodyGains().potential_range * max(limb.length for limb in stand.robot.limbs)
    return StudyResult(
        claim="Section 4.4.6: a simple virtual potential (Khatib, 1986) about the body keeps the limbs a safe distance from it; a peg is "
        "grabbed in a sequence of steps (Figure 4.14).",
        verdict=judged(least[WITHOUT], least[WITH]),
        compared=(
            *(Compared(f"{name}, reference to {place}: least gap to the body [mm]", run.least * MILLI)
              for (name, place), run in runs.items()),
            *(Compared(f"{name}, reference to {place}: tip off its reference at the end [mm]", run.left * MILLI)
              for (name, place), run in runs.items()),
            *(Compared(f"{name}: a rung of the ladder, seed {SEED}", "climbed" if rung.done else rung.reason)
              for name, rung in rungs.items()),
            *(Compared(f"{name}: time of that rung [s]", rung.seconds) for name, rung in rungs.items()),
        ),
        deviations=(
            *PLANT,
            "Neither the field nor its size is printed. Ours is Khatib's, F = F_0 (rho_0 / rho - 1) (rho_0 / rho)^2 on the point of the "
            f"second link nearest to the body, F_0 {STRENGTH:g} of the weight, rho_0 {BodyGains().potential_range:g} of the limb's length "
            f"({reach * MILLI:.0f} mm), the force at most three weights; a first try with a tenth and one weight let a limb "
            "through. It is off unless asked for: our climber plans its limbs' ways round "
            "the body.",
            "The bottom limb's tip follows a straight line of 1.5 s to each target, its reference, and is held there as long; the body "
            "stands on two fixed tips. Links pass through the body in this plant, so that what keeps them off is the control alone, "
            "and joints have no stops: within the printed limits of its elbow a limb of LIBRA could not fold so far.",
            f"The verdict is holds if with the potential no gap is below {SAFE * MILLI:g} mm and without it one is negative; open if none "
            "is, differs if one is too small with it. A limb whose target is in or behind the body does not arrive: a potential has local "
            "minima.",
        ),
        table=Table(("step of Figure 4.14", "printed", "ours"), SEQUENCE),
        seeds=range(SEED, SEED + 1),
        figures=(_figure(runs),),
    )  # fmt: skip


SEQUENCE: Final = (
    ("away from the peg", "a commanded acceleration, open loop", "straight back against the grab direction, closed loop, until clear"),
    ("to the next peg", "a path to within 3 mm of it", f"a planned path to {NEAR * MILLI:g} mm plus the map's doubt before it"),
    ("round the peg", "a new path until the opening of the hook is aligned", "none: the path ends aligned, before the opening"),
    ("onto the peg", "a commanded acceleration until the hook is stopped", f"a pull of {hook_push.PUSH:g} N until it is stopped"),
    ("made sure of", "not printed", f"a tug of {hook_push.TUG:g} N with dither; tried again beside where it missed"),
    ("elbow of leg 3", "switched open loop between pegs", "part of the planned path, a side for a whole stay"),
    ("a released leg", "follows the body, soft along x", "its joints stay, out of the way of holds; it gives way where it is pressed"),
)  # fmt: skip
"""What the thesis prints of grabbing, and what the climber does; a virtual potential about the peg it tried and abandoned, we have none."""


def targets(robot: LimbedRobot) -> dict[str, Floats]:
    """Places on and beyond the body that a straight reference of the last limb crosses it for, body frame [m]."""
    limb = robot.limbs[-1]
    far = np.array((limb.port_x, limb.port_y))
    return {
        "the body's origin": np.zeros(2),
        "another limb's port": np.array((robot.limbs[0].port_x, robot.limbs[0].port_y)),
        "the other side of the body": -2.0 * far,
        "beside the body": np.array((-2.0 * abs(far).max(), 0.0)),
    }


def _cross(stand: BodyStand, target: Floats, gains: BodyGains) -> Crossing:
    """Bring the last limb's reference straight to a place of the body frame, and keep it there."""
    flaws = bench_flaws("nominal")
    climber, plant = stand.put(flaws, gains)
    body, i = climber.body, len(stand.robot.limbs) - 1
    for _ in range(round(0.5 / flaws.period)):
        climber.tick()
    task = body.tasks[i]
    start, end = body.tip(i), body.settled[:2] + target
    task.mode = "swing_cartesian"
    gaps = []
    count = round(WAY / flaws.period)
    for k in range(2 * count):
        u = min(1.0, (k + 1) / count)
        task.place = start + u * u * (3.0 - 2.0 * u) * (end - start)
        task.speed = 6.0 * u * (1.0 - u) / WAY * (end - start)
        climber.tick()
        gaps.append(_gap(stand.robot, i, plant.truth().q[i]))
    tip = plant.truth().tips[i]
    return Crossing(
        flaws.period * np.arange(2 * count, dtype=np.float64),
        np.array(gaps, np.float64),
        float(np.linalg.norm(tip - task.place)),
    )


def _gap(robot: LimbedRobot, i: int, q: Floats) -> float:
    """Between a limb's second link and the body [m]."""
    _, elbow, _, tip = robot.limbs[i].chain(q)
    return (
        float(segment_polygon(elbow.real, elbow.imag, tip.real, tip.imag, robot.outline()))
        - robot.link_radius
        - robot.body_margin
    )


def _figure(runs: Mapping[tuple[str, str], Crossing]) -> Figure:
    return Figure(
        "gaps",
        "Gap between the bottom limb's second link and the body, by where its reference goes.",
        lambda path: draw_panels(
            {
                name: {place: Points(run.time, run.gap * MILLI) for (one, place), run in runs.items() if one == name}
                for name in STRENGTHS
            },
            ("time [s]", "gap between second link and body [mm]"),
            "A limb whose reference crosses the body",
            path,
        ),
    )
