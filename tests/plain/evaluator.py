"""What an action does to a stance, and every check of it, read plainly from docs/model.md (sections 2 to 6).

Slow and obvious on purpose. Holds go by their number, limbs by their index from 0; SI units and radians.
"""

import itertools
import math
from dataclasses import dataclass, field
from typing import Any

from .carriers import Carrier, best_option, torques
from .forces import BETTER, NO_SPLIT_TORQUE, shared_load
from .hook import hang_margins, many_margin, pair_margins
from .interference import FAR, clearance, contains, holder_room, interference_margins, point_to_segment, swing_clearance
from .kinematics import (
    EPS,
    Option,
    Point,
    Pose,
    limb_length,
    option,
    port_in_world,
    to_body,
    to_world,
    usable,
    wrap,
)

CHECKS: tuple[str, ...] = ("reach", "joint", "support", "hangs", "torque", "power", "clearance", "swing", "keep_out")
CHECKS += ("limb_limb", "limb_body", "limb_peg", "hook", "shared", "stability", "holder_peg")
TICKS = 2**20
"""Ticks of pose in one step."""
NO_CANDIDATE = -1e9
"""`reach` when there is no hold at all that the limb may take [m]."""

Action = tuple[Any, ...]
"""("none",), ("move", axis, sign), ("release", limb), ("nearest", limb, k), ("hold", limb, number) or
("random", limb, u); u in [0, 1) is the random number already drawn."""


Assignment = tuple[int, ...]
"""A branch for each limb."""
BENDS = ("joint", "torque", "power", "keep_out", "limb_limb", "limb_body", "limb_peg", "hook", "holder_peg")
"""The checks that elbows change."""


@dataclass
class PlainStance:
    """Where the robot is and what it remembers."""

    ix: int
    iy: int
    ia: int
    hold: list[int | None]
    left: list[int | None]
    """Per free limb the hold it held last."""
    foot: list[Point | None]
    """Per free limb its foot in the body frame [m]."""
    in_use: int | None
    hangs: int
    stage: int
    laps: int
    open: set[Assignment]
    """Assignments of elbows still open, read under `branch = "kept"` only."""
    count: int

    def copy(self) -> "PlainStance":
        return PlainStance(
            self.ix,
            self.iy,
            self.ia,
            list(self.hold),
            list(self.left),
            list(self.foot),
            self.in_use,
            self.hangs,
            self.stage,
            self.laps,
            set(self.open),
            self.count,
        )

    def holders(self) -> list[int]:
        return [i for i, h in enumerate(self.hold) if h is not None]

    def free_elbow(self, limb: int) -> None:
        """The limb's elbow is bound to nothing any more."""
        self.open = {(*one[:limb], branch, *one[limb + 1 :]) for one in self.open for branch in (0, 1)}


@dataclass
class PlainResult:
    """The stance after an action, why it is no good (if so), and what every check says."""

    stance: PlainStance
    reason: str | None
    margins: dict[str, float]
    torques: list[tuple[float, float]]
    """Shoulder and elbow [N m] per limb."""
    power: float
    branches: list[int]
    hold: int | None
    """Hold that a grab resolved to."""
    forces: list[Point]
    """Of the hold on each limb [N], world."""


@dataclass
class Swing:
    """What a hang did: turned by `turn` [rad] about `centre`, from angle `start`, at `radius` [m]."""

    centre: Point
    radius: float
    start: float
    turn: float


@dataclass
class Judgement:
    """All checks of one stance, before anybody asks which are hard."""

    margins: dict[str, float]
    torques: list[tuple[float, float]]
    power: float
    branches: list[int]
    forces: list[Point]
    load: float = 0.0
    """What the split makes least over the branches, where it does."""
    met: bool = True
    """Whether the split meets the cuts of ends and holds."""
    good: set[Assignment] = field(default_factory=set)
    """The assignments that stay open after a valid action."""


class PlainEvaluator:
    """Takes stances of one task forward, one action at a time."""

    def __init__(self, task: Any) -> None:
        self.task = task
        self.robot, self.rules = task.robot, task.rules
        self.holds = {h.number: h for h in task.world.holds}
        self.tick = task.step.length / TICKS
        self.angle_tick = task.step.angle / TICKS
        self.turn_ticks = round(2.0 * math.pi / task.step.angle) * TICKS
        self.n = len(task.robot.limbs)

    # Stances

    def start(self) -> PlainStance:
        start, limbs = self.task.start, self.robot.limbs
        hold = [start.holds.get(limb.name, 0) or None for limb in limbs]
        foot: list[Point | None] = []
        for limb, h in zip(limbs, hold, strict=True):
            reach = 0.6 * limb_length(limb)
            out = (
                limb.port_x + reach * math.cos(limb.port_angle),
                limb.port_y + reach * math.sin(limb.port_angle),
            )
            foot.append(None if h is not None else tuple(start.feet.get(limb.name, out)))
        holders = [i for i, h in enumerate(hold) if h is not None]
        names = [limb.name for limb in limbs]
        in_use = names.index(start.in_use) if start.in_use else (holders[-1] if holders else None)
        every = set(itertools.product((0, 1), repeat=self.n))
        return PlainStance(0, 0, 0, hold, [None] * self.n, foot, in_use, 0, 0, 0, every, 0)

    def pose(self, s: PlainStance) -> Pose:
        start = self.task.start
        return Pose(start.x + s.ix * self.tick, start.y + s.iy * self.tick, start.theta + s.ia * self.angle_tick)

    def place(self, number: int) -> Point:
        return self.holds[number].x, self.holds[number].y

    # Actions

    def step(self, stance: PlainStance, action: Action) -> PlainResult:
        """One action, and the laps and goals that come of it."""
        result = self.act(stance, action)
        after = result.stance
        self.count_laps(stance, after)
        if result.reason is None:
            while after.stage < len(self.task.goals) and self.met(after, self.task.goals[after.stage]):
                after.stage += 1
        return result

    def act(self, stance: PlainStance, action: Action) -> PlainResult:
        kind = action[0]
        after = stance.copy()
        after.count += 1
        if kind == "move":
            self.move(after, action[1], action[2])
        elif kind == "release":
            self.release(after, action[1])
        elif kind in ("nearest", "hold", "random"):
            return self.grab(stance, action)
        elif kind != "none":
            raise ValueError(f"action {action}: kind must be none, move, release, nearest, hold or random")
        return self.settle(stance, after, None, set())

    def move(self, s: PlainStance, axis: int, sign: int) -> None:
        if axis == 0:
            s.ix += sign * TICKS
        elif axis == 1:
            s.iy += sign * TICKS
        else:
            s.ia = (s.ia + sign * TICKS) % self.turn_ticks

    def release(self, s: PlainStance, limb: int) -> None:
        number = s.hold[limb]
        if number is None:
            return
        s.foot[limb] = to_body(self.pose(s), self.place(number))
        s.left[limb], s.hold[limb] = number, None
        s.free_elbow(limb)
        s.in_use = limb

    def grab(self, stance: PlainStance, action: Action) -> PlainResult:
        """A grab, and before it the release that `support = "strict"` asks for."""
        limb = action[1]
        again = action[0] == "hold" and stance.hold[limb] is not None and stance.hold[limb] == action[2]
        others = [i for i in stance.holders() if i != limb]
        if self.rules.support == "atomic" or stance.hold[limb] is None or again or len(others) >= 2:
            return self.place_limb(stance, action, stance.hold[limb])
        after = stance.copy()
        after.count += 1
        self.release(after, limb)
        if not others:
            margins = dict.fromkeys(CHECKS, math.nan)
            margins["support"] = -1.0
            return self.failed(after, "support", margins)
        swung = self.settle(stance, after, None, set())
        if swung.reason is not None:
            return swung
        base = swung.stance.copy()
        base.count -= 1  # release and grab are one action
        result = self.place_limb(base, action, stance.hold[limb])
        if not math.isnan(result.margins["torque"]):
            for name in CHECKS:
                result.margins[name] = min(result.margins[name], swung.margins[name])
            result.reason = self.why_not(result.margins)
        return result

    def place_limb(self, stance: PlainStance, action: Action, own: int | None) -> PlainResult:
        """The grab itself; `own` is the hold that the limb came from."""
        limb, pose = action[1], self.pose(stance)
        after = stance.copy()
        after.count += 1
        if action[0] == "hold" and action[2] == stance.hold[limb]:
            after.in_use = limb
            return self.settle(stance, after, action[2], set())
        candidates = [h for h in self.candidates(stance, limb) if h != own]
        number: int | None = None
        if action[0] == "hold":
            out_of_reach = self.spare(limb, pose, action[2], grabbing=True) < -EPS
            forbidden = not self.may_use(limb, action[2])
            if not out_of_reach and not forbidden:
                number = action[2]
            elif self.rules.replace_out_of_reach:
                number = candidates[0] if candidates else None
            elif forbidden:
                return self.failed_grab(stance, NO_CANDIDATE)
            else:
                number = action[2]
        elif candidates:
            k = action[2] if action[0] == "nearest" else 1 + math.floor(action[2] * len(candidates))
            number = candidates[min(k, len(candidates)) - 1]
        if number is None:
            unheld = [h for h in self.holds if h not in stance.hold and h != own and self.may_use(limb, h)]
            return self.failed_grab(
                stance, max((self.spare(limb, pose, h, grabbing=True) for h in unheld), default=NO_CANDIDATE)
            )
        after.hold[limb], after.foot[limb], after.left[limb] = number, None, None
        after.free_elbow(limb)
        after.in_use = limb
        return self.settle(stance, after, number, {limb})

    def candidates(self, s: PlainStance, limb: int) -> list[int]:
        """Numbers of the holds that the limb may grab, nearest first."""
        pose = self.pose(s)
        px, py = port_in_world(self.robot.limbs[limb], pose)
        ranked: list[tuple[int, int]] = []
        for number, h in self.holds.items():
            if number in s.hold or not self.may_use(limb, number):
                continue
            if self.spare(limb, pose, number, grabbing=True) >= -EPS:
                ranked.append((round(((h.x - px) ** 2 + (h.y - py) ** 2) / 1e-10), number))
        return [number for _, number in sorted(ranked)]

    def may_use(self, limb: int, number: int) -> bool:
        hold = self.holds[number]
        if number in self.rules.barred.get(self.robot.limbs[limb].name, ()):
            return False
        for keep in self.rules.keep:
            if keep.limb != self.robot.limbs[limb].name:
                continue
            for value, low, high in ((hold.x, keep.x_min, keep.x_max), (hold.y, keep.y_min, keep.y_max)):
                if (low is not None and value < low - EPS) or (high is not None and value > high + EPS):
                    return False
        return True

    def spare(self, limb: int, pose: Pose, number: int, grabbing: bool) -> float:
        """Reach limit less the distance from port to hold [m]."""
        px, py = port_in_world(self.robot.limbs[limb], pose)
        hx, hy = self.place(number)
        limit = limb_length(self.robot.limbs[limb])
        return limit - (self.rules.reach_offset if grabbing else 0.0) - math.hypot(hx - px, hy - py)

    def reach_margin(self, limb: int, pose: Pose, number: int, grabbing: bool) -> float:
        """Of a holder: the limit is shortened by the larger of the offsets that count [m]."""
        counts = grabbing or self.rules.offset_while_holding
        offset = max(self.rules.holding_offset, self.rules.reach_offset if counts else 0.0)
        return self.spare(limb, pose, number, grabbing=False) - offset

    # Outcomes

    def failed(self, stance: PlainStance, reason: str, margins: dict[str, float]) -> PlainResult:
        nothing = [(math.nan, math.nan)] * self.n
        return PlainResult(stance, reason, margins, nothing, math.nan, [0] * self.n, None, nothing)

    def failed_grab(self, stance: PlainStance, reach: float) -> PlainResult:
        margins = dict.fromkeys(CHECKS, math.nan)
        margins["reach"] = reach
        after = stance.copy()
        after.count += 1
        return self.failed(after, "reach", margins)

    def why_not(self, margins: dict[str, float]) -> str | None:
        """The first violated hard check; a robot that nothing holds fails `support` whatever is hard."""
        if math.isnan(margins["reach"]):
            return "support"
        return next((c for c in CHECKS if c in self.rules.hard and margins[c] < -EPS), None)

    def settle(self, before: PlainStance, after: PlainStance, number: int | None, grabbed: set[int]) -> PlainResult:
        """The hang, the checks, and the branches that they leave open."""
        swing = None
        if len(after.holders()) == 1:
            swing = self.hang(after)
            after.hangs += len(before.holders()) >= 2
        kept = self.rules.branch == "kept" and bool(after.holders())
        seen = self.judge_kept(after, swing, grabbed) if kept else self.judge(after, swing, grabbed)
        reason = self.why_not(seen.margins)
        if reason is None and kept:
            after.open = seen.good
        return PlainResult(after, reason, seen.margins, seen.torques, seen.power, seen.branches, number, seen.forces)

    def hang(self, s: PlainStance) -> Swing | None:
        """Turns the robot about its one hold until the origin is straight below it."""
        number = s.hold[s.holders()[0]]
        assert number is not None
        hx, hy = self.place(number)
        pose, start = self.pose(s), self.task.start
        rx, ry = pose.x - hx, pose.y - hy
        radius = math.hypot(rx, ry)
        if radius < 1e-9:
            return None
        at = math.atan2(ry, rx)
        turn = wrap(-math.pi / 2.0 - at)
        s.ix = round((hx - start.x) / self.tick)
        s.iy = round((hy - radius - start.y) / self.tick)
        s.ia = round((pose.angle + turn - start.theta) / self.angle_tick) % self.turn_ticks
        return Swing((hx, hy), radius, at, turn)

    # Checks

    def judge_kept(self, s: PlainStance, swing: Swing | None, grabbed: set[int]) -> Judgement:
        """Each assignment by itself; check by check, those that violate a hard one drop out, or where all do, all but the best."""
        seen: dict[Assignment, Judgement] = {}
        bent: dict[tuple[int, ...], Judgement] = {}  # a free limb's elbow changes nothing
        for one in sorted(s.open, key=lambda one: one[::-1]):
            mine = tuple(one[i] for i in s.holders())
            if mine not in bent:
                bent[mine] = self.judge(s, swing, grabbed, one)
            seen[one] = bent[mine]
        left = list(seen)
        for check in BENDS:
            if check in self.rules.hard:
                best = max(seen[one].margins[check] for one in left)
                tie = BETTER * max(1.0, abs(best))
                left = [one for one in left if seen[one].margins[check] >= min(best - tie, -EPS)]
        taken = left[0]
        for one in left[1:]:
            if self.is_preferred(s, seen[one], seen[taken], one, taken):
                taken = one
        seen[taken].good = set(left)
        return seen[taken]

    def is_preferred(self, s: PlainStance, new: Judgement, old: Judgement, one: Assignment, other: Assignment) -> bool:
        """For less load where the split depends on elbows, else limb by limb."""
        pose, carriers = self.pose(s), self.carriers(s, self.pose(s), [[] for _ in range(self.n)])
        split = len(carriers) >= 3 or (len(carriers) == 2 and self.rules.force_rule != "thesis")
        if split:
            if new.met != old.met:
                return new.met
            if abs(new.load - old.load) > (1e-9 if len(carriers) == 2 else BETTER):
                return new.load < old.load
            if abs(new.margins["joint"] - old.margins["joint"]) > EPS:
                return new.margins["joint"] > old.margins["joint"]
        for i in s.holders():
            if one[i] == other[i]:
                continue
            both = [option(self.robot.limbs[i], pose, self.place(s.hold[i] or 0), b) for b in (0, 1)]
            mine = next((c for c in carriers if c.index == i), None)
            if mine is not None and split:
                return one[i] == 0
            force = new.forces[i]
            if mine is None:
                return one[i] == best_option([(o, (0.0, 0.0)) for o in both]).branch
            if math.isnan(force[0]):
                return one[i] == best_option([(o, (NO_SPLIT_TORQUE, NO_SPLIT_TORQUE)) for o in both]).branch
            return one[i] == best_option([(o, torques(mine, o, force)) for o in both]).branch
        return False

    def judge(
        self, s: PlainStance, swing: Swing | None, grabbed: set[int], bent: Assignment | None = None
    ) -> Judgement:
        limbs, rules, pose = self.robot.limbs, self.rules, self.pose(s)
        holders = s.holders()
        zero = [(0.0, 0.0)] * self.n
        margins = dict.fromkeys(CHECKS, math.nan)
        if not holders:
            margins["support"] = -1.0
            return Judgement(margins, zero, math.nan, [0] * self.n, zero)

        both: list[list[Option]] = []
        usables: list[list[Option]] = []
        tips: list[Point] = []
        for i, limb in enumerate(limbs):
            number, foot = s.hold[i], s.foot[i]
            if number is not None:
                target = self.place(number)
            else:
                assert foot is not None
                target = to_world(pose, foot)
            tips.append(target)
            both.append([option(limb, pose, target, b) for b in (0, 1)])
            usables.append(usable(both[i]) if bent is None or number is None else [both[i][bent[i]]])

        margins["reach"] = min(self.reach_margin(i, pose, s.hold[i] or 0, grabbing=i in grabbed) for i in holders)
        margins["joint"] = min(
            max(o.joint_margin for o in both[i] if bent is None or o.branch == bent[i]) for i in holders
        )
        margins["support"] = float(len(holders) - rules.min_supports)
        margins["hangs"] = FAR if rules.max_hangs == -1 else float(rules.max_hangs - s.hangs)
        if len(holders) == 1 and s.stage < len(self.task.goals) and not self.task.goals[s.stage].hangs:
            margins["hangs"] = -1.0

        carriers = self.carriers(s, pose, usables)
        load = shared_load(carriers, self.task)
        split, given = load.forces, load.options
        taken = [best_option([(o, (0.0, 0.0)) for o in u]) for u in usables]
        all_torques, forces = list(zero), list(zero)
        for j, c in enumerate(carriers):
            force = (math.nan, math.nan) if split is None else split[j]
            loads = [(o, self.load(c, o, split, j)) for o in c.options]
            taken[c.index] = given[j] if given else best_option(loads)
            forces[c.index] = force
            all_torques[c.index] = self.load(c, taken[c.index], split, j)
        margins["torque"] = min(
            limit - abs(t) for c in carriers for t, limit in zip(all_torques[c.index], c.limits, strict=True)
        )
        motor = self.robot.motor
        power = sum(
            (t / (joint.gear * motor.torque_constant)) ** 2 * motor.resistance
            for c in carriers
            for t, joint in zip(all_torques[c.index], (c.limb.shoulder, c.limb.elbow), strict=True)
        )
        margins["power"] = FAR if rules.max_power is None else rules.max_power - power
        margins["clearance"] = clearance(self.task, (pose.x, pose.y))
        margins["swing"] = (
            FAR if swing is None else swing_clearance(self.task, swing.centre, swing.radius, swing.start, swing.turn)
        )
        if swing is not None and rules.max_swing < math.pi:
            margins["swing"] = min(margins["swing"], swing.radius * (rules.max_swing - abs(swing.turn)))
        own = [s.hold[i] if s.hold[i] is not None else s.left[i] for i in range(self.n)]
        margins.update(interference_margins(self.task, pose, taken, tips, own))
        margins["hook"] = self.hook(carriers, 0.0 if swing is None else swing.turn)
        held = [h for h in s.hold if h is not None]
        margins["shared"] = -1.0 if len(set(held)) < len(held) else 0.0
        xs = [c.hold.x for c in carriers]
        within = min(max(xs) - pose.x, pose.x - min(xs)) if len(xs) > 1 else 0.0
        margins["stability"] = within - rules.inside
        margins["holder_peg"] = min(
            holder_room(self.task, pose, limbs[i], taken[i], self.holds[s.hold[i] or 0]) for i in holders
        )
        return Judgement(margins, all_torques, power, [o.branch for o in taken], forces, load.value, load.met)

    def carriers(self, s: PlainStance, pose: Pose, usables: list[list[Option]]) -> list[Carrier]:
        holders = s.holders()
        if len(holders) >= 3 and self.rules.limb_in_use == "idle":
            holders = [i for i in holders if i != s.in_use]
        found: list[Carrier] = []
        for i in holders:
            limb, hold = self.robot.limbs[i], self.holds[s.hold[i] or 0]
            default = self.robot.motor.torque_limit
            limits = [default if j.torque_limit is None else j.torque_limit for j in (limb.shoulder, limb.elbow)]
            r = (hold.x - pose.x, hold.y - pose.y)
            found.append(Carrier(i, limb, hold, r, port_in_world(limb, pose), usables[i], (limits[0], limits[1])))
        return found

    def load(self, c: Carrier, o: Option, split: list[Point] | None, j: int) -> tuple[float, float]:
        return (NO_SPLIT_TORQUE, NO_SPLIT_TORQUE) if split is None else torques(c, o, split[j])

    def hook(self, carriers: list[Carrier], turn: float) -> float:
        """Margin [N], of the best branches."""
        W, cone, pull = self.robot.weight, self.rules.hook_cone, self.rules.hook_pull
        if len(carriers) == 1:
            return max(hang_margins(carriers[0], W, turn, cone, pull).values())
        if len(carriers) == 2:
            return max(pair_margins(carriers[0], carriers[1], W, cone, pull).values())
        return max(
            many_margin(carriers, list(options), W, cone, pull)
            for options in itertools.product(*(c.options for c in carriers))
        )

    # Goals

    def centre(self) -> Point | None:
        """Centre of the first goal that counts turns."""
        return next((g.centre for g in self.task.goals if g.turns is not None), None)

    def count_laps(self, before: PlainStance, after: PlainStance) -> None:
        centre = self.centre()
        if centre is None:
            return
        now, then = (self.bearing(self.pose(s), centre) for s in (after, before))
        if now - then > math.pi:
            after.laps -= 1
        elif now - then < -math.pi:
            after.laps += 1

    def bearing(self, pose: Pose, centre: Point) -> float:
        return math.atan2(pose.y - centre[1], pose.x - centre[0])

    def met(self, s: PlainStance, goal: Any) -> bool:
        pose, start = self.pose(s), self.task.start
        for value, low, high in ((pose.x, goal.x_min, goal.x_max), (pose.y, goal.y_min, goal.y_max)):
            if (low is not None and value < low - EPS) or (high is not None and value > high + EPS):
                return False
        if not angle_within(pose.angle, goal.theta_min, goal.theta_max):
            return False
        if goal.region is not None:
            corners = [(float(x), float(y)) for x, y in goal.region]
            here = (pose.x, pose.y)
            on_edge = any(
                point_to_segment(here, a, b) <= EPS for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
            )
            if not (on_edge or contains(corners, here)):
                return False
        names = [limb.name for limb in self.robot.limbs]
        if any(s.hold[names.index(name)] != number for name, number in goal.holds.items()):
            return False
        if goal.turns is not None:
            first = self.bearing(Pose(start.x, start.y, start.theta), goal.centre)
            total = 2.0 * math.pi * s.laps + self.bearing(pose, goal.centre) - first
            if math.copysign(1.0, goal.turns) * (total - 2.0 * math.pi * goal.turns) < -EPS:
                return False
        return True


def angle_within(angle: float, low: float | None, high: float | None) -> bool:
    """Whether some whole number of turns brings the angle [rad] into [low, high]."""
    if low is None and high is None:
        return True
    if low is None or high is None:
        here = wrap(angle)
        return (low is None or here >= low - EPS) and (high is None or here <= high + EPS)
    turns = (2.0 * math.pi * k for k in range(-2, 3))
    return any(low - EPS <= wrap(angle) + t <= high + EPS for t in turns)
