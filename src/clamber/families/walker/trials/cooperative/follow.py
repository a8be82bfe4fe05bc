"""A walker that stands follows a tool path with arm and body: the run, and what it came to."""

from dataclasses import dataclass
from operator import attrgetter
from typing import Annotated, Any, Final

import numpy as np

from .....execution.log import Log
from .....json_form import HIDDEN, Count, Jsonable, Key, in_json
from .....types import Floats
from ...control.cooperative.closest import Reach, ReachSearch
from ...control.cooperative.cooperator import Cooperator, stable_gain
from ...control.cooperative.freedoms import SUPPORT, Freedoms, freedoms_of, weights_of
from ...control.cooperative.limits import freedom_names
from ...control.cooperative.planted_feet import N_ROWS, ROW_UNITS, PlantedFeet
from ...control.cooperative.settings import Cooperation, CooperationError, own_speeds
from ...robot import WalkerRobot
from .simulated_body import SimulatedBody
from .tool_path import TimedPath, ToolPath

NEAR: Final = 1e-3
"""A run reaches the end of its path if the tool is as near as this [m]."""
NEAR_IN_DYNAMICS: Final = 5e-3
"""Likewise in contact dynamics, where feet and legs give [m]."""
PATIENCE: Final = 5e-3
"""A path without times waits for the tool: it stands still while the tool is as far off as this [m], and goes on in between."""
SLOWEST: Final = 0.02
"""A path that waits goes on at less than this part of its pace while the tool is as good as stuck."""
STUCK: Final = 2.0
"""A run ends when the tool has been stuck for so long [s]."""
SETTLE: Final = 1.0
"""Time after the end of the path [s]."""
LOOKED_AT: Final = 41
"""Places of the path that are looked at beforehand."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FollowOptions:
    """How a path is followed."""

    dof: int
    """Degrees of freedom that take part: with an arm of four joints 4, 5, 7 or 10."""
    gain: float = 1.0
    """k_p of the manipulability's gradient."""
    speed: float = 0.05
    """Largest of the tool where the path has no times [m/s]."""
    tool_speed: float = 0.2
    """Largest that the law commands [m/s]."""
    payload: float = 0.0
    """Carried at the tool [kg]."""
    balance: float = 0.0
    """Least distance of the centre of mass from the support's edges [m]."""
    height: float | None = None
    """Of the plate over level ground at the start [m]; None: legs of nominal length."""
    period: float = 0.02
    """[s]."""
    dynamics: bool = False
    """Whether a robot in contact dynamics is led through the motion; else the motion is all there is."""
    felt: bool = True
    """In dynamics: whether the law makes up for what the robot's own sensors say that the tool is off."""


@dataclass(frozen=True, slots=True)
class ClosestLimit:
    """The range of a joint, an actuator or a leg that came nearest to its end."""

    name: str
    margin: float
    """In `unit`."""
    unit: str
    time: float
    """When [s]."""


@dataclass(frozen=True, slots=True, eq=False)
class UnreachablePoint:
    """A point of the path that the tool could not reach."""

    point: int
    """Of the path, from 0."""
    reach: Annotated[
        Reach,
        Key("distance_m", get=attrgetter("distance"), kind=float, meaning="Of the closest reachable point from it."),
        Key("closest_m", get=attrgetter("place"), kind=list[float], meaning="The closest reachable point: x, y, z."),
        Key("reason", get=attrgetter("reason"), kind=str, meaning="The limit that keeps it away."),
    ]


@dataclass(frozen=True, slots=True, eq=False)
class FollowRun(Jsonable):
    """A tool path followed by arm and body, a row for each period; exit code 1 where the tool does not come to its end."""

    robot: Annotated[WalkerRobot, Key(get=attrgetter("name"), kind=str)]
    path: Annotated[ToolPath, Key(get=attrgetter("label"), kind=str)]
    options: Annotated[FollowOptions, Key("dof", get=attrgetter("dof"), kind=int)]
    freedoms: Annotated[Freedoms, HIDDEN]
    footing: Annotated[
        PlantedFeet, Key("supports", get=attrgetter("support"), kind=str, meaning="On which feet the robot stands.")
    ]
    time: Annotated[Floats, HIDDEN]
    """[s], shape (rows,)."""
    q: Annotated[Floats, HIDDEN]
    """Freedoms, shape (rows, m)."""
    places: Annotated[Floats, HIDDEN]
    """Of the tool, world [m], shape (rows, 3); in dynamics where it truly is."""
    wanted: Annotated[Floats, HIDDEN]
    """Where it was to be [m], shape (rows, 3)."""
    on_path: Annotated[Floats, HIDDEN]
    """Whether the approach is over, shape (rows,), 0 or 1."""
    measure: Annotated[Floats, HIDDEN]
    """V of the normalised chain [-], shape (rows,)."""
    values: Annotated[Floats, HIDDEN]
    """What is limited, in the order of `names`, shape (rows, ranges)."""
    limits: Annotated[tuple[Floats, Floats], HIDDEN]
    """Least and largest of it, each of shape (ranges,)."""
    names: Annotated[tuple[str, ...], HIDDEN]
    """Of ranges, then of speeds."""
    held: Annotated[dict[str, float], Key("held_by", after="closest_limit")]
    """Limit -> part of the time on the path for which it held the motion back, the most first."""
    unreachable: Annotated[tuple[tuple[int, Reach], ...], HIDDEN]
    """Points of the path, counted from 0 along it, that the robot cannot reach standing so, of those looked at beforehand."""
    end: Annotated[Reach, HIDDEN]
    """The reachable place nearest to the path's last point, from where the run ended."""
    unsolved: Annotated[Count, Key("unsolved_periods", after="unreachable_points")]
    """Periods in which the law found no motion and rested."""
    stable_gain: Annotated[float, Key(kind=float | None, after="least_manipulability")]
    """k_p above which the motion would swing about a summit of V, by the run's last posture [-]."""

    @property
    def errors(self) -> Floats:
        """Distance of the tool from where it was to be, on the path [m]."""
        on = self.on_path > 0.0
        out: Floats = np.linalg.norm(self.places[on] - self.wanted[on], axis=1)
        return out

    @property
    def near(self) -> float:
        """How near to the path's last point counts as there [m]."""
        return NEAR_IN_DYNAMICS if self.options.dynamics else NEAR

    @property
    @in_json(key="end_error_m", after="largest_error_m")
    def off_end(self) -> float:
        """Distance of the tool from the path's last point at the end [m]."""
        return float(np.linalg.norm(self.places[-1] - self.path.points[-1]))

    @property
    @in_json(after="supports")
    def reason(self) -> str:
        """Whether the path was followed to its end; else why not."""
        if self.off_end <= self.near:
            if not self.unreachable:
                return "followed to its end"
            worst = max((reach for _, reach in self.unreachable), key=lambda reach: reach.distance)
            return f"followed to its end, past points {worst.reason}"
        if not self.end.reached:
            return f"its end is {self.end.reason}"
        return f"the tool ended {1e3 * self.off_end:.1f} mm off, though the end can be reached: the tool was stuck on the way"

    @in_json(key="closest_limit", after="stable_gain")
    def closest_range(self) -> ClosestLimit:
        """The limit that the run came nearest to, relative to its range.

        Limits on one side count relative to their largest margin in the run.
        """
        low, high = self.limits
        margins = np.minimum(self.values - low, high - self.values)
        bounded = (np.isfinite(low) | np.isfinite(high)) & (np.abs(self.values) < 1e8).all(axis=0)
        both = np.isfinite(low) & np.isfinite(high)
        spans = np.maximum(margins.max(axis=0), 1e-9)
        spans[both] = 0.5 * (high - low)[both]
        columns = np.flatnonzero(bounded)
        shares = margins[:, columns] / spans[columns]
        row, place = np.unravel_index(int(np.argmin(shares)), shares.shape)
        column = int(columns[place])
        joints = len(low) - N_ROWS
        unit = "rad" if column < joints else ROW_UNITS[column - joints]
        return ClosestLimit(self.names[column], float(margins[row, column]), unit, float(self.time[row]))

    @in_json(key="reached", after="reason")
    def at_end(self) -> bool:
        """Whether the tool came to the path's end."""
        return self.off_end <= self.near

    @property
    @in_json(after="reached")
    def seconds(self) -> float:
        """That it took."""
        return float(self.time[-1])

    @property
    @in_json(key="rms_error_m", after="seconds")
    def rms_error(self) -> float:
        """Root mean square of the tool's distance from where it was to be, on the path."""
        return float(np.sqrt(np.mean(self.errors**2)))

    @property
    @in_json(key="largest_error_m", after="rms_error_m")
    def largest_error(self) -> float:
        """Largest such distance."""
        return float(self.errors.max())

    @property
    @in_json(after="end_error_m")
    def mean_manipulability(self) -> float:
        """Mean of V on the path."""
        return float(self.measure[self.on_path > 0.0].mean())

    @property
    @in_json(after="mean_manipulability")
    def least_manipulability(self) -> float:
        """Least V on the path."""
        return float(self.measure[self.on_path > 0.0].min())

    @in_json(after="held_by")
    def unreachable_points(self) -> tuple[UnreachablePoint, ...]:
        """Points of the path that the tool could not reach."""
        return tuple(UnreachablePoint(k, reach) for k, reach in self.unreachable)

    def log(self) -> Log:
        """Every row, for a file."""
        columns: dict[str, Floats] = {"time": self.time}
        units = {"time": "s"}
        for k, name in enumerate(freedom_names(self.robot)):
            columns[name] = self.q[:, k]
            units[name] = "m" if k < 3 else "rad"
        for k, axis in enumerate("xyz"):
            columns[f"tool {axis}"], columns[f"wanted {axis}"] = self.places[:, k], self.wanted[:, k]
            units[f"tool {axis}"] = units[f"wanted {axis}"] = "m"
        columns["on path"], columns["manipulability"] = self.on_path, self.measure
        for k, unit in enumerate(ROW_UNITS, start=len(self.limits[0]) - N_ROWS):
            if (np.abs(self.values[:, k]) < 1e8).all():
                columns[self.names[k]] = self.values[:, k]
                units[self.names[k]] = unit
        notes = {"robot": self.robot.name, "path": self.path.label, "dof": str(self.options.dof), "end": self.reason}
        return Log(columns, units, notes, self.path.label)


def follow_path(robot: WalkerRobot, path: ToolPath, options: FollowOptions) -> FollowRun:
    """Follow a path from the arm's rest posture: straight to its first point, then along it.

    Raises:
        CooperationError: If an option cannot be.
        FreedomsError: If no set has so many degrees of freedom.
        LimitError: If the robot cannot stand so.
    """
    arm = robot.arm
    if arm is None:
        raise CooperationError("robot", repr(robot.name), "must have an arm")
    for name in ("speed", "tool_speed"):
        if not 0.0 < getattr(options, name) < np.inf:
            raise CooperationError(name, getattr(options, name), "must be over 0 m/s")
    freedoms = freedoms_of(options.dof, arm.n_joints)
    height = robot.legs.nominal if options.height is None else options.height
    q = np.array([0.0, 0.0, height, 0.0, 0.0, 0.0, *arm.rest])
    footing = PlantedFeet(robot=robot, support=SUPPORT[freedoms], pose=q[:6], payload=options.payload)
    settings = Cooperation(
        speeds=own_speeds(robot),
        tool_speeds=np.full(3, options.tool_speed),
        gain=options.gain,
        period=options.period,
        balance=options.balance,
    )
    body = None
    if options.dynamics:
        body = SimulatedBody(robot, footing.support, height, options.payload, options.period)
        footing, q = body.footing, body.start
    law, weights = Cooperator(robot, settings, footing), weights_of(freedoms, arm.n_joints)
    law.check_weights(weights)
    law.check_start(q)
    search = ReachSearch(robot, footing, weights, balance=options.balance)
    unreachable = _look_ahead(search, path, q)
    start = law.place(q)
    approach = ToolPath(path.label, np.array([start, path.points[0]]), None)
    parts: list[tuple[TimedPath, bool]] = [(path.sample(options.speed), True)]
    if not np.array_equal(start, path.points[0]):
        parts.insert(0, (approach.sample(options.speed), False))
    rows = _Rows(law, q, weights, body, options.felt)
    for timed, counts in parts:
        rows.follow(timed, counts, waits=timed.by_way)
    q, places, wanted, on, measure, values = map(np.array, zip(*rows.kept, strict=True))
    held = {law.names[k]: count / max(1.0, on.sum()) for k, count in rows.tight.items()}
    return FollowRun(
        robot, path, options, freedoms, footing,
        np.arange(len(on), dtype=np.float64) * options.period, q, places, wanted, on, measure, values, law.limits(), law.names,
        dict(sorted(held.items(), key=lambda item: -item[1])), unreachable, search.find(rows.at, path.points[-1]),
        rows.unsolved, stable_gain(law, rows.at, weights),
    )  # fmt: skip


class _Rows:
    """Runs the law along parts of a path and keeps a row for each period."""

    def __init__(self, law: Cooperator, q: Floats, weights: Floats, body: SimulatedBody | None, felt: bool) -> None:
        self.law, self.at, self.weights, self.body, self.felt = law, q, weights, body, felt
        self.kept: list[tuple[Any, ...]] = []
        """Of each period: freedoms, where the tool is and where it was to be, whether on the path, V, what is limited."""
        self.tight: dict[int, int] = {}
        self.unsolved = 0

    def follow(self, timed: TimedPath, counts: bool, *, waits: bool) -> None:
        period = self.law.settings.period
        moment, stuck = 0.0, 0.0
        ends = timed.lasts + SETTLE
        while moment <= ends and stuck <= STUCK:
            target, velocity = timed.at(moment)
            place = self.law.place(self.at) if self.body is None else self.body.move(self.law, self.at)
            aim = target if self.body is None or not self.felt else target - self.body.off
            pace = 1.0
            if waits and moment < timed.lasts:
                pace = max(0.0, 1.0 - float(np.linalg.norm(target - place)) / PATIENCE)
            step = self.law.step(self.at, aim, pace * velocity, self.weights)
            self.kept.append((self.at, place, target, float(counts), step.measure, self.law.limited_values(self.at)))
            if counts:
                for k in step.tight:
                    self.tight[k] = self.tight.get(k, 0) + 1
            self.unsolved += not step.solved
            self.at = step.q
            moment += pace * period
            stuck = stuck + period if pace < SLOWEST else 0.0


def _look_ahead(search: ReachSearch, path: ToolPath, q: Floats) -> tuple[tuple[int, Reach], ...]:
    """Which points of a path cannot be reached, of so many as `LOOKED_AT` at most."""
    looked = np.unique(np.linspace(0, len(path.points) - 1, LOOKED_AT).round().astype(int)).tolist()
    out = []
    for k in looked:
        found = search.find(q, path.points[k], postures=False)
        if not found.reached:
            found = search.find(q, path.points[k])
        if found.reached:
            q = found.q
        else:
            out.append((k, found))
    return tuple(out)
