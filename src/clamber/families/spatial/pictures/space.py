"""A world and a robot in the viewer's space: surfaces, holds, guide and goals; links in their own shapes, contact forces as arrows."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np
from scipy.spatial import ConvexHull

from ....types import Floats, Ints
from ....viewing import style
from ....viewing.browser.solids import Figure, Mesh, Sticks, ball, colour
from ..planning.task import SpatialTask
from ..robot.kinematics import LinkFrames, Posed, quaternions
from ..robot.parts import parts_of
from .moments import SWINGING, Moment
from .robot_artists import ARROW, SMALLEST, force_scale, limb_colour
from .surfaces import Face, surfaces_of
from .world_artists import goal_label, goal_strip

if TYPE_CHECKING:
    import viser

SURFACE: Final = "#FAFBFC"
GLASS: Final = 0.22
"""Opacity of a surface that is seen from behind [-]."""
GRID: Final = "#B9C1C9"
LIFT: Final = 0.0015
"""Grid and goals are drawn so far over their surface, as a share of the world's size [-]."""
LEAST_HOLD: Final = 0.004
"""Least radius of a drawn hold, over the world's size [-]."""
THICK: Final = 0.5
"""Height of a drawn hold over its radius [-]."""
BASE: Final = "#9FADBA"
GRADES: Final = (style.ALERT, "#F2A65A", BASE, BASE)
"""Colour of the base by the smallest margin of its stance (`margins.grade`)."""


def fan(faces: list[Face]) -> Mesh:
    """Flat convex faces as triangles that turn anticlockwise about their normals."""
    vertices: list[Floats] = []
    triangles: list[tuple[int, int, int]] = []
    for face in faces:
        corners = face.corners
        turned = float(np.cross(corners[1] - corners[0], corners[2] - corners[0]) @ face.normal) < 0.0
        first = len(vertices)
        vertices += list(corners[::-1] if turned else corners)
        triangles += [(first, first + k, first + k + 1) for k in range(1, len(corners) - 1)]
    return np.array(vertices), np.array(triangles, np.int32)


def strip_mesh(right: Floats, left: Floats) -> Mesh:
    """The strip between two lines, shape (n, 3) each."""
    n = len(right)
    k = np.arange(n - 1)
    faces = np.concatenate((np.stack((k, k + 1, n + k), axis=1), np.stack((k + 1, n + k + 1, n + k), axis=1)))
    return np.concatenate((right, left)), faces.astype(np.int32)


class WorldScene:
    """A world as it stands, with the goals of a task.

    Args:
        server: The scene's.
        task: World and goals.
        shown: Places that are to be seen, world frame [m], shape (n, 3).
    """

    def __init__(self, server: "viser.ViserServer", task: SpatialTask, shown: Floats) -> None:
        self._server = server
        self.task = task
        self.size = float(np.ptp(shown, axis=0).max())
        """Largest extent of what is shown [m]."""
        self.root = server.scene.add_frame("/world", show_axes=False)
        surfaces = surfaces_of(task.world, shown)
        for solid in sorted({face.solid for face in surfaces.faces}):
            mesh = fan([face for face in surfaces.faces if face.solid == solid])
            server.scene.add_mesh_simple(
                f"/world/surfaces/{solid + 1}", *mesh, color=colour(SURFACE), flat_shading=True, side="front"
            )
            server.scene.add_mesh_simple(
                f"/world/surfaces/{solid + 1} from behind",
                *mesh,
                color=colour(SURFACE),
                flat_shading=True,
                side="back",
                opacity=GLASS,
                cast_shadow=False,
            )
        lift = LIFT * self.size
        if len(surfaces.lines):
            lines = surfaces.lines + lift * surfaces.line_normals[:, None]
            server.scene.add_line_segments("/world/grid", lines, colour(GRID), thickness=0.4 * lift)
        guide = task.world.frames[:, :3] + lift * task.world.frames[:, 9:]
        pieces = np.stack((guide[:-1], guide[1:]), axis=1)
        server.scene.add_line_segments("/world/guide", pieces, colour(style.QUIET), thickness=lift)
        for k in range(len(task.goals)):
            self._draw_goal(k, 2.0 * lift)
        self._holds: Sticks | None = None
        self.draw_holds(task.world.places, task.world.normals, np.array([hold.radius for hold in task.world.holds]))

    def draw_holds(self, places: Floats, normals: Floats, radii: Floats) -> None:
        """Draw holds in place of those that are drawn.

        Args:
            places: World frame [m], shape (n, 3).
            normals: Shape (n, 3).
            radii: Shape (n,) [m].
        """
        if self._holds is not None:
            self._holds.node.remove()
            self._holds = None
        if not len(places):
            return
        radii = np.maximum(radii, LEAST_HOLD * self.size)
        paint = np.array([colour(style.HOLD)] * len(places), np.uint8)
        self._holds = Sticks(self._server, "/world/holds", paint, radii)
        up = THICK * radii[:, None] * normals
        self._holds.put(np.stack((places - 0.5 * up, places + 0.5 * up), axis=1))

    def _draw_goal(self, index: int, lift: float) -> None:
        edges = goal_strip(self.task, self.task.goals[index])
        if edges is None:
            return
        last = index == len(self.task.goals) - 1
        right, left = edges
        along = np.gradient(right, axis=0)
        normal = np.cross(along, left - right)
        normal *= lift / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
        self._server.scene.add_mesh_simple(
            f"/world/goals/{index + 1}",
            *strip_mesh(right + normal, left + normal),
            color=colour(style.GOAL),
            opacity=0.45 if last else 0.22,
            flat_shading=True,
            side="double",
            cast_shadow=False,
        )
        middle = 0.5 * (right[0] + left[0]) + 4.0 * normal[0]
        self._server.scene.add_label(
            f"/world/goals/{index + 1}/name",
            goal_label(self.task, index),
            anchor="bottom-center",
            position=tuple(middle),
        )

    def remove(self) -> None:
        """Take all of it away."""
        self.root.remove()


def hull(shapes: Sequence[tuple[Floats, float]]) -> Mesh:
    """Convex hulls of shapes as one mesh: of each its points, shape (n, 3), and the radius by which they are blown up [m]."""
    vertices: list[Floats] = []
    faces: list[Ints] = []
    sphere = ball()[0]
    first = 0
    for bare, radius in shapes:
        points = (bare[:, None] + radius * sphere).reshape(-1, 3) if radius > 0.0 else bare
        if len(points) < 4 or float(np.linalg.svd(points - points.mean(axis=0), compute_uv=False)[-1]) < 1e-6:
            continue
        corners, triangles = convex(points)
        vertices.append(corners)
        faces.append(triangles + first)
        first += len(corners)
    return (np.concatenate(vertices), np.concatenate(faces)) if vertices else (np.zeros((0, 3)), np.zeros((0, 3), int))


def convex(points: Floats) -> Mesh:
    """The convex hull of points, its triangles anticlockwise seen from outside."""
    found = ConvexHull(points)
    corners, triangles = points[found.vertices], np.searchsorted(found.vertices, found.simplices)
    a, b, c = (corners[triangles[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), found.equations[:, :3]) < 0.0
    triangles[inward] = triangles[inward][:, ::-1]
    return corners, triangles


def body_meshes(task: SpatialTask) -> dict[tuple[int, int], Mesh]:
    """Shapes of the model by the frame that they move with: limb and link, or (-1, -1) for the base; empty where it has none."""
    parts = parts_of(task.robot)
    own = {(limb, k): part for limb, links in enumerate(parts.links) for k, part in enumerate(links)}
    meshes = {key: hull(part.shapes) for key, part in ({(-1, -1): parts.base} | own).items()}
    return {key: mesh for key, mesh in meshes.items() if len(mesh[1])}


class SpatialFigure(Figure):
    """A robot in space: its base and links in the model's shapes, or capsules where the model has none of a limb."""

    def __init__(self, server: "viser.ViserServer", name: str, task: SpatialTask, opacity: float = 1.0) -> None:
        super().__init__(server, name, opacity)
        self._task = task
        chains = task.robot.chains
        self._length = chains.longest_limb
        self._nodes = {
            key: self.rigid(
                f"parts/{key[0] + 1} {key[1] + 1}", mesh, colour(BASE if key[0] < 0 else limb_colour(key[0]))
            )
            for key, mesh in body_meshes(task).items()
        }
        if (-1, -1) not in self._nodes:
            box = box_mesh(np.maximum(chains.base_half, 0.01 * self._length))
            self._nodes[-1, -1] = self.rigid("parts/base", box, colour(BASE), flat=True)
        limbs = range(len(chains.limb_names))
        self._bare = [
            (limb, k) for limb in limbs for k in range(int(chains.n_joints[limb])) if (limb, k) not in self._nodes
        ]
        radii = np.maximum(chains.radius, 0.01 * self._length)
        paint = [colour(limb_colour(limb)) for limb, _ in self._bare]
        thick = [float(radii[limb, k]) for limb, k in self._bare]
        self._sticks = self.sticks("links", paint, thick) if self._bare else None
        self._joints = self.balls("joints", paint, thick) if self._bare else None
        ends = [1.6 * float(radii[limb, int(chains.n_joints[limb]) - 1]) for limb in limbs]
        self._pads = self.sticks("contacts", [colour(limb_colour(limb)) for limb in limbs], ends)
        self._tips = self.balls("tips", [colour(limb_colour(limb)) for limb in limbs], [0.55 * end for end in ends])
        self.make_arrows(0.018 * self._length, 0.045 * self._length, 0.11 * self._length)

    def show(self, at: Moment, grade: int = 3) -> None:
        """Put everything where a moment has it; the base takes the colour of a grade."""
        self.middle = np.asarray(at.body.place)
        if not self._ghost:
            self._nodes[-1, -1].paint(np.array([colour(GRADES[grade])], np.uint8))
        self._place_parts(at.body, at.frames)
        chains = self._task.robot.chains
        if self._sticks is not None and self._joints is not None:
            ends = np.array([(at.origins[limb, k], at.origins[limb, k + 1]) for limb, k in self._bare])
            self._sticks.put(ends)
            self._joints.put(ends[:, 0])
        held = np.array([hold != SWINGING for hold in at.holds])
        thick = 0.3 * chains.radius[np.arange(len(held)), chains.n_joints - 1]
        normals = np.where(held[:, None], at.normals, np.nan)
        self._pads.put(np.stack((at.tips - 0.2 * thick[:, None] * normals, at.tips + thick[:, None] * normals), axis=1))
        self._tips.put(at.tips)
        ways = at.wrenches[:, :3] * force_scale(self._task)
        seen = np.nan_to_num(np.linalg.norm(ways, axis=1)) > SMALLEST * ARROW * self._length
        self.show_forces(at.tips[seen], ways[seen])

    def _place_parts(self, body: Posed, frames: LinkFrames) -> None:
        keys = list(self._nodes)
        turns = np.array([body.turn if limb < 0 else frames.axes[limb, k] for limb, k in keys])
        for key, wxyz in zip(keys, quaternions(turns), strict=True):
            self._nodes[key].put(body.place if key[0] < 0 else frames.origins[key], wxyz)


def box_mesh(half: Floats) -> Mesh:
    """A box about the origin."""
    return convex(np.array([(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)]) * half)
