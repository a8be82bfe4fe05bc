"""What a limbed climber has reached: goals met, laps, and the features that fitness weighs (page "The model", sections 7 and 10)."""

import math

from ....compiled import inlined, kernel
from ....plane import TWO_PI, edge_distance, inside, wrap
from ..statics.pose import count_holders, tip_of
from ..statics.records import goals, holds, vertices

FEATURES = 7
"""Body progress, limb progress, power, stages, length, poor stability, largest torque."""


@inlined
def advance(p, s):
    """Count the goals that the stance meets, in order."""
    while s.stage < p.n_goals and meets(p, s, goals(p)[s.stage]):
        s.stage += 1


@inlined
def swept(p, s):
    """Angle that the origin has swept about the task's centre since the start [rad]."""
    return TWO_PI * s.laps + s.bearing - p.centre_angle


@inlined
def meets(p, s, goal):
    """Whether a stance meets one goal."""
    if goal.turns != 0.0 and swept(p, s) * math.copysign(1.0, goal.turns) < abs(goal.turns) - 1e-9:
        return False
    return fits(p, s, goal)


@inlined
def fits(p, s, goal):
    """Whether a stance is where a goal asks for: all but the turns."""
    if s.x < goal.x_min - 1e-9 or s.x > goal.x_max + 1e-9 or s.y < goal.y_min - 1e-9 or s.y > goal.y_max + 1e-9:
        return False
    if goal.a_half < math.pi and abs(wrap(s.angle - goal.a_mid)) > goal.a_half + 1e-9:
        return False
    for i in range(p.n_limbs):
        if goal.hold[i] >= 0 and s.hold[i] != goal.hold[i]:
            return False
    if goal.n_vertices:
        polygon = vertices(p)[goal.vertex : goal.vertex + goal.n_vertices]
        return inside(s.x, s.y, polygon) or edge_distance(s.x, s.y, polygon) <= 1e-9
    return True


@inlined
def count_laps(p, before, after):
    """Follow the branch cut of atan2 about the task's centre, if some goal asks for turns."""
    if not p.circles:
        return
    now = math.atan2(after.y - p.centre_y, after.x - p.centre_x)
    was = before.bearing
    after.bearing = now
    if now - was > math.pi:
        after.laps -= 1
    elif now - was < -math.pi:
        after.laps += 1


@inlined
def goal_distance(p, s, x, y, goal):
    """Way from a point to a goal: to its box, region and named holds, or along its circle [m]."""
    dx = max(0.0, max(goal.x_min - x, x - goal.x_max))
    dy = max(0.0, max(goal.y_min - y, y - goal.y_max))
    way = math.sqrt(dx * dx + dy * dy)
    if goal.turns != 0.0:
        left = abs(goal.turns) - swept(p, s) * math.copysign(1.0, goal.turns)
        way = max(way, goal.radius * max(0.0, left))
    if goal.n_vertices:
        polygon = vertices(p)[goal.vertex : goal.vertex + goal.n_vertices]
        if not inside(x, y, polygon):
            way = max(way, edge_distance(x, y, polygon))
    return way


@inlined
def measure(p, s, row):
    """Features of one action's stance (page "The model", section 10)."""
    if s.stage >= p.n_goals:
        last = goals(p)[p.n_goals - 1]
        done = last.before + last.way
        row[0] = done
        row[1] = p.n_limbs * done
    else:
        goal = goals(p)[s.stage]
        base = goal.before + goal.way
        row[0] = base - goal_distance(p, s, s.x, s.y, goal)
        total = 0.0
        for i in range(p.n_limbs):
            tx, ty = tip_of(p, s, i)
            way = goal_distance(p, s, tx, ty, goal)
            if goal.hold[i] >= 0:
                way = math.hypot(holds(p)[goal.hold[i]].x - tx, holds(p)[goal.hold[i]].y - ty)
            total += base - way
        row[1] = total
    row[2] = s.power
    row[3] = s.stage
    row[4] = 1.0
    holders, _ = count_holders(p, s)
    row[5] = 1.0 if s.push_pull or holders == 1 else 0.0
    row[6] = s.torque


@kernel
def done(p, s):
    """Whether every goal has been met."""
    return s.stage >= p.n_goals
