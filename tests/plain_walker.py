"""A second reading of docs/walker-model.md, in complex numbers: slow, obvious, sharing nothing with the kernels."""

import cmath
import math
from dataclasses import dataclass, replace
from typing import Any

CHECKS = ("stroke", "singular", "foothold", "balance", "legs")
UNLIMITED = 1e9
TICKS = 2**20


@dataclass(frozen=True)
class PlainStance:
    """Steps that each frame has made along x, y and in angle, the frame that stands, and goals met."""

    delta: tuple[int, int, int] = (0, 0, 0)
    y: tuple[int, int, int] = (0, 0, 0)
    stands: str = "delta"
    stage: int = 0


@dataclass(frozen=True)
class PlainResult:
    """What an action came to."""

    stance: PlainStance
    margins: dict[str, float]
    reason: str | None
    duration: float


def cross(a: complex, b: complex) -> float:
    return (a.conjugate() * b).imag


def from_segment(point: complex, a: complex, b: complex) -> float:
    """Distance of a point from a segment, by the three cases."""
    along = b - a
    dot = ((point - a) * along.conjugate()).real
    if dot <= 0:
        return abs(point - a)
    if dot >= abs(along) ** 2:
        return abs(point - b)
    return abs(cross(along, point - a)) / abs(along)


def edge_distance(point: complex, corners: list[complex]) -> float:
    return min(from_segment(point, a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True))


def signed_distance(point: complex, corners: list[complex]) -> float:
    """Distance of a point from a polygon, negative inside: inside is where the corners wind about the point."""
    pairs = list(zip(corners, corners[1:] + corners[:1], strict=True))
    near = min(from_segment(point, a, b) for a, b in pairs)
    if near == 0.0:
        return 0.0
    winding = sum(cmath.phase((b - point) / (a - point)) for a, b in pairs)
    return -near if abs(winding) > math.pi else near


class PlainWalker:
    """Carries out and judges actions of one task."""

    def __init__(self, task: Any) -> None:
        self.task = task
        self.mechanism = task.robot.mechanism

    def directions(self, frame: str) -> list[complex]:
        first = self.mechanism.first + (self.mechanism.offset if frame == "y" else 0.0)
        return [cmath.exp(1j * (first + math.radians(120.0 * i))) for i in range(3)]

    def pose(self, stance: PlainStance, frame: str) -> tuple[complex, float]:
        """Origin and angle of a frame in the world."""
        start, step = self.task.start, self.task.step
        origin, angle = complex(start.x, start.y), start.theta
        if frame == "y":
            origin += complex(*start.offset) * cmath.exp(1j * start.theta)
            angle += start.twist
        ix, iy, ia = stance.y if frame == "y" else stance.delta
        return origin + step.length * complex(ix, iy), angle + step.angle * ia

    def feet(self, stance: PlainStance, frame: str) -> list[complex]:
        origin, angle = self.pose(stance, frame)
        radius = self.task.robot.legs.radius_y if frame == "y" else self.task.robot.legs.radius_delta
        return [origin + radius * cmath.exp(1j * angle) * d for d in self.directions(frame)]

    def ground(self, foot: complex) -> float:
        """Height of the ground over a place, as the world itself has it."""
        height = float(self.task.world.heights((foot.real, foot.imag)))
        return height if math.isfinite(height) else -UNLIMITED

    def on_slope(self, foot: complex) -> complex:
        """Where in the ground's frame a foot stands that is over a place."""
        world = self.task.world
        tilt, heading = world.slope, cmath.exp(1j * world.uphill)
        along = foot * heading.conjugate()  # its real part goes uphill
        rise = math.cos(tilt) * along.real + math.sin(tilt) * self.ground(foot)
        return complex(rise, along.imag) * heading

    def heights(self, stance: PlainStance) -> tuple[float, float, float]:
        """Lowest and highest that the plate can be, and where it is."""
        legs = self.task.robot.legs
        stand = [self.ground(foot) for foot in self.feet(stance, stance.stands)]
        over = [self.ground(foot) for foot in self.feet(stance, "y" if stance.stands == "delta" else "delta")]
        low = legs.shortest + max(*stand, *(height + legs.lift for height in over))
        high = legs.longest + min(stand)
        return low, high, max(low, min(high, sum(stand) / 3 + legs.nominal))

    def centre_of_mass(self, delta: complex, alpha: float, y: complex) -> complex:
        """Every mass by itself, at its place."""
        robot, start = self.task.robot, self.task.start
        masses = [
            (robot.mass.share_delta * robot.mass.frames, delta),
            ((1 - robot.mass.share_delta) * robot.mass.frames, y),
        ]
        at, pitch, angles = robot.arm.out, 0.0, start.arm or robot.arm.rest
        out = cmath.exp(1j * (alpha + angles[0]))
        for link, mass, angle in zip(robot.arm.links, robot.arm.masses, angles[1:], strict=True):
            pitch += angle
            masses.append((mass, delta + (at + link * math.cos(pitch) / 2) * out))
            at += link * math.cos(pitch)
        masses.append((start.payload, delta + at * out))
        return sum(mass * place for mass, place in masses) / sum(mass for mass, _ in masses)

    def lengths(self, stance: PlainStance) -> list[float]:
        """Of the actuators."""
        (delta, alpha), (y, beta) = self.pose(stance, "delta"), self.pose(stance, "y")
        ends = zip(self.directions("delta"), self.directions("y"), strict=True)
        m = self.mechanism
        return [
            abs(y + m.radius_y * b * cmath.exp(1j * beta) - delta - m.radius_delta * a * cmath.exp(1j * alpha))
            for a, b in ends
        ]

    def margins(self, stance: PlainStance, landed: bool) -> dict[str, float]:
        robot, rules, mechanism = self.task.robot, self.task.rules, self.mechanism
        (delta, alpha), (y, beta) = self.pose(stance, "delta"), self.pose(stance, "y")
        # Everything of the mechanism in the Delta-frame, as the page has it
        p = (y - delta) * cmath.exp(-1j * alpha)
        theta = beta - alpha
        attach_delta = [mechanism.radius_delta * d for d in self.directions("delta")]
        attach_y = [mechanism.radius_y * d * cmath.exp(1j * theta) for d in self.directions("y")]
        lengths = [abs(p + b - a) for a, b in zip(attach_delta, attach_y, strict=True)]
        longest = mechanism.shortest + mechanism.stroke
        rho = abs(attach_y[0] - attach_delta[0])
        feet = self.feet(stance, stance.stands)
        world = self.task.world
        patches = [[complex(*corner) for corner in patch] for patch in world.forbidden()]
        edges = [[complex(*corner) for corner in block.corners()] for block in world.raised()]
        spots = [self.on_slope(foot) for foot in feet]
        away = [signed_distance(spot, patch) for spot in spots for patch in patches]
        away += [edge_distance(spot, edge) for spot in spots for edge in edges]
        away += [
            min(s.real - world.x_min, world.x_max - s.real, s.imag - world.y_min, world.y_max - s.imag) for s in spots
        ]
        foothold = min(away) - (robot.legs.pad_radius + rules.clearance)
        low, high, _ = self.heights(stance)
        if landed:
            other = "y" if stance.stands == "delta" else "delta"
            high = min([high, *(self.ground(foot) + robot.legs.longest for foot in self.feet(stance, other))])
        mass = self.centre_of_mass(delta, alpha, y)
        sides = zip(feet, feet[1:] + feet[:1], strict=True)
        balance = min(cross(b - a, mass - a) / abs(b - a) for a, b in sides) - rules.balance
        return {
            "stroke": min(min(length - mechanism.shortest, longest - length) for length in lengths) - rules.stroke,
            "singular": mechanism.guard * rho - abs(p),
            "foothold": foothold,
            "balance": balance,
            "legs": high - low,
        }

    def act(self, stance: PlainStance, action: str) -> PlainResult:
        """Carry out "none", "swap", or a move such as "+x"."""
        lifted = "y" if stance.stands == "delta" else "delta"
        after = stance
        if action == "swap":
            after = replace(stance, stands=lifted)
        elif action != "none":
            steps = list(getattr(stance, lifted))
            steps[("x", "y", "theta").index(action[1:])] += 1 if action[0] == "+" else -1
            after = replace(stance, **{lifted: tuple(steps)})
        margins = self.margins(after, action in {"none", "swap"})
        climb = abs(self.heights(after)[2] - self.heights(stance)[2])
        legs = self.task.robot.legs
        duration = 0.0
        if action == "swap":
            duration = (2 * legs.lift + climb) / legs.speed
        elif action != "none":
            change = max(abs(b - a) for a, b in zip(self.lengths(stance), self.lengths(after), strict=True))
            duration = max(change / self.mechanism.speed, climb / legs.speed)
        reason = next((name for name in CHECKS if name in self.task.rules.hard and margins[name] < -1e-9), None)
        if reason is None:
            while after.stage < len(self.task.goals) and self.meets(after, self.task.goals[after.stage]):
                after = replace(after, stage=after.stage + 1)
        return PlainResult(after, margins, reason, duration)

    def meets(self, stance: PlainStance, goal: Any) -> bool:
        origin, angle = self.pose(stance, "delta")
        x_min, x_max, y_min, y_max = goal.box
        if not (x_min - 1e-9 <= origin.real <= x_max + 1e-9 and y_min - 1e-9 <= origin.imag <= y_max + 1e-9):
            return False
        if goal.theta_min is None or goal.theta_max - goal.theta_min >= math.tau:
            return True
        middle, half = (goal.theta_min + goal.theta_max) / 2, (goal.theta_max - goal.theta_min) / 2
        return abs(math.remainder(angle - middle, math.tau)) <= half + 1e-9
