"""A robot or a world in space by itself: a task that is never planned stands around it."""

from typing import Final

import numpy as np
from matplotlib.axes import Axes

from ....tasks.robots import read_robot, robot_names
from ....types import Floats, Json
from ....units import GRAVITY
from ....viewing.alone import Alone
from ....viewing.scene import halo
from ..planning.task import Lattice, Rules, SpatialTask, Start
from ..robot.kinematics import Posed, centre_of_mass, link_frames
from ..robot.robot import SpatialRobot, build_robot
from ..world.guide import GRAIN, Waypoint
from ..world.solids import Plane
from ..world.world import World
from .camera import camera_for
from .moments import SWINGING, Moment
from .robot_artists import RobotArtists, limb_colour
from .spatial_view import robot_corners
from .world_artists import draw_world, picture_bounds

FROM: Final = "-63,30"
"""So that no limb of a robot with limbs at its corners hides another."""
ROOM: Final = 0.12
"""Floor that is seen around a robot, over its own width [-]."""


def _around(robot: SpatialRobot, world: World, height: float, document: Json) -> SpatialTask:
    """What stands in for a task; `document` has the documents of the robot and of what else is shown."""
    half = 0.5 * GRAIN * (len(world.frames) - 1)
    return SpatialTask(
        name=world.name,
        title=world.title,
        robot=robot,
        world=world,
        start=Start(along=half, height=height),
        step=Lattice(length=0.01, height=0.01, angle=0.1),
        goals=(),
        rules=Rules(),
        document=document,
    )


def robot_alone(robot: SpatialRobot, document: Json) -> Alone:
    """A robot in its nominal posture over a floor, its limbs named."""
    chains = robot.chains
    level = link_frames(chains, Posed(np.zeros(3), np.eye(3), chains.nominal))
    lowest = min(float(level.origins[..., 2].min()), -float(chains.base_half[2]))
    reach = max(chains.longest_limb, GRAIN)
    at = Posed(np.array((reach, 0.0, -lowest)), np.eye(3), chains.nominal)
    floor = (
        Waypoint(at=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0)),
        Waypoint(at=(2.0 * reach, 0.0, 0.0)),
    )
    ground = Plane(kind="plane", at=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))
    world = World(
        name=robot.name, title=robot.title, gravity=(0.0, 0.0, -GRAVITY), holds=(), solids=(ground,), guide=floor
    )
    task = _around(robot, world, -lowest, {"robot": document})
    moment = _unloaded(task, at)
    camera = camera_for(task, FROM)
    robot_places = robot_corners(task, [moment])
    shown = np.vstack((robot_places, _floor_about(robot_places)))
    bounds = picture_bounds(camera, shown)

    def draw(axes: Axes) -> None:
        draw_world(axes, task, camera, shown, bounds)
        RobotArtists(axes, task, camera, bounds).update(moment)
        for limb, (name, tip) in enumerate(zip(chains.limb_names, camera.flat(moment.tips), strict=True)):
            axes.annotate(
                name,
                tuple(tip),
                xytext=(0, -9),
                textcoords="offset points",
                ha="center",
                va="top",
                fontsize=8,
                weight="bold",
                color=limb_colour(limb),
                zorder=9,
                path_effects=[halo(2.5)],
            )

    return Alone(task, bounds, draw, moment)


def _floor_about(places: Floats) -> Floats:
    """Corners of the floor under some places, with room around them [m], shape (4, 3)."""
    low, high = places.min(axis=0), places.max(axis=0)
    room = ROOM * float((high - low)[:2].max())
    return np.array([(x, y, 0.0) for x in (low[0] - room, high[0] + room) for y in (low[1] - room, high[1] + room)])


def _unloaded(task: SpatialTask, at: Posed) -> Moment:
    """A robot that touches nothing."""
    chains = task.robot.chains
    frames = link_frames(chains, at)
    limbs = len(chains.limb_names)
    return Moment(
        at,
        np.zeros(6),
        frames,
        (SWINGING,) * limbs,
        np.full((limbs, 3), np.nan),
        np.full((limbs, 6), np.nan),
        np.zeros(chains.lower.shape),
        centre_of_mass(chains, at, frames),
        np.zeros(0),
    )


def world_alone(world: World, document: Json) -> Alone:
    """A world; what is asked of a robot, such as how far around the guide holds are shown, one that comes with Clamber says."""
    read = read_robot(robot_names("spatial")[0])
    task = _around(build_robot(read), world, 0.1, {"world": document, "robot": read.data})
    camera = camera_for(task, None)
    shown = np.vstack((world.places, world.frames[:: max(1, len(world.frames) // 50), :3]))
    bounds = picture_bounds(camera, shown)
    return Alone(task, bounds, lambda axes: draw_world(axes, task, camera, shown, bounds))
