"""Distances between limbs, body, holds and keep-outs (docs/model.md, section 9)."""

import cmath
import itertools
import math
from typing import Any

from .kinematics import Option, Point, Pose, limb_length, port_in_world

FAR = 1e9
"""Margin where there is nothing to hit."""
SIGHT = 1.0
"""Holds farther than this from the origin are not looked at [m]."""

Polygon = list[Point]


def cross(o: Point, a: Point, b: Point) -> float:
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])


def point_to_segment(p: Point, a: Point, b: Point) -> float:
    dx, dy = b[0] - a[0], b[1] - a[1]
    squared = dx * dx + dy * dy
    along = 0.0 if squared == 0.0 else ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / squared
    along = max(0.0, min(1.0, along))
    return math.hypot(p[0] - a[0] - along * dx, p[1] - a[1] - along * dy)


def segments_cross(a: Point, b: Point, c: Point, d: Point) -> bool:
    """Whether two segments cross properly; touching is found by the end point distances."""
    return cross(a, b, c) * cross(a, b, d) < 0.0 and cross(c, d, a) * cross(c, d, b) < 0.0


def segment_to_segment(a: Point, b: Point, c: Point, d: Point) -> float:
    if segments_cross(a, b, c, d):
        return 0.0
    return min(
        point_to_segment(a, c, d), point_to_segment(b, c, d), point_to_segment(c, a, b), point_to_segment(d, a, b)
    )


def edges(polygon: Polygon) -> list[tuple[Point, Point]]:
    return list(zip(polygon, polygon[1:] + polygon[:1], strict=True))


def contains(polygon: Polygon, p: Point) -> bool:
    """Even-odd rule; a polygon of fewer than three corners contains nothing."""
    inside = False
    for a, b in edges(polygon):
        if (a[1] > p[1]) != (b[1] > p[1]) and p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]):
            inside = not inside
    return inside and len(polygon) > 2


def polygon_distance(one: Polygon, other: Polygon) -> float:
    """Distance of two polygons as filled areas; a segment is a polygon of two corners."""
    if contains(one, other[0]) or contains(other, one[0]):
        return 0.0
    return min(segment_to_segment(*e, *f) for e in edges(one) for f in edges(other))


def hull(points: list[Point]) -> Polygon:
    """Convex hull, anticlockwise."""
    ordered = sorted(set(points))
    if len(ordered) < 3:
        return ordered
    halves: list[Polygon] = []
    for run in (ordered, ordered[::-1]):
        half: Polygon = []
        for p in run:
            while len(half) > 1 and cross(half[-2], half[-1], p) <= 0.0:
                half.pop()
            half.append(p)
        halves.append(half[:-1])
    return halves[0] + halves[1]


def links(limb: Any, pose: Pose, o: Option, tip: Point) -> list[Polygon]:
    return [[port_in_world(limb, pose), o.elbow], [o.elbow, tip]]


def interference_margins(
    task: Any, pose: Pose, taken: list[Option], tips: list[Point], own_hold: list[int | None]
) -> dict[str, float]:
    """Margins [m] `keep_out`, `limb_limb`, `limb_body`, `limb_peg`; `own_hold`: the hold each limb may touch."""
    robot, board = task.robot, task.world
    body = hull([port_in_world(limb, pose) for limb in robot.limbs])
    limb_links = [links(limb, pose, o, tip) for limb, o, tip in zip(robot.limbs, taken, tips, strict=True)]
    keep_out = limb_limb = limb_body = limb_peg = FAR
    for polygon in board.keep_out:
        corners = [(float(x), float(y)) for x, y in polygon]
        keep_out = min(keep_out, polygon_distance(body, corners) - robot.body_margin)
        for link in [link for pair in limb_links for link in pair]:
            keep_out = min(keep_out, polygon_distance(link, corners) - robot.link_radius)
    for i, mine in enumerate(limb_links):
        limb_body = min(limb_body, polygon_distance(mine[1], body) - robot.link_radius - robot.body_margin)
        for theirs in limb_links[i + 1 :]:
            for link in mine:
                for other in theirs:
                    limb_limb = min(limb_limb, polygon_distance(link, other) - 2.0 * robot.link_radius)
        for hold in board.holds:
            if hold.number == own_hold[i] or math.hypot(hold.x - pose.x, hold.y - pose.y) > SIGHT:
                continue
            for link in mine:
                gap = point_to_segment((hold.x, hold.y), link[0], link[1])
                limb_peg = min(limb_peg, gap - robot.link_radius - hold.radius)
    return {"keep_out": keep_out, "limb_limb": limb_limb, "limb_body": limb_body, "limb_peg": limb_peg}


def holder_room(task: Any, pose: Pose, limb: Any, option: Option, own: Any) -> float:
    """`holder_peg` of one limb on its hold, with its elbow on one side."""
    gap, rules = FAR, task.rules
    if rules.hook_width == 0.0:
        return gap
    half = rules.hook_width / 2.0
    mouth = min(half, rules.hook_ahead)
    port, tip = port_in_world(limb, pose), (own.x, own.y)
    at, g = complex(*tip), cmath.exp(1j * option.grab_angle)
    corners = [
        at + g * complex(along, side)
        for along, side in (
            (rules.hook_ahead, half),
            (rules.hook_ahead - mouth, half - mouth),
            (rules.hook_ahead - mouth, mouth - half),
            (rules.hook_ahead, -half),
            (-rules.hook_way, -half),
            (-rules.hook_way, half),
        )
    ]
    swept = [(z.real, z.imag) for z in corners]
    for hold in task.world.holds:
        place = (hold.x, hold.y)
        if hold.number == own.number or math.hypot(hold.x - port[0], hold.y - port[1]) > limb_length(limb) + 0.1:
            continue
        for link in ((port, option.elbow), (option.elbow, tip)):
            gap = min(gap, point_to_segment(place, *link) - task.robot.link_radius - hold.radius)
        if limb.end.kind in ("hook", "foot"):
            gap = min(gap, polygon_distance(swept, [place]) - rules.hook_room - hold.radius)
    return gap


def clearance(task: Any, p: Point) -> float:
    """Distance of the body's origin from the nearest hold [m] minus the rule's clearance."""
    nearest = min((math.hypot(h.x - p[0], h.y - p[1]) for h in task.world.holds), default=math.inf)
    return FAR if nearest > SIGHT else float(nearest - task.rules.clearance)


def swing_clearance(task: Any, centre: Point, radius: float, start: float, turn: float) -> float:
    """The same over the arc about `centre` from angle `start` through `turn` [rad], both ends included."""
    nearest = math.inf
    ways = (turn, -turn) if abs(turn) > math.pi - 1e-9 else (turn,)  # straight above: either way
    for hold, turn in itertools.product(task.world.holds, ways):
        dx, dy = hold.x - centre[0], hold.y - centre[1]
        for angle in (start, start + turn):
            end = (centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle))
            nearest = min(nearest, math.hypot(hold.x - end[0], hold.y - end[1]))
        past = math.fmod(math.copysign(1.0, turn) * (math.atan2(dy, dx) - start), 2.0 * math.pi)
        if past < 0.0:
            past += 2.0 * math.pi
        if past <= abs(turn):
            nearest = min(nearest, abs(math.hypot(dx, dy) - radius))
    return FAR if nearest > SIGHT else float(nearest - task.rules.clearance)
