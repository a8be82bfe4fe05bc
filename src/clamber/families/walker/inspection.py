"""What is told of walkers, grounds and walks, and what is odd about them."""

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from ...inspection.finding import FileKind, Finding, Inspection
from ...shown_units import SI, ShownUnits
from .control.gait import lengths_at
from .planning import Walk, load_walk, walk_names
from .planning.walk import SCHEMA as WALK_SCHEMA
from .robot import WalkerRobot
from .world.ground import SCHEMA as GROUND_SCHEMA
from .world.ground import Ground, ground_names, load_ground

TWISTS: Final = np.linspace(-math.pi / 3, math.pi / 3, 241)
"""A walker's frames repeat after a third of a turn [rad]."""


def _walker_facts(robot: WalkerRobot, units: ShownUnits) -> dict[str, str]:
    mechanism, legs = robot.mechanism, robot.legs
    return {
        "family": "two-frame walker",
        "actuators": f"{units.length(mechanism.shortest)} to {units.length(mechanism.longest)}",
        "legs": f"{units.length(legs.shortest)} to {units.length(legs.longest)}",
        "feet": f"circles of {units.length(legs.radius_delta)} and {units.length(legs.radius_y)}",
        "arm": "none" if robot.arm is None else f"{robot.arm.n_joints} joints",
    }


def _odd_frames(robot: WalkerRobot) -> Iterator[str]:
    lengths = lengths_at(robot, np.outer(TWISTS, (0.0, 0.0, 1.0)))
    mechanism = robot.mechanism
    inside = ((lengths >= mechanism.shortest) & (lengths <= mechanism.longest)).all(axis=1)
    if not inside.any():
        low, high = float(lengths.min()), float(lengths.max())
        yield (
            f"the frames can't stand over each other at any angle: that takes actuators of {low:.3g} to {high:.3g} m, "
            f"and they have {mechanism.shortest:.3g} to {mechanism.longest:.3g} m"
        )


def inspect_ground(ground: Ground, units: ShownUnits = SI) -> Finding:
    """Facts of a ground, and what is odd about it."""
    facts = {
        "slope": f"{np.degrees(ground.slope):.4g} deg, rising towards {np.degrees(ground.uphill):.4g} deg",
        "size": f"{units.length(ground.x_max - ground.x_min)} x {units.length(ground.y_max - ground.y_min)}",
        "friction": f"{ground.friction:.3g}",
        "blocks": str(len(ground.blocks)),
        "rough parts": str(len(ground.rough)),
        "forbidden patches": str(len(ground.patches)),
    }
    return Finding(kind="ground", name=ground.name, title=ground.title, facts=facts, odd=tuple(_odd_ground(ground)))


def _odd_ground(ground: Ground) -> Iterator[str]:
    if np.tan(ground.slope) > ground.friction:
        yield (
            f"the slope is steeper than friction holds: feet slide on it above {np.degrees(np.arctan(ground.friction)):.3g} deg"
        )
    for key, corners in (
        *((f"blocks.{i}", block.corners()) for i, block in enumerate(ground.blocks)),
        *((f"rough.{i}", rough.corners()) for i, rough in enumerate(ground.rough)),
        *((f"patches.{i}", patch) for i, patch in enumerate(ground.forbidden())),
    ):
        xs, ys = np.array(corners).T
        beyond = (
            xs.max() <= ground.x_min or xs.min() >= ground.x_max or ys.max() <= ground.y_min or ys.min() >= ground.y_max
        )
        if beyond:
            yield f"{key} lies beyond the ends of the ground, where there is nothing"


def inspect_walk(walk: Walk, units: ShownUnits = SI) -> Finding:
    """Facts of a walk."""
    straight = sum(piece.distance or 0.0 for piece in walk.way)
    turned = sum(abs(piece.turn or 0.0) for piece in walk.way)
    places = sum(piece.to is not None for piece in walk.way)
    legs = walk.start_legs()
    facts = {
        "robot": walk.robot.name,
        "ground": walk.ground.name,
        "way": f"{len(walk.way)} pieces: {units.length(straight)} straight, {math.degrees(turned):.4g} deg turned, {places} to a place",
        "plate": "kept level" if walk.level else "as it stands at the start",
        "legs at the start": f"{units.small(legs.min())} to {units.small(legs.max())}",
    }
    return Finding(kind="walk", name=walk.name, title=walk.title, facts=facts)


def inspect_walker(robot: WalkerRobot, units: ShownUnits = SI) -> Finding:
    """Facts of a walker, and what is odd about it."""
    odd = tuple(_odd_frames(robot))
    return Finding(kind="robot", name=robot.name, title=robot.title, facts=_walker_facts(robot, units), odd=odd)


INSPECTION: Final = Inspection(
    robot=inspect_walker,
    kinds={
        "ground": FileKind(GROUND_SCHEMA, ground_names, load_ground, inspect_ground),
        "walk": FileKind(WALK_SCHEMA, walk_names, load_walk, inspect_walk),
    },
)
