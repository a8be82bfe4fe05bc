"""Section 2.3.2: the push-pull constraint beside the split with the least forces; static torques beside those that move joints' inertia."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from ...control.quintic import quintic_share
from ...families.climber.pictures.geometry import joint_angles, limb_chain
from ...families.climber.robot.robot import LimbedRobot
from ...types import Floats
from ..result import Cells, Compared, StudyResult, Table, Verdict
from .printed_plans import INFERRED, PLANS, replay_printed

SEVERAL: Final = 3
"""Configurations of the printed plans that count as several."""
SAME: Final = 1.01
"""A largest force that is no more than so many times the least possible counts as the least [-]."""
PLACES: Final = 4
"""Configurations whose pegs lie in the same places from the body, to so many decimals of a metre, are one."""


@dataclass(frozen=True, slots=True)
class Split:
    """The weight carried by two legs: sizes of the larger end-effector force [N]."""

    push_pull: float
    """Both forces through the centre of gravity, equations 2.14 and 2.16."""
    least: float
    """The least that any split has."""
    vertical: float
    """Vertical forces alone, equation 2.9; infinite with the pegs on one vertical line."""


def split_weight(a: Floats, b: Floats, weight: float) -> Split:
    """Splits of the weight between two legs.

    A force along the line between the pegs keeps every balance, so one number is free: the largest force is least at the vertex of one of
    two parabolas in it, or where they cross.

    Args:
        a, b: Pegs from the centre of gravity [m], shape (2,).
        weight: [N].
    """
    away = b - a
    distance = float(np.hypot(*away))
    u = away / distance
    n = np.array((-u[1], u[0]))
    half, across = 0.5 * weight * float(u[1]), weight * float(b[0]) / distance
    other = weight * float(n[1]) - across

    def largest(free: float) -> float:
        return max(math.hypot(across, half + free), math.hypot(other, half - free))

    free = [-half, half]
    if half != 0.0:
        free.append((other * other - across * across) / (4.0 * half))
    turns = float(a[0] * b[1] - a[1] * b[0])
    if abs(turns) > 1e-12:  # forces s a and t b with s a + t b = (0, weight)
        s, t = -weight * float(b[0]) / turns, weight * float(a[0]) / turns
        push_pull = max(abs(s) * float(np.hypot(*a)), abs(t) * float(np.hypot(*b)))
    else:
        push_pull = 0.5 * weight if abs(a[0]) < 1e-9 and abs(b[0]) < 1e-9 else math.inf
    wide = float(a[0] - b[0])
    vertical = math.inf if abs(wide) < 1e-9 else weight * max(abs(float(a[0])), abs(float(b[0]))) / abs(wide)
    return Split(push_pull, min(map(largest, free)), vertical)


def judge_push_pull(splits: list[Split]) -> Verdict:
    """The verdict: the constraint has the least forces in several configurations, in some, or in none."""
    least = sum(split.push_pull <= SAME * split.least for split in splits)
    return "holds" if least >= SEVERAL else "open" if least else "differs"


def compare_push_pull() -> StudyResult:
    """The three splits in every push-pull configuration of the printed plans."""
    rows: list[Cells] = []
    splits: dict[tuple[float, ...], Split] = {}
    for label, (name, overrides) in PLANS.items():
        replayed = replay_printed(name, overrides)
        holds, weight = replayed.task.world.holds, replayed.task.robot.weight
        stances = replayed.replay.stances
        seen: dict[tuple[float, ...], Split] = {}
        for stance in stances[stances["push_pull"] != 0]:
            carriers = [i for i in range(len(replayed.task.robot.limbs)) if int(stance["carriers"]) >> i & 1]
            pegs = [holds[int(stance["hold"][i])] for i in carriers]
            a, b = (np.array((peg.x - stance["x"], peg.y - stance["y"])) for peg in pegs)
            split = split_weight(a, b, weight)
            told = float(np.hypot(*stance["force"][carriers].T).max())
            assert math.isclose(told, split.push_pull, rel_tol=1e-6), "the evaluator's split is that of equation 2.16"
            seen[tuple(np.round([*a, *b], PLACES).tolist())] = split
        splits |= seen
        if seen:
            rows.append(
                (
                    label,
                    len(seen),
                    sum(one.push_pull <= SAME * one.least for one in seen.values()),
                    max(one.push_pull / one.least for one in seen.values()),
                    sum(one.push_pull < one.vertical for one in seen.values()),
                )
            )
    every = list(splits.values())
    ratios = sorted(one.push_pull / one.least for one in every)
    return StudyResult(
        claim="Section 2.3.2: with two legs on one side both forces are taken through the centre of gravity, which for several "
        "configurations makes the end-effector forces least.",
        verdict=judge_push_pull(every),
        compared=(
            Compared("push-pull configurations of the printed plans", len(every)),
            Compared("of them with the least largest force, to 1 %", sum(ratio <= SAME for ratio in ratios), "several"),
            Compared("largest force over the least possible, least [-]", ratios[0]),
            Compared("largest force over the least possible, median [-]", ratios[len(ratios) // 2]),
            Compared("largest force over the least possible, most [-]", ratios[-1]),
            Compared(
                "configurations in which vertical forces alone would be larger",
                sum(one.push_pull < one.vertical for one in every),
            ),
        ),
        deviations=(
            *INFERRED,
            "End-effector forces are compared by the larger of the two, and several is read as three or more; the rule was fixed before "
            "configurations were counted. The thesis names none.",
            "Forces of any direction are allowed, as in the thesis; hooks could not push (see hook-check).",
        ),
        table=Table(
            (
                "plan",
                "push-pull configurations",
                "with the least largest force",
                "largest over least, most [-]",
                "vertical larger",
            ),
            tuple(rows),
        ),
    )


MOVED: Final[dict[str, str]] = {"Table D.1, ladder": "ladder-hand", "Table D.2, H by hand": "h-hand"}
"""Those in steps of 3 in and 15 deg."""
SECONDS: Final = 0.5
"""Of a body move: the only time that is printed for one (section 4.5) [s]."""
DOMINATES: Final = 2.0
"""The static torque dominates where it is at least so many times the dynamic one [-]."""
POINTS: Final = 401
"""Of a move, at which joint angles are differentiated."""


def judge_static(ratios: Sequence[float]) -> Verdict:
    """The verdict, from the largest static over the largest dynamic torque of each body move."""
    return "holds" if min(ratios) >= DOMINATES else "differs"


def compare_torques() -> StudyResult:
    """Largest static and dynamic torques of every body move of two printed plans."""
    rows: list[Cells] = []
    for label, name in MOVED.items():
        replayed = replay_printed(name)
        task, stances = replayed.task, replayed.replay.stances
        for k in range(len(stances) - 1):
            before, after = stances[k], stances[k + 1]
            move = np.array([after[axis] - before[axis] for axis in ("x", "y", "angle")])
            if not move.any() or not (before["hold"] == after["hold"]).all():
                continue
            carriers = [i for i in range(len(task.robot.limbs)) if int(after["carriers"]) >> i & 1]
            if len(carriers) < 2:
                continue
            pegs = {i: task.world.holds[int(after["hold"][i])] for i in carriers}
            tips = {i: complex(peg.x, peg.y) for i, peg in pegs.items()}
            sides = {i: 1.0 - 2.0 * int(after["branch"][i]) for i in carriers}
            start = np.array([before[axis] for axis in ("x", "y", "angle")])
            dynamic = _dynamic(task.robot, tips, sides, start, move)
            static = max(float(np.abs(stance["torques"][carriers]).max()) for stance in (before, after))
            kind = "turn" if move[2] else "move"
            rows.append(
                (
                    label,
                    k + 1,
                    kind,
                    static,
                    dynamic,
                    static / dynamic,
                    SECONDS * math.sqrt(DOMINATES * dynamic / static),
                )
            )
    ratios = [float(row[5] or 0.0) for row in rows]
    times = [float(row[6] or 0.0) for row in rows]
    return StudyResult(
        claim="Section 2.3.2: the torques that support a system such as LIBRA statically dominate over dynamic effects.",
        verdict=judge_static(ratios),
        compared=(
            Compared("body moves of the printed plans in 3 in or 15 deg", len(rows)),
            Compared(f"in {SECONDS:g} s each: static over dynamic torque, least [-]", min(ratios)),
            Compared(
                f"in {SECONDS:g} s each: static over dynamic torque, median [-]", sorted(ratios)[len(ratios) // 2]
            ),
            Compared(
                f"moves in which the static torque is at least {DOMINATES:g} times the dynamic one",
                sum(ratio >= DOMINATES for ratio in ratios),
            ),
            Compared("time of a move from which that is so for all [s]", max(times)),
            Compared("time of a move from which that is so for half of them [s]", sorted(times)[len(times) // 2]),
        ),
        deviations=(
            *INFERRED,
            f"Dominates is read as at least {DOMINATES:g} times as large, largest joint torque against largest joint torque of the same "
            f"move, for every move in {SECONDS:g} s from rest to rest by a quintic law: the only time that the thesis prints for a body "
            "move (figure 4.18), for 3 in. The rule was fixed before torques were computed. How fast LIBRA climbed is not printed.",
            "The dynamic torque is that of the reflected inertia of Table 3.1, the static one that of the planner's split at either end. "
            "The body's own mass adds its acceleration over that of gravity to the static torque, 18 % at most; friction and damping are "
            "left out.",
        ),
        table=Table(
            (
                "plan",
                "step",
                "kind",
                "static torque [N m]",
                f"dynamic torque in {SECONDS:g} s [N m]",
                "static over dynamic [-]",
                f"time from which static is {DOMINATES:g} times as large [s]",
            ),
            tuple(rows),
        ),
    )


def _dynamic(
    robot: LimbedRobot, tips: dict[int, complex], sides: dict[int, float], start: Floats, move: Floats
) -> float:
    """Largest torque that a joint of the holding limbs needs for its own inertia, the body moved from rest to rest [N m]."""
    shares = np.array([quintic_share(u) for u in np.linspace(0.0, 1.0, POINTS)])
    poses = start + shares[:, None] * move
    interval = SECONDS / (POINTS - 1)
    largest = 0.0
    for i, tip in tips.items():
        limb = robot.limbs[i]
        chains = [limb_chain(limb, complex(x, y), angle, tip, sides[i]) for x, y, angle in poses]
        angles = np.unwrap(
            [joint_angles(limb, float(pose[2]), chain) for pose, chain in zip(poses, chains, strict=True)], axis=0
        )
        speeds = np.diff(angles, axis=0) / interval
        accelerations = np.diff(speeds, axis=0) / interval
        inertias = np.array((limb.shoulder.inertia, limb.elbow.inertia))
        largest = max(largest, float(np.abs(inertias * accelerations).max()))
    return largest
