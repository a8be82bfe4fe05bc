"""How a walker walks: thresholds, speeds and waiting times, each with its reason."""

import math
from dataclasses import dataclass

from ..control.gait import Limits


@dataclass(frozen=True, slots=True, kw_only=True)
class WalkSettings:
    """What a robot's file does not say of its walking."""

    level: bool = True
    """Whether the plate is kept level; if not, it keeps the tilt of the start, and its steps are judged as if that were level."""
    limits: Limits = Limits()  # noqa: RUF009  # frozen
    """How far steps use what the robot can."""
    lift: float | None = None
    """By how much a lifted foot clears the ground that is expected on its way [m]; None: as the robot's file says."""
    clear: float | None = 0.02
    """A slide begins and ends with its feet so far above the expected ground [m], which saves time; None: by all of `lift`."""
    touch: float = 15.0
    """A foot that the ground pushes with more than this is on it [N]: seven deviations of a load cell. What it pushes back until it stops
    tilts the plate; the loads of standing feet are 60 N and more ..."""
    touches: int = 2
    """... for so many samples."""
    settling: float = 2.0
    """For which the robot stands on six feet and levels, before a frame is lifted [s]."""
    ramp: float = 0.5
    """In which a slide comes to its speed [s]; shorter ones break the feet's friction."""
    ease_speed: float = 0.0005
    """At which standing feet are lifted until the ground pushes them no more, so that the others take their load in time [m/s] ..."""
    ease: float = 0.006
    """... at most so far [m]: feet, ground and legs give way by a millimetre or two."""
    trim: float = 4.0
    """Part of a standing leg's error of length that is made up for in a second: a loaded leg gives way by half a millimetre [1/s]."""
    share: float = 1.0
    """Part of what a leg carries beyond its even share that is passed on in a second while more than three stand [1/s]."""
    near: float = 0.004
    """From so far above the ground as it is expected, feet go down more slowly [m] ..."""
    near_speed: float = 0.0015
    """... at this speed [m/s]: what a leg goes on until it is stopped tilts the plate."""
    deepest: float = 0.06
    """A foot that finds no ground so far below the expected has none [m]."""
    landing_doubt: float = math.radians(0.017)
    """How far feet that take or lose load may tilt the plate without its legs telling [rad]."""
    level_within: float = math.radians(0.03)
    """The plate counts as level within this [rad]."""
    probe: float = 0.0
    """By how much feet are pushed to every side where they have come down, before they are relied upon [m]; 0: they are not. More than 0
    also means that the ground may be rough: feet are lifted over all that has been found so far."""
    longest: float = math.inf
    """A step goes no farther than this [m]."""

    def __post_init__(self) -> None:
        for key in (
            "touch",
            "settling",
            "ease",
            "deepest",
            "level_within",
            "ramp",
            "ease_speed",
            "near_speed",
            "longest",
        ):
            if not getattr(self, key) > 0.0:
                raise ValueError(f"{key} = {getattr(self, key)}: must be more than 0")
        for key in ("trim", "share", "landing_doubt", "probe", "near"):
            if not 0.0 <= getattr(self, key) < math.inf:
                raise ValueError(f"{key} = {getattr(self, key)}: must be 0 or more, and finite")
        if self.touches < 1:
            raise ValueError(f"touches = {self.touches}: must be 1 or more")
        for key in ("lift", "clear"):
            value = getattr(self, key)
            if value is not None and not 0.0 < value < math.inf:
                raise ValueError(f"{key} = {value}: must be more than 0, and finite")
