"""A world in space on the axes of a picture: surfaces with a quiet grid, holds as discs in their surface, guide, goals, scale."""

import math
from collections import Counter
from typing import Final, TypeAlias

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.path import Path
from matplotlib.transforms import Bbox

from ....types import Floats
from ....units import DEGREE
from ....viewing import style
from ....viewing.scene import GOAL_WORDS, Bounds, fit_bounds, halo
from ..planning.task import Goal, SpatialTask
from ..world.guide import GRAIN
from ..world.solids import frame_about
from .camera import Camera
from .surfaces import Face, guide_ribbon, round_length, surfaces_of

SHADES: Final = ("#D3D8DE", "#F6F7F9")
"""Colour of a face that the light passes by, and of one that it falls on straight."""
RELIEF: Final = "#8E9AA6"
"""The former of a terrain, whose shape nothing else shows."""
LIGHT: Final = np.array((-0.35, 0.75, 0.55))
"""Where the light comes from: right, up and towards the camera, of any length."""
GRID: Final = "#22303C1C"
"""Ink, thinned."""
EDGE: Final = "#AEB7C0"
HOLDS: Final = "#B4BDC6"
FAR_SIDE: Final = "#CBD1D8"
"""Colour of holds that are seen from behind."""
LEAST_HOLD: Final = 0.006
"""Least radius of a drawn hold, over the larger side of the picture [-]."""
CORNERS: Final = 14
MANY: Final = 60
"""Faces of what is no flat solid, none of which is taken away from before the robot."""
MOST_NORMALS: Final = 700
"""Worlds with more holds show them without their normals."""
MOST_NUMBERED: Final = 70
"""Worlds with more holds show them without their numbers."""

LETTER: Final = 0.01
"""About how wide a letter of a goal's name is, over the larger side of the picture [-]."""
Colour: TypeAlias = tuple[float, float, float]
"""Red, green and blue in [0, 1]."""
Name: TypeAlias = tuple[float, float, float]
"""From where to where a goal's name goes in the picture's plane, and how high [m]."""


def picture_bounds(camera: Camera, shown: Floats) -> Bounds:
    """The part of a picture's plane that holds some places, shape (n, 3), with room around them [m]."""
    return fit_bounds(camera.flat(shown), ())


def larger_side(bounds: Bounds) -> float:
    """Of a picture [m]."""
    return max(bounds[1] - bounds[0], bounds[3] - bounds[2])


def draw_world(axes: Axes, task: SpatialTask, camera: Camera, shown: Floats, bounds: Bounds) -> None:
    """Draw the world of a task: what stands before the guide is drawn over it, as glass.

    Args:
        axes: The picture's, which get their limits.
        task: World and goals.
        camera: From where.
        shown: Places that are to be seen, world frame [m], shape (n, 3).
        bounds: Of the picture's plane.
    """
    set_axes(axes, bounds)
    axes.set(xticks=[], yticks=[])
    surfaces = surfaces_of(task.world, shown)
    planes = {k for k, solid in enumerate(task.world.solids) if solid.kind == "plane"} | {-1}
    front = {id(face): float(face.normal @ camera.axes[2]) > 1e-6 for face in surfaces.faces}
    seen = [face for face in surfaces.faces if front[id(face)] or face.solid in planes]
    seen.sort(key=lambda face: float(camera.depth(face.corners).mean()))
    few = Counter(face.solid for face in seen)
    glass = [face for face in seen if not front[id(face)] or (few[face.solid] < MANY and _hides(face, camera, task))]
    clear = {id(face) for face in glass}
    solid = [face for face in seen if id(face) not in clear]
    _draw_faces(axes, solid, camera)
    axes.add_collection(LineCollection(list(camera.flat(surfaces.lines)), colors=GRID, linewidths=0.6, zorder=1.2))
    _draw_glass(axes, glass, camera)
    names = [_draw_goal(axes, task, goal, k, camera, bounds) for k, goal in enumerate(task.goals)]
    _draw_guide(axes, task, camera)
    _draw_holds(axes, task, camera, bounds)
    _draw_scale(axes, task, camera, shown, bounds, [name for name in names if name is not None])


def set_axes(axes: Axes, bounds: Bounds) -> None:
    """Limits and looks of the axes of a picture or a map."""
    axes.set(xlim=bounds[:2], ylim=bounds[2:])
    axes.set_aspect("equal")
    axes.set_facecolor(style.PAPER)
    for spine in axes.spines.values():
        spine.set_color(style.FAINT)


def mixed(colour: str | Colour, other: str | Colour, share: float) -> Colour:
    """A colour with a share of another."""
    a, b = (_rgb(one) for one in (colour, other))
    red, green, blue = a + share * (b - a)
    return float(red), float(green), float(blue)


def _rgb(colour: str | Colour) -> Floats:
    if isinstance(colour, str):
        return np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0
    return np.array(colour)


def shade(normal: Floats, camera: Camera, darkest: str = SHADES[0]) -> Colour:
    """Colour of a face by how the light falls on it; `darkest` where it passes by."""
    light = LIGHT @ camera.axes
    lit = max(0.0, float(normal @ light) / float(np.linalg.norm(light) * np.linalg.norm(normal)))
    return mixed(darkest, SHADES[1], 0.3 + 0.7 * lit)


def _draw_faces(axes: Axes, faces: list[Face], camera: Camera) -> None:
    """Faces from the farthest to the nearest; round solids and ribbons have no lines between their faces."""
    if not faces:
        return
    counts = Counter(face.solid for face in faces)
    boxy = {index for index, count in counts.items() if count <= 3}
    paint = [shade(face.normal, camera, RELIEF if counts[face.solid] >= MANY else SHADES[0]) for face in faces]
    edges = [
        EDGE if face.solid in boxy and face.solid >= 0 else colour for face, colour in zip(faces, paint, strict=True)
    ]
    axes.add_collection(
        PolyCollection(
            [camera.flat(face.corners) for face in faces],
            facecolors=paint,
            edgecolors=edges,
            linewidths=0.5,
            zorder=1.0,
        )
    )


def _draw_glass(axes: Axes, faces: list[Face], camera: Camera) -> None:
    outlines = [camera.flat(face.corners) for face in faces]
    axes.add_collection(PolyCollection(outlines, facecolors=SHADES[0], edgecolors="none", alpha=0.18, zorder=7.0))
    axes.add_collection(PolyCollection(outlines, facecolors="none", edgecolors=EDGE, linewidths=0.7, zorder=7.1))


def _hides(face: Face, camera: Camera, task: SpatialTask) -> bool:
    """Whether a face stands before the path of the body."""
    frames = task.world.frames[:: max(1, len(task.world.frames) // 60)]
    path = frames[:, :3] + max(task.start.height, 0.02) * frames[:, 9:]
    behind = (path - face.corners[0]) @ face.normal < -1e-6
    if not behind.any():
        return False
    return bool(Path(camera.flat(face.corners)).contains_points(camera.flat(path[behind])).any())


def goal_label(task: SpatialTask, index: int) -> str:
    """What a goal is called, with the yaw that it asks for."""
    goal, last = task.goals[index], index == len(task.goals) - 1
    word = "Goal" if last else f"{index + 1}"
    words = f"{word}: {goal.name}" if goal.name else word
    if goal.yaw_min is None or goal.yaw_max is None:
        return words
    return f"{words} ({goal.yaw_min / DEGREE:.0f} to {goal.yaw_max / DEGREE:.0f}° yaw)"


def goal_strip(task: SpatialTask, goal: Goal) -> tuple[Floats, Floats] | None:
    """Right and left edge of a goal's region on the guide, shape (n, 3) each [m]; None where it asks for no place."""
    along_min, along_max, across_min, across_max = goal.box
    if not any(map(math.isfinite, goal.box)):
        return None
    whole = guide_ribbon(task.world, 0.0)
    length = GRAIN * (len(task.world.frames) - 1)
    first = along_min if math.isfinite(along_min) else min(0.0, along_max)
    last = along_max if math.isfinite(along_max) else max(length, first + 4.0 * task.step.length)
    ribbon = guide_ribbon(task.world, 0.0, (first, max(last, first + task.step.length)))
    right, left = np.clip((across_min, across_max), whole.right, whole.left)
    return ribbon.at(right), ribbon.at(left)


def _draw_goal(axes: Axes, task: SpatialTask, goal: Goal, index: int, camera: Camera, bounds: Bounds) -> Name | None:
    """Draw a goal's region with its name; returns where that stands, None where nothing is seen."""
    edges = goal_strip(task, goal)
    if edges is None:
        return None
    last = index == len(task.goals) - 1
    outline = camera.flat(np.concatenate((edges[0], edges[1][::-1])))
    for face, line, alpha in ((style.GOAL, "none", 0.24 if last else 0.12), ("none", style.GOAL, 1.0)):
        axes.add_collection(
            PolyCollection(
                [outline], facecolors=face, edgecolors=line, alpha=alpha, linewidths=1.1, zorder=1.4,
                linestyles="-" if last else (0, (3, 2)),
            )
        )  # fmt: skip
    clipped = Path(outline).clip_to_bbox(Bbox.from_extents(bounds[0], bounds[2], bounds[1], bounds[3]))
    inside = np.asarray(clipped.vertices, np.float64)
    if not len(inside):
        return None
    top = inside[int(np.argmax(inside[:, 1] - 1e-3 * inside[:, 0]))]
    left, high = (
        float(top[0]) <= 0.5 * (bounds[0] + bounds[1]),
        float(top[1]) > bounds[2] + 0.96 * (bounds[3] - bounds[2]),
    )
    axes.annotate(
        goal_label(task, index), tuple(top), xytext=(3 if left else -3, -3 if high else 3), textcoords="offset points",
        ha="left" if left else "right", va="top" if high else "bottom", fontsize=8, color=GOAL_WORDS, zorder=9, path_effects=[halo()],
    )  # fmt: skip
    length = LETTER * larger_side(bounds) * len(goal_label(task, index))
    ends = (float(top[0]), float(top[0]) + (length if left else -length))
    return min(ends), max(ends), float(top[1])


def _draw_guide(axes: Axes, task: SpatialTask, camera: Camera) -> None:
    line = camera.flat(task.world.frames[:, :3])
    axes.plot(line[:, 0], line[:, 1], color=style.QUIET, lw=0.9, ls=(0, (6, 4)), zorder=1.6)
    way = line[-1] - line[-2]
    if float(np.hypot(*way)) > 1e-9:
        axes.annotate(
            "", tuple(line[-1]), tuple(line[-1] - 1e-3 * way / np.hypot(*way)), zorder=1.6,
            arrowprops={"arrowstyle": "-|>", "color": style.QUIET, "lw": 0.9, "mutation_scale": 8},
        )  # fmt: skip


def discs(places: Floats, normals: Floats, radii: Floats) -> Floats:
    """Corners of round marks in the planes across some normals, shape (n, `CORNERS`, 3)."""
    frames = np.array([frame_about(normal) for normal in normals]).reshape(-1, 3, 3)
    turn = np.arange(CORNERS) * (math.tau / CORNERS)
    around = np.cos(turn)[None, :, None] * frames[:, None, 0] + np.sin(turn)[None, :, None] * frames[:, None, 1]
    made: Floats = places[:, None] + radii[:, None, None] * around
    return made


def hold_radii(task: SpatialTask, bounds: Bounds) -> Floats:
    """Radii with which holds are drawn [m], shape (n,)."""
    least = LEAST_HOLD * larger_side(bounds)
    return np.array([max(hold.radius, least) for hold in task.world.holds])


def _draw_holds(axes: Axes, task: SpatialTask, camera: Camera, bounds: Bounds) -> None:
    world = task.world
    if not world.holds:
        return
    places, normals, radii = world.places, world.normals, hold_radii(task, bounds)
    facing = normals @ camera.axes[2]
    outlines = camera.flat(discs(places, normals, radii))
    sides = ((facing <= 0.0, style.WALL, FAR_SIDE, 2.0), (facing > 0.0, HOLDS, style.HOLD, 2.1))
    for seen, fill, colour, order in sides:
        axes.add_collection(
            PolyCollection(list(outlines[seen]), facecolors=fill, edgecolors=colour, linewidths=0.6, zorder=order)
        )
        if len(places) <= MOST_NORMALS:
            ends = np.stack((places[seen], places[seen] + 1.7 * radii[seen, None] * normals[seen]), axis=1)
            axes.add_collection(LineCollection(list(camera.flat(ends)), colors=colour, linewidths=0.7, zorder=order))
    if len(places) > MOST_NUMBERED:
        return
    for hold, at in zip(world.holds, camera.flat(places), strict=True):
        axes.annotate(
            str(hold.number), tuple(at), (0, -8), textcoords="offset points", ha="center", fontsize=6, color=style.QUIET,
            zorder=2.2, annotation_clip=True,
        )  # fmt: skip


def _draw_scale(
    axes: Axes, task: SpatialTask, camera: Camera, shown: Floats, bounds: Bounds, names: list[Name]
) -> None:
    """A bar of a round length, and the world's axes as they are seen, in an empty corner away from the goals' names."""
    size = larger_side(bounds)
    length = round_length(0.1 * size)
    words = f"{100.0 * length:g} cm" if length < 1.0 else f"{length:g} m"
    room = 0.035 * size
    x, y = bounds[1] - room - length, bounds[2] + room
    axes.plot([x, x + length], [y, y], color=style.INK, lw=1.6, solid_capstyle="butt", zorder=9)
    axes.annotate(
        words, (x + 0.5 * length, y), xytext=(0, 3), textcoords="offset points", ha="center", va="bottom", fontsize=7.5,
        color=style.INK, zorder=9, path_effects=[halo(2.4)],
    )  # fmt: skip
    arm = 1.4 * room
    origin = _emptiest_corner(camera.flat(shown), names, bounds, 1.8 * arm)
    for axis, name in zip(np.eye(3), "xyz", strict=True):
        tip = arm * camera.flat(axis)
        if float(np.hypot(*tip)) < 0.2 * arm:
            continue
        axes.plot(*zip(origin, origin + tip, strict=True), color=style.QUIET, lw=1.0, zorder=9, solid_capstyle="round")
        axes.annotate(
            name, tuple(origin + 1.3 * tip), ha="center", va="center", fontsize=7, color=style.QUIET, zorder=9,
            path_effects=[halo(2.0)],
        )  # fmt: skip
    fall = np.array(task.world.gravity)
    gravity = float(np.linalg.norm(fall))
    if gravity > 1e-9 and fall[2] > -0.999 * gravity:  # where things don't fall along -z, the way that they do
        down = arm * camera.flat(fall / gravity)
        axes.annotate(
            "",
            tuple(origin + down),
            tuple(origin),
            zorder=9,
            arrowprops={"arrowstyle": "-|>", "color": style.INK, "lw": 1.2},
        )


def _emptiest_corner(places: Floats, names: list[Name], bounds: Bounds, size: float) -> Floats:
    """Where a mark of some size meets no name and the fewest places: at the lower left, upper left or upper right.

    Args:
        places: In the picture's plane [m], shape (n, 2).
        names: Of goals.
        bounds: Of the picture.
        size: Half the width of the mark [m].
    """
    left, right, low, high = bounds[0] + size, bounds[1] - size, bounds[2] + size, bounds[3] - size
    corners = np.array([(left, low), (left, high), (right, high)])
    near = 1.2 * size
    crowd = []
    for x, y in corners:
        named = any(first - near < x < last + near and abs(height - y) < near for first, last, height in names)
        crowd.append((named, int((np.abs(places - (x, y)) < near).all(axis=1).sum())))
    chosen: Floats = corners[crowd.index(min(crowd))]
    return chosen
