"""What is told of climbers and boards, and what is odd about them."""

import cmath
import math
from collections.abc import Iterator, Set
from itertools import combinations, pairwise
from typing import Final

import numpy as np
import numpy.typing as npt

from ...inspection.finding import FileKind, Finding, Inspection, nearest, span_words
from ...shown_units import SI, ShownUnits
from ...types import Floats
from ...units import DEGREE, GRAVITY
from .planning.task import LimbedTask
from .robot.robot import Limb, LimbedRobot
from .world.board import SCHEMA as BOARD_SCHEMA
from .world.board import Board
from .world.library import board_names, load_board

STRAIGHT: Final = 0.999
"""A limb that reaches this part of its length is called straight [-]."""

RING: Final = 0.75
"""A limb whose tip can't come nearer than this part of its reach serves a ring of places only [-]."""

NARROW: Final = 30 * DEGREE
"""A joint with less range is narrow [rad]."""


def reach_of(limb: Limb) -> tuple[float, float]:
    """Least and largest distance of a limb's tip from its port that its elbow's limits leave [m]."""
    bends = [limb.elbow.lower, limb.elbow.upper]
    # the distance grows and falls with the angle between the links only, so its ends are at the limits, straight, or folded
    turns = (k * math.pi - limb.hook_beta for k in range(-4, 5))
    bends += [angle for angle in turns if limb.elbow.lower <= angle <= limb.elbow.upper]
    distances = [abs(limb.l1 + limb.second_link * cmath.exp(1j * angle)) for angle in bends]
    return min(distances), max(distances)


def _limbed_facts(robot: LimbedRobot, units: ShownUnits) -> dict[str, str]:
    nearest, farthest = zip(*(reach_of(limb) for limb in robot.limbs), strict=True)
    torques = [robot.torque_limit_of(joint) for joint in robot.joints]
    made_up = sum(each.source == "made up" for each in robot.sources.values())
    return {
        "family": "limbed climber",
        "limbs": ", ".join(f"{limb.name} ({limb.end.kind})" for limb in robot.limbs),
        "weight": f"{robot.weight / units.force[1]:.4g} {units.force[0]}",
        "limbs reach": f"{span_words([min(nearest), max(farthest)], units.place)} from their ports",
        "joint torque": span_words(torques, units.torque),
        "numbers": f"{len(robot.sources)} with a source, {made_up} of them made up",
    }


def _odd_limbs(robot: LimbedRobot) -> Iterator[str]:
    for limb in robot.limbs:
        least, most = reach_of(limb)
        if most < STRAIGHT * limb.length:
            yield (
                f"limb '{limb.name}' can't be straight: its elbow's limits, {limb.elbow.lower / DEGREE:.4g} to "
                f"{limb.elbow.upper / DEGREE:.4g} deg, leave it {most:.3g} m of {limb.length:.3g} m"
            )
        if least > RING * most:
            yield f"limb '{limb.name}' can't come near its port: it reaches {least:.3g} to {most:.3g} m only"
        for which, joint in (("shoulder", limb.shoulder), ("elbow", limb.elbow)):
            if joint.upper - joint.lower < NARROW:
                yield f"limb '{limb.name}': its {which} turns through {(joint.upper - joint.lower) / DEGREE:.3g} deg only"
            if joint.inertia == 0.0:
                yield (
                    f"limb '{limb.name}': its {which} has no inertia; control laws that weigh joints by it, such as scct, "
                    "need one"
                )
        if not limb.shoulder.lower <= 0.0 <= limb.shoulder.upper:
            yield f"limb '{limb.name}' can't point straight out of its port: its shoulder's limits leave 0 deg out"
        yield from _weak(robot, limb, most)
        yield from _short(robot, limb, most)


def _weak(robot: LimbedRobot, limb: Limb, reach: float) -> Iterator[str]:
    needed, limit = 0.5 * robot.weight * 0.5 * reach, robot.torque_limit_of(limb.shoulder)
    if needed > limit:
        yield (
            f"limb '{limb.name}' is weak: with half of the weight on it and its tip half of its reach to the side, its "
            f"shoulder needs {needed:.3g} N m; the limit is {limit:.3g} N m"
        )


def _short(robot: LimbedRobot, limb: Limb, reach: float) -> Iterator[str]:
    gaps = {
        other.name: math.hypot(other.port_x - limb.port_x, other.port_y - limb.port_y)
        for other in robot.limbs
        if other is not limb
    }
    nearest = min(gaps, key=gaps.__getitem__)
    if reach < gaps[nearest]:
        yield (
            f"limb '{limb.name}' is short: it reaches {reach:.3g} m, and the port of '{nearest}', the nearest, is "
            f"{gaps[nearest]:.3g} m away, so no hold passes from one limb to the other while the body stands"
        )


def _odd_body(robot: LimbedRobot) -> Iterator[str]:
    for a, b in combinations(robot.limbs, 2):
        if math.hypot(a.port_x - b.port_x, a.port_y - b.port_y) < 1e-6:
            yield f"limbs '{a.name}' and '{b.name}' have one port"
    masses = sum(sum(limb.link_masses) for limb in robot.limbs)
    share = masses * GRAVITY / robot.weight
    if share > 0.5:
        yield f"the links are {100 * share:.0f} % of the weight, but statics takes all of it at the body's origin"
    unstated = sorted(key for key, each in robot.sources.items() if each.source == "not stated")
    if unstated:
        yield f"{len(unstated)} numbers state no source, such as {unstated[0]}"


ALONE: Final = 3.0
"""A hold this many times farther from its nearest than holds usually are is alone [-]."""
NAMED: Final = 5
"""So many holds are named, the others counted."""


def inspect_board(board: Board, units: ShownUnits = SI) -> Finding:
    """Facts of a board, and what is odd about it."""
    points = board.positions()
    width, height = np.ptp(points, axis=0)
    (x, y), (unit, size, _) = points.min(axis=0), units.place
    away = nearest(points)
    directed = sum(hold.direction is not None for hold in board.holds)
    facts = {
        "holds": str(len(points)),
        "numbers": f"{board.holds[0].number} to {board.holds[-1].number}",
        "size": f"{width / size:.4g} x {height / size:.4g} {unit}, from ({x / size + 0.0:.4g}, {y / size + 0.0:.4g}) {unit}",
        "with a direction": str(directed),
        "keep-out regions": str(len(board.keep_out)),
    }
    if len(points) > 1:
        facts["nearest two"] = units.length(float(away.min()))
    odd = (*_lonely(board, away), *_covered(board, points))
    return Finding(kind="board", name=board.name, title=board.title, facts=facts, odd=odd)


def _lonely(board: Board, away: Floats) -> Iterator[str]:
    if len(away) < 3:
        return
    usual = float(np.median(away))
    alone = [hold.number for hold, distance in zip(board.holds, away, strict=True) if distance > ALONE * usual]
    if alone:
        farthest = float(away.max())
        yield (
            f"{_holds(alone)} far from all others, {farthest:.3g} m where holds usually are {usual:.3g} m apart; "
            "is a unit or a decimal point wrong?"
        )


def _covered(board: Board, points: Floats) -> Iterator[str]:
    for index, polygon in enumerate(board.keep_out):
        inside = _inside(points, np.array(polygon))
        covered = [hold.number for hold, hidden in zip(board.holds, inside, strict=True) if hidden]
        if covered:
            yield f"{_holds(covered)} inside keep_out.{index}: no limb can take them"


def _inside(points: Floats, polygon: Floats) -> npt.NDArray[np.bool_]:
    """Whether points lie inside a polygon, by the number of its sides to their right, shape (n,)."""
    inside = np.zeros(len(points), bool)
    for (x0, y0), (x1, y1) in pairwise([*polygon, polygon[0]]):
        spans = (y0 > points[:, 1]) != (y1 > points[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = x0 + (points[:, 1] - y0) * (x1 - x0) / (y1 - y0)
        inside ^= spans & (points[:, 0] < crossing)
    return inside


def _holds(numbers: list[int]) -> str:
    shown = ", ".join(map(str, numbers[:NAMED])) + (", ..." if len(numbers) > NAMED else "")
    return f"hold {shown} lies" if len(numbers) == 1 else f"{len(numbers)} holds ({shown}) lie"


def inspect_climber(robot: LimbedRobot, units: ShownUnits = SI) -> Finding:
    """Facts of a climber, and what is odd about it."""
    odd = (*_odd_limbs(robot), *_odd_body(robot))
    return Finding(kind="robot", name=robot.name, title=robot.title, facts=_limbed_facts(robot, units), odd=odd)


def odd_task(task: LimbedTask, hard: Set[str]) -> Iterator[str]:
    """What is odd about a climber's task, beside what is odd about any."""
    if task.world.keep_out and "keep_out" not in hard:
        yield "the board has regions to keep out of, but 'keep_out' only reports"
    limited = any(hold.direction is not None or hold.strength is not None for hold in task.world.holds)
    if limited and "hook" not in hard:
        yield "holds have directions or strengths, but 'hook', the check that knows them, only reports"


INSPECTION: Final = Inspection(
    robot=inspect_climber,
    kinds={"board": FileKind(BOARD_SCHEMA, board_names, load_board, inspect_board, suffixes=(".csv",))},
    odd_task=odd_task,
)
