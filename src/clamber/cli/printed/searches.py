"""What `reach`, `sweep` and `bench` print."""

from typing import Literal

from .base import Count, Printed


class HoldReached(Printed):
    """One hold, and who can ever use it."""

    number: int
    first_step: int | None
    """Actions of the shortest way to a limb holding it; null: nobody ever does."""
    limbs: dict[str, int]
    """Limb to actions of the shortest way to holding it."""
    stances: Count
    """Reachable stances with a limb on it."""


class GoalReached(Printed):
    """One goal."""

    name: str
    stances: Count
    """Reachable stances where it asks for."""
    first_step: int | None


class Reach(Printed):
    """Everything that a robot can get to."""

    status: Literal["complete", "incomplete"]
    task: str
    reason: str
    model: str
    """The rules that it holds for."""
    without_hangs: bool
    stances: Count
    poses: Count
    steps: Count
    """Actions of the shortest way to the stance that is farthest in actions."""
    checks: Count
    """Actions judged."""
    seconds: float
    goal_reached: bool
    goals: list[GoalReached]
    """Sub-goals in order, then the goal."""
    holds: list[HoldReached]
    never_used: list[int]
    forbidden: dict[str, int]
    """Check to actions that it forbade."""
    closed_by: dict[str, int]
    """Check to forbidden body moves to places that nobody reaches."""
    places: dict[str, list[float | int | str | None]]
    """Column to its values, a place of the body each: `x_m`, `y_m`, `stances`, `first_step` and so on; "inf" where nothing limits."""


class Axis(Printed):
    """What varies."""

    key: str
    unit: str
    values: list[str]
    numbers: list[float] | None
    """The values in `unit`; null where they are names."""


class Mark(Printed):
    """A range of an axis that was asked to be marked."""

    key: str
    low: float
    high: float
    text: str


class SweepPoint(Printed):
    """One point of a sweep."""

    values: list[str]
    """One for each axis."""
    status: str
    """A planner's status, "no start" or "failed"."""
    length: int | None
    """Actions of the plan."""
    least_torque_Nm: float | None
    """The least that the largest joint torque of any plan can be: proved."""
    max_torque_Nm: float | None
    """Largest joint torque of the plan."""
    least_torque_oz_in: float | None
    max_torque_oz_in: float | None
    lower_bound: int | None
    """Proved: no plan has fewer actions."""
    seconds: float
    reason: str
    marked: bool
    """Whether it lies in the marks of every axis that has some."""


class Sweep(Printed):
    """A task planned at many values of its keys."""

    task: str
    planner: str
    axes: list[Axis]
    found: Count
    """Points with a plan."""
    marks: list[Mark]
    points: list[SweepPoint]
    """The last axis fastest."""


class BenchRow(Printed):
    """One measured figure."""

    name: str
    value: float | None
    """Null where there is none."""
    unit: str
    aim: str | None
    """What it should be, in words."""
