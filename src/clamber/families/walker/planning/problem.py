"""The two-frame walker's `CompiledProblem`: a task as the arrays that the kernels read, its start stance, its outlines."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from ....errors import MISSING, SpecError
from ....planning.problem.arrays import ActionTable, Params
from ....planning.problem.check import TICKS
from ....planning.problem.code_limits import CodeLimits
from ....planning.problem.codes import MOVE, NONE, RELEASE, pack
from ....planning.problem.loops import replay
from ....planning.problem.problem import FEATURE_KINDS, FEATURE_NAMES, CompiledProblem, Records
from ....types import Floats
from ..robot import FRAMES
from ..robot.plane_poses import compose, placed
from ..robot.weight import Weight, weight_of
from ..statics.checks import WALKER_CHECKS
from ..statics.stance import WALKER_GOAL, WALKER_PARAMS, WALKER_STANCE
from .step import FEATURES, KEY_WORDS
from .task import WalkerTask

CHECKS: Final = tuple(check.name for check in WALKER_CHECKS)
MOVES: Final = ("+x", "-x", "+y", "-y", "+theta", "-theta")


HEADINGS: Final = ((0,), (0, 2), (2,), (1, 2), (1,), (1, 3), (3,), (0, 3))
"""Eight ways to slide: moves along the world's axes that a stride takes in turn."""


def walker_table(strides: Sequence[int] = ()) -> ActionTable:
    """The walker's inventory: six moves of the lifted frame, the swap, and strides, each a slide or turn and the swap that ends it.

    Args:
        strides: By how many steps the lifted frame slides or turns in a stride.
    """
    entries = [(name, [pack(MOVE, 0, axis)], True) for axis, name in enumerate(MOVES)]
    entries.append(("swap", [pack(RELEASE)], False))
    for times in strides:
        for axes in (*HEADINGS, (4,), (5,)):
            moves = [pack(MOVE, 0, axes[step % len(axes)]) for step in range(times)]
            entries.append((f"stride {' '.join(MOVES[axis] for axis in axes)} x{times}", [*moves, pack(RELEASE)], True))
    return ActionTable.build(entries)


def stride_lengths(task: WalkerTask) -> tuple[int, ...]:
    """Steps of the strides worth having: doubled from two up to what the stroke allows."""
    most = task.robot.mechanism.stroke / task.step.length
    return tuple(2**k for k in range(1, 8) if 2**k <= most)


class WalkerProblem(CompiledProblem):
    """A walker's task, ready for planners."""

    def __init__(
        self, task: WalkerTask, actions: ActionTable, *, every_check: bool = False, threads: int | None = None
    ) -> None:
        """Bind a task.

        Args:
            task: The task.
            actions: The inventory's table.
            every_check: Changes nothing: the walker's checks are cheap, so planners evaluate all of them, too.
            threads: Threads for batches; None for one a core.

        Raises:
            SpecError: If the start stance violates a hard check.
        """
        params = walker_params(task)
        start = start_stance(task, params)
        self.task = task
        # effort is the time that an action takes, peak is |p| / rho
        super().__init__(params, start, actions, CHECKS, FEATURE_NAMES, threads)
        assert len(FEATURE_NAMES) == FEATURES

    @cached_property
    def limits(self) -> CodeLimits:
        """The codes, and the indices in stances, that there are here."""
        return walker_limits(self.task)

    @property
    def landmarks(self) -> int:
        """Patches of the ground."""
        return len(self.task.world.patches)

    @property
    def key_words(self) -> int:
        """Integers of a stance's key."""
        return KEY_WORDS

    @property
    def branching(self) -> int:
        """Six moves and the swap."""
        return len(MOVES) + 1


def walker_limits(task: WalkerTask) -> CodeLimits:
    """Moves of the lifted frame and the swap; which frame a code is about follows from the stance."""
    return CodeLimits(
        label=f"task '{task.name}'",
        kinds={NONE: (1, 0, 0), MOVE: (1, 0, len(MOVES) - 1), RELEASE: (1, 0, 0)},
        fields={"stands": (0, len(FRAMES) - 1, 1), "stage": (0, len(task.goals), 1)},
    )


def start_stance(task: WalkerTask, params: Params) -> Records:
    """The task's start as an array of one stance record.

    Raises:
        SpecError: If it violates a hard check.
    """
    start = np.zeros(1, WALKER_STANCE)
    start["stands"] = FRAMES.index(task.start.stands)
    margins = np.zeros((1, len(CHECKS)))
    reasons = np.zeros(1, np.int32)
    stances = np.zeros(2, WALKER_STANCE)
    replay(params.record, start, np.array([pack(0)], np.int32), True, stances, margins, reasons)
    reason = int(reasons[0])
    if reason >= 0:
        check = WALKER_CHECKS[reason]
        short = f"violates the hard check '{check.name}' ({check.meaning}) by {-margins[0, reason]:.4g} {check.unit}"
        allowed = f"{short}; move the frames, or take '{check.name}' out of 'rules.hard'"
        raise SpecError(f"task '{task.name}'", "start", MISSING, allowed)
    stances["count"] = 0
    return stances[1:]


def walker_params(task: WalkerTask) -> Params:
    """The arrays that the kernels read.

    Raises:
        SpecError: If the robot's attachments are on no circles: the checks know those only.
    """
    robot, rules, start = task.robot, task.rules, task.start
    if robot.mechanism.points_delta is not None:
        allowed = "walks are planned for attachments on circles; state radius_delta and radius_y instead"
        raise SpecError(f"robot '{robot.name}'", "mechanism.points_delta", MISSING, allowed)
    record = np.zeros(1, WALKER_PARAMS)
    row = record[0]
    pose = np.array((start.x, start.y, start.theta))
    row["origin"] = pose, compose(pose, np.array((*start.offset, start.twist)))
    turn = round(math.tau / task.step.angle)
    row["tick"] = task.step.length / TICKS
    row["tick_angle"] = math.tau / turn / TICKS
    row["turn_ticks"] = turn * TICKS
    row["joint"], row["rest"] = robot.attachments(), robot.feet()
    row["foot_radius"] = np.hypot(row["rest"][..., 0], row["rest"][..., 1]).max(axis=1)
    row["shortest"], row["longest"] = robot.mechanism.shortest, robot.mechanism.longest
    row["guard"] = robot.mechanism.guard
    weight = carried_weight(task)
    row["share"], row["load"] = weight.share, weight.load
    row["leg_shortest"], row["leg_longest"] = robot.legs.shortest, robot.legs.longest
    row["leg_nominal"], row["lift"], row["leg_speed"] = robot.legs.nominal, robot.legs.lift, robot.legs.speed
    row["speed"] = robot.mechanism.speed
    row["clearance"] = rules.clearance + robot.legs.pad_radius
    row["least_balance"], row["least_stroke"] = rules.balance, rules.stroke
    row["apart"] = farthest_apart(task)
    row["n_goals"] = len(task.goals)
    ground = task.world
    bricks = ground.tiles()
    outlines = (*ground.forbidden(), *(block.corners() for block in ground.raised()))
    row["n_patches"], row["n_edges"], row["n_bricks"] = len(ground.patches), len(ground.raised()), len(bricks)
    row["down"], row["depth"] = ground.axes().T, ground.depth
    row["ends"] = ground.x_min, ground.x_max, ground.y_min, ground.y_max
    row["hard"] = sum(1 << CHECKS.index(name) for name in rules.hard)
    row["kinds"][: len(FEATURE_KINDS)] = FEATURE_KINDS
    return Params(
        record,
        goals=_goals(task),
        vertices=np.array([corner for corners in outlines for corner in corners], np.float64).reshape(-1, 2),
        patch_start=np.cumsum([0, *map(len, outlines)]).astype(np.int64),
        bricks=bricks,
    )


def carried_weight(task: WalkerTask) -> Weight:
    """The robot's weight with the arm and the payload as the task has them."""
    return weight_of(task.robot, task.start.arm, task.start.payload)


def farthest_apart(task: WalkerTask) -> float:
    """No valid stance has the frames' origins farther apart [m].

    The mean of the squared lengths |p + c_i| is |p|^2 + rho^2, for the c_i add up to nothing; the guard adds
    |p| <= guard rho.
    """
    mechanism, hard = task.robot.mechanism, task.rules.hard
    if "stroke" not in hard:
        return math.inf
    return mechanism.longest / (math.hypot(1.0, 1.0 / mechanism.guard) if "singular" in hard else 1.0)


def _goals(task: WalkerTask) -> Records:
    out = np.zeros(len(task.goals), WALKER_GOAL)
    at = (task.start.x, task.start.y)
    way = 0.0
    for row, goal in zip(out, task.goals, strict=True):
        row["x_min"], row["x_max"], row["y_min"], row["y_max"] = goal.box
        row["a_half"] = math.tau
        if goal.theta_min is not None and goal.theta_max is not None:
            row["a_mid"] = 0.5 * (goal.theta_min + goal.theta_max)
            row["a_half"] = 0.5 * (goal.theta_max - goal.theta_min)
        there = goal.middle(at)
        row["before"] = way
        row["way"] = math.hypot(there[0] - at[0], there[1] - at[1])
        way += float(row["way"])
        at = there
    return out


@dataclass(frozen=True, slots=True, kw_only=True)
class WalkerOutline:
    """What a picture of one stance needs, world frame [m]."""

    frames: tuple[Floats, Floats]
    """Corners of the Delta-frame, shape (3, 2), and the Y-frame's origin and three tips, shape (4, 2)."""
    feet: Floats
    """Feet of both frames, shape (2, 3, 2)."""
    stands: int
    """Index of the frame whose feet are on the ground."""
    actuators: Floats
    """Ends of the actuators on Delta-frame and Y-frame, shape (3, 2, 2)."""
    centre_of_mass: Floats
    """Shape (2,)."""
    patches: tuple[Floats, ...]
    """Corners of each patch, shape (n, 2)."""


def outline(task: WalkerTask, stance: np.void) -> WalkerOutline:
    """Frames, feet and patches of one stance record as plain arrays."""
    joints = list(map(placed, task.robot.attachments(), stance["pose"]))
    return WalkerOutline(
        frames=(joints[0], np.vstack([stance["pose"][1, :2], joints[1]])),
        feet=np.array(stance["foot"]),
        stands=int(stance["stands"]),
        actuators=np.stack(joints, axis=1),
        centre_of_mass=np.array([stance["mass_x"], stance["mass_y"]]),
        patches=tuple(np.array(patch) for patch in task.world.forbidden()),
    )
