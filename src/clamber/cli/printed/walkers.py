"""What `follow`, `ditch` and `calibrate` print."""

from typing import Literal

from .base import Count, Pose, Printed


class Limit(Printed):
    """The range of a joint, an actuator or a leg that came nearest to its end."""

    name: str
    margin: float
    """In `unit`."""
    unit: str
    time: float
    """When [s]."""


class Unreachable(Printed):
    """A point of the path that the tool could not reach."""

    point: int
    """Of the path, from 0."""
    distance_m: float
    """Of the closest reachable point from it."""
    closest_m: list[float]
    """The closest reachable point: x, y, z."""
    reason: str
    """The limit that keeps it away."""


class Followed(Printed):
    """A tool path followed by arm and body; exit code 1 where the tool does not come to its end."""

    robot: str
    path: str
    dof: int
    supports: str
    """On which feet the robot stands."""
    reason: str
    reached: bool
    """Whether the tool came to the path's end."""
    seconds: float
    rms_error_m: float
    largest_error_m: float
    end_error_m: float
    mean_manipulability: float
    least_manipulability: float
    stable_gain: float | None
    closest_limit: Limit
    held_by: dict[str, float]
    """Limit to the part of the periods in which it held the motion back."""
    unreachable_points: list[Unreachable]
    unsolved_periods: Count


class SlideMargins(Printed):
    """The worst of each margin during a slide."""

    stroke_m: float
    singular: float | None
    """Over the largest singular distance; null without a singular pose near."""
    balance_m: float
    foothold_m: float


class Slide(Printed):
    """One frame moved while the other stands."""

    frame: Literal["delta", "y"]
    way: list[Pose]
    """x across the ditch from its near edge, y along it [m], angle [rad]."""
    margins: SlideMargins


class Crossing(Printed):
    """`--width`: a ditch crossed; exit code 1 where it is impossible."""

    status: Literal["found", "impossible"]
    reason: str
    width_m: float
    theta_rad: float
    """Of the Y-frame in the Delta-frame while it crosses."""
    direction_rad: float
    """Of crossing, seen from the Delta-frame."""
    widest_m: float
    """That could be crossed so."""
    pivots: Count
    start: list[Pose]
    """Of both frames."""
    slides: list[Slide]


class WidestDitch(Printed):
    """The widest ditch that is crossed at one angle of the frames."""

    theta_deg: float
    widest_m: float
    direction_deg: float
    """In which."""
    least_over_directions_m: float
    """In the worst direction."""


class Fit(Printed):
    """Sizes of the mechanism that were found from one start."""

    seed: int
    radius_delta_m: float
    radius_y_m: float
    offset_rad: float
    shortest_m: float
    first_rad: float
    least_rad: float
    """Least angle of the Y-frame that they give."""
    most_rad: float
    step_m: float
    """Longest step that they give."""
    misfit: float
    """Largest difference from what is printed, in half last places; 1 and below rounds to it."""


class Family(Printed):
    """Fits that leave the same sizes free."""

    free: list[str]
    family: str
    step_is: str
    """How the printed step is read."""
    seeds: Count
    seeds_that_fit: Count
    fits: list[Fit]
    """Different ones, the best first."""
