"""What an action does to a two-frame walker (page "The walker's model", section 3), and the family's scalar kernels."""

import math

from ....compiled import inlined, kernel
from ....plane import wrap
from ....planning.problem.check import TICKS
from ....planning.problem.codes import MOVE, NONE, RELEASE, pack_code, unpack
from ....planning.problem.family_kernels import family_kernels
from ..statics.stance import (
    DELTA,
    WALKER_PARAMS,
    Y,
    balance,
    foothold,
    judge,
    place,
    stand_height,
    stretch,
    walker_goals,
)

FEATURES = 7
"""Body progress, feet progress, time, stages, length, poor stability, nearness of singularity."""
KEY_WORDS = 7
SLIDES_AND_TURNS = 6
CELL = 0.3
"""Side of a niching cell [m]."""


@inlined
def copy_stance(s, t):
    """Copy a stance record."""
    t.stands = s.stands
    t.stage = s.stage
    t.count = s.count
    t.x = s.x
    t.y = s.y
    t.angle = s.angle
    t.mass_x = s.mass_x
    t.mass_y = s.mass_y
    t.foothold = s.foothold
    t.balance = s.balance
    t.legs = s.legs
    t.height = s.height
    t.duration = s.duration
    t.strain = s.strain
    for f in range(2):
        t.c[f] = s.c[f]
        t.s[f] = s.s[f]
        for i in range(3):
            t.ticks[f, i] = s.ticks[f, i]
            t.pose[f, i] = s.pose[f, i]
            for j in range(2):
                t.foot[f, i, j] = s.foot[f, i, j]
    for i in range(3):
        t.actuator[i] = s.actuator[i]


@inlined
def longest_change(before, after):
    """Largest change of an actuator's length from one stance to another [m]."""
    change = 0.0
    for i in range(3):
        change = max(change, abs(after.actuator[i] - before.actuator[i]))
    return change


@inlined
def act(p, before, code, after, margins):
    """Carry out one action; see `step`."""
    kind, _, argument = unpack(code)
    if kind == MOVE:
        f = 1 - after.stands
        axis = argument >> 1
        ticks = after.ticks[f, axis] + (1 - 2 * (argument & 1)) * TICKS
        if axis == 2:
            ticks %= p.turn_ticks
        after.ticks[f, axis] = ticks
        place(p, after, f)
        reason = judge(p, after, False, margins)
        climb = abs(after.height - before.height) / p.leg_speed
        after.duration = max(longest_change(before, after) / p.speed, climb)
        return reason
    if kind == RELEASE:
        after.stands = 1 - after.stands
        reason = judge(p, after, True, margins)
        after.duration = (2.0 * p.lift + abs(after.height - before.height)) / p.leg_speed
        return reason
    if kind == NONE:
        place(p, after, DELTA)  # so that a start given by its ticks alone becomes a stance
        place(p, after, Y)
    return judge(p, after, True, margins)


@kernel
def step(p, before, code, after, margins):
    """Carry out the action `code` from the stance `before`, judge where it leads, write it all down. Allocates nothing.

    Args:
        p: Record of `WALKER_PARAMS`.
        before: Stance record; only read.
        code: Packed action: a move of the lifted frame along the world's axes or about its own origin, or a release,
            which swaps the frames.
        after: Stance record that is written, whatever the verdict.
        margins: Every check's signed margin, shape (N_CHECKS,).

    Returns:
        -1 if the action holds, else the number of the first hard check that it violates.
    """
    copy_stance(before, after)
    after.duration = 0.0
    after.count = before.count + 1
    reason = act(p, before, code, after, margins)
    if reason < 0:
        while after.stage < p.n_goals and meets(after, walker_goals(p)[after.stage]):
            after.stage += 1
    return reason


@inlined
def meets(s, goal):
    """Whether a stance meets one goal."""
    if s.x < goal.x_min - 1e-9 or s.x > goal.x_max + 1e-9 or s.y < goal.y_min - 1e-9 or s.y > goal.y_max + 1e-9:
        return False
    return goal.a_half >= math.pi or abs(wrap(s.angle - goal.a_mid)) <= goal.a_half + 1e-9


@inlined
def beyond(value, low, high):
    """How far a value lies outside a range; 0 inside."""
    return max(0.0, max(low - value, value - high))


@inlined
def goal_distance(x, y, goal):
    """Way from a point to a goal's box [m]."""
    dx = beyond(x, goal.x_min, goal.x_max)
    dy = beyond(y, goal.y_min, goal.y_max)
    return math.sqrt(dx * dx + dy * dy)


@inlined
def measure(p, s, row):
    """Features of one action's stance (page "The walker's model", 5)."""
    last = min(s.stage, p.n_goals - 1)
    goal = walker_goals(p)[last]
    base = goal.before + goal.way
    if s.stage >= p.n_goals:
        row[0] = base
        row[1] = 6.0 * base
    else:
        turn = 0.0 if goal.a_half >= math.pi else max(0.0, abs(wrap(s.angle - goal.a_mid)) - goal.a_half)
        row[0] = base - goal_distance(s.x, s.y, goal) - p.foot_radius[DELTA] * turn
        feet = 0.0
        for f in range(2):
            for i in range(3):
                feet += base - goal_distance(s.foot[f, i, 0], s.foot[f, i, 1], goal)
        row[1] = feet
    row[2] = s.duration
    row[3] = s.stage
    row[4] = 1.0
    row[5] = 1.0 if s.balance < p.least_balance else 0.0
    row[6] = s.strain


@kernel
def done(p, s):
    """Whether every goal has been met."""
    return s.stage >= p.n_goals


@kernel
def cell(p, s):
    """A coarse place in the search space for niching: stage, standing frame and the body's place, as one number."""
    value = (s.stage * 2 + s.stands) * 1000003 + int(math.floor(s.x / CELL))
    return value * 1000003 + int(math.floor(s.y / CELL))


@kernel
def key(p, s, words):
    """Everything that checks and actions read of a stance, as KEY_WORDS integers: equal keys have equal futures."""
    for f in range(2):
        for i in range(3):
            words[3 * f + i] = s.ticks[f, i]
    words[6] = s.stands | s.stage << 32


@kernel
def restore(p, words, s):
    """The stance of a key; `duration` is that of no action."""
    for f in range(2):
        for i in range(3):
            s.ticks[f, i] = words[3 * f + i]
        place(p, s, f)
    s.stands = words[6] & 1
    s.stage = words[6] >> 32
    s.duration = 0.0
    stretch(p, s)
    s.foothold = foothold(p, s)
    s.legs = stand_height(p, s, False)
    s.balance = balance(p, s)


@kernel
def dominating(p, s, which, t):
    """Write the stance number `which` that has met more goals; False if there is none of that number.

    The goals that it still needs are the last of those that `s` needs, and every action is judged alike there.
    """
    if which >= p.n_goals - 1 - s.stage:
        return False
    copy_stance(s, t)
    t.stage = s.stage + 1 + which
    return True


@kernel
def candidates(p, s, codes):
    """Every different action from a stance; returns their number, which is seven."""
    for axis in range(SLIDES_AND_TURNS):
        codes[axis] = pack_code(MOVE, 0, axis)
    codes[SLIDES_AND_TURNS] = pack_code(RELEASE, 0, 0)
    return SLIDES_AND_TURNS + 1


@kernel
def bound(p, s):
    """An admissible number of actions that both frames still need to the goal (page "The walker's model", 5)."""
    if s.stage >= p.n_goals:
        return 0.0
    goal = walker_goals(p)[s.stage]
    stride = p.tick * TICKS
    moves = 0.0
    dx = beyond(s.x, goal.x_min, goal.x_max)
    dy = beyond(s.y, goal.y_min, goal.y_max)
    moves += math.ceil(dx / stride - 1e-6) + math.ceil(dy / stride - 1e-6)
    if goal.a_half < math.pi:
        turn = max(0.0, abs(wrap(s.angle - goal.a_mid)) - goal.a_half)
        moves += math.ceil(turn / (p.tick_angle * TICKS) - 1e-6)
    follow = 0.0
    dx = max(0.0, beyond(s.pose[Y, 0], goal.x_min, goal.x_max) - p.apart)
    dy = max(0.0, beyond(s.pose[Y, 1], goal.y_min, goal.y_max) - p.apart)
    follow += math.ceil(dx / stride - 1e-6) + math.ceil(dy / stride - 1e-6)
    swaps = 0.0
    if moves > 0.0 and s.stands == DELTA:
        swaps = 1.0
    if moves > 0.0 and follow > 0.0 and s.stands == Y:
        swaps = 1.0
    return moves + follow + swaps


@inlined
def body_pose(p, s, words):
    """Where a stance is: the Delta-frame's pose in ticks."""
    for i in range(3):
        words[i] = s.ticks[DELTA, i]


@inlined
def satisfies_goal(p, s, k):
    """Whether a stance is where goal k asks for."""
    return meets(s, walker_goals(p)[k])


@kernel
def heuristic_between(p, s, t):
    """An admissible, consistent number of actions from a stance to another's key.

    A move takes the lifted frame one step or turn; only a swap changes which frame that is. A frame that stands now and at the end, and
    has to move in between, takes two swaps.
    """
    moves = 0.0
    for f in range(2):
        turn = (t.ticks[f, 2] - s.ticks[f, 2]) % p.turn_ticks
        ticks = abs(t.ticks[f, 0] - s.ticks[f, 0]) + abs(t.ticks[f, 1] - s.ticks[f, 1]) + min(turn, p.turn_ticks - turn)
        moves += math.ceil(ticks / TICKS)
        if f == s.stands and s.stands == t.stands and ticks > 0:
            moves += 2.0
    return moves + (1.0 if s.stands != t.stands else 0.0)


family_kernels(
    WALKER_PARAMS,
    step=step,
    candidates=candidates,
    key=key,
    restore=restore,
    measure=measure,
    bound=bound,
    dominating=dominating,
    done=done,
    cell=cell,
    body_pose=body_pose,
    satisfies_goal=satisfies_goal,
    heuristic_between=heuristic_between,
)
