"""Section 2.3.2: torques that support the robot at rest beside those that move its joints' inertia."""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from ...control.quintic import quintic_share
from ...families.climber.pictures.geometry import joint_angles, limb_chain
from ...families.climber.robot.robot import LimbedRobot
from ...types import Floats
from ..result import Compared, StudyResult, Table, Value, Verdict
from .printed_plans import INFERRED, replay_printed

PLANS: Final[dict[str, str]] = {"Table D.1, ladder": "ladder-hand", "Table D.2, H by hand": "h-hand"}
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
    rows: list[tuple[Value, ...]] = []
    for label, name in PLANS.items():
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
