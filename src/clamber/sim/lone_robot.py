"""A robot by itself, without its world, as a MuJoCo model that can be written for other programs."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ..family import NotOfFamilyError, family_named
from ..tasks.robots import Robot


@dataclass(frozen=True, slots=True)
class JointBounds:
    """How far, how hard and how fast a joint goes, in its own units; None where the robot's file does not say."""

    lower: float
    upper: float
    effort: float | None
    speed: float | None


@dataclass(frozen=True, slots=True, eq=False)
class LoneRobot:
    """A robot's model."""

    name: str
    title: str
    spec: Any
    """An `MjSpec`, compiled once."""
    model: Any
    """The `MjModel` of it."""
    bounds: Mapping[str, JointBounds]
    """Joint -> its bounds, for joints with motors."""


def lone_robot(robot: Robot) -> LoneRobot:
    """The model of a robot as its file has it: joints without play, no payload, no noise.

    Raises:
        NotOfFamilyError: If its family has no such model.
    """
    family = family_named(robot.family)
    if family.model is None:
        raise NotOfFamilyError(family.title, "model of the robot alone")
    spec, bounds = family.model(robot)
    return LoneRobot(robot.name, robot.title, spec, spec.compile(), bounds)
