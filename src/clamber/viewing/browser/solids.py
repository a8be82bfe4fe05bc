"""Worlds and figures in the viewer's space: what a family brings, and the solids that it is made of, in batches or made once."""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Final, Protocol

import numpy as np
import numpy.typing as npt
from matplotlib.colors import to_rgb
from matplotlib.path import Path as Outline
from scipy.spatial import Delaunay

from ...types import Floats, Ints
from .. import style
from ..scene import Bounds

if TYPE_CHECKING:
    import viser


Mesh = tuple[Floats, Ints]
"""Vertices, shape (n, 3) [m], and triangles, shape (m, 3)."""
Colours = npt.NDArray[np.uint8]
"""Shape (n, 3)."""
Colour = tuple[int, int, int]
"""Red, green and blue, 0 to 255."""


class Figure(ABC):
    """A robot in space, that can be set to any moment.

    Args:
        server: The scene's.
        name: In the scene's tree.
        opacity: Of everything; a ghost has less, and shows no loads.
    """

    def __init__(self, server: "viser.ViserServer", name: str, opacity: float = 1.0) -> None:
        self._server, self._name, self._opacity, self._ghost = server, name, opacity, opacity < 1.0
        self._arrows: Any = None
        self.middle: Floats = np.full(3, np.nan)
        """Of its body as it is shown [m]; NaN before it is."""
        self.root = server.scene.add_frame(name, show_axes=False)

    @abstractmethod
    def show(self, at: Any, grade: int = 3) -> None:
        """Put everything where a moment has it, in the colours of a grade."""

    def hide(self, hidden: bool = True) -> None:
        """Take the figure out of sight, or bring it back."""
        self.root.visible = not hidden

    def remove(self) -> None:
        """Take it away for good."""
        self.root.remove()

    def sticks(self, part: str, colours: Sequence[Colour], radii: Sequence[float]) -> "Sticks":
        """Sticks of the figure, one for each colour and radius [m]."""
        paint = np.array(colours, np.uint8)
        return Sticks(self._server, f"{self._name}/{part}", paint, np.array(radii), self._opacity)

    def balls(self, part: str, colours: Sequence[Colour], radii: Sequence[float]) -> "Balls":
        """Its balls, likewise."""
        paint = np.array(colours, np.uint8)
        return Balls(self._server, f"{self._name}/{part}", paint, np.array(radii), self._opacity)

    def rigid(self, part: str, mesh: Mesh, shade: Colour, *, flat: bool = False) -> "Rigid":
        """A solid of the figure of any shape."""
        return Rigid(self._server, f"{self._name}/{part}", mesh, shade, self._opacity, flat=flat)

    def make_arrows(self, shaft: float, head: float, length: float) -> None:
        """Make what `show_forces` shows: radius of the shaft, radius and length of the head [m]; a ghost has none."""
        if not self._ghost:
            self._arrows = self._server.scene.add_arrows(
                f"{self._name}/forces", np.array([[(0.0, 0.0, 0.0), (0.0, 0.0, 1e-3)]]), colour(style.FORCE),
                shaft_radius=shaft, head_radius=head, head_length=length, visible=False,
            )  # fmt: skip

    def show_forces(self, starts: Floats, ways: Floats) -> None:
        """Show arrows from their starts, as long as their ways, shape (n, 3) each [m]; there may be none."""
        if self._arrows is None:
            return
        self._arrows.visible = bool(len(starts))
        if len(starts):
            self._arrows.points = np.stack((starts, starts + ways), axis=1).astype(np.float32)


class World(Protocol):
    """What stands still in a scene."""

    def remove(self) -> None:
        """Take all of it away."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class Camera:
    """Where to look from [m]."""

    position: Floats
    look_at: Floats


@dataclass(frozen=True, slots=True)
class Scenery(ABC):
    """A task's world and robot, ready to be put into a scene."""

    bounds: Bounds
    """The part of the world shown."""

    @abstractmethod
    def world(self, server: "viser.ViserServer") -> World:
        """Put the world into the scene."""

    @abstractmethod
    def figure(self, server: "viser.ViserServer", name: str, opacity: float = 1.0) -> Figure:
        """Put the robot into the scene."""

    @abstractmethod
    def camera(self) -> Camera:
        """Where to look from first."""


class _Nothing(Figure):
    """A world without its robot, or a robot without its world."""

    def show(self, at: Any, grade: int = 3) -> None:
        """See `Figure`."""


@dataclass(frozen=True, slots=True)
class LoneScenery(Scenery):
    """A world or a robot alone, of a scenery of both."""

    whole: Scenery
    robot: bool
    """Whether the robot is shown, and not the world."""

    def world(self, server: "viser.ViserServer") -> World:
        """See `Scenery`."""
        return _Nothing(server, "/nothing") if self.robot else self.whole.world(server)

    def figure(self, server: "viser.ViserServer", name: str, opacity: float = 1.0) -> Figure:
        """See `Scenery`."""
        return self.whole.figure(server, name, opacity) if self.robot else _Nothing(server, name, opacity)

    def camera(self) -> Camera:
        """See `Scenery`."""
        return self.whole.camera()


FOV: Final = math.radians(40.0)
"""Of the camera, from the bottom to the top of the picture [rad]."""

NARROW: Final = 0.9
"""Least width of a picture over its height that everything fits into [-]."""


SIDES: Final = 20
"""Flat sides of what is round."""


def colour(name: str) -> Colour:
    """A colour as browsers take it."""
    red, green, blue = to_rgb(name)
    return round(255 * red), round(255 * green), round(255 * blue)


def lathe(profile: Floats) -> Mesh:
    """The solid that a profile makes as it turns about z.

    Args:
        profile: Radius and height of its corners from the bottom to the top, both ends on the axis, shape (n, 2).
    """
    turn = np.arange(SIDES) * (math.tau / SIDES)
    around = np.stack((np.cos(turn), np.sin(turn)), axis=-1)
    rings = profile[:, None, :1] * around[None]
    heights = np.broadcast_to(profile[:, 1, None, None], (len(profile), SIDES, 1))
    corners = np.arange(len(profile) * SIDES).reshape(len(profile), SIDES)
    low, high = corners[:-1], corners[1:]
    quads = (low, np.roll(low, -1, axis=1), np.roll(high, -1, axis=1), high)
    faces = np.concatenate([np.stack((quads[0], quads[k], quads[k + 1]), axis=-1).reshape(-1, 3) for k in (1, 2)])
    return np.concatenate((rings, heights), axis=-1).reshape(-1, 3), faces


def rod() -> Mesh:
    """A rod of radius 1 from 0 to 1 along z."""
    return lathe(np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]))


def ball() -> Mesh:
    """A ball of radius 1."""
    rise = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 13)
    return lathe(np.stack((np.cos(rise), np.sin(rise)), axis=-1))


def prism(outline: Floats, bottom: float, top: float) -> Mesh:
    """What lies over a simple polygon between two heights along z.

    Args:
        outline: Corners, shape (n, 2) [m].
        bottom: [m].
        top: [m].
    """
    ways = np.roll(outline, -1, axis=0) - outline
    if np.sum(outline[:, 0] * ways[:, 1] - outline[:, 1] * ways[:, 0]) < 0.0:
        outline = outline[::-1]
    n = len(outline)
    vertices = np.concatenate([np.column_stack((outline, np.full(n, height))) for height in (bottom, top)])
    lid = _triangles(outline)
    here, then = np.arange(n), np.roll(np.arange(n), -1)
    walls = np.concatenate([np.stack(three, axis=-1) for three in ((here, then, then + n), (here, then + n, here + n))])
    return vertices, np.concatenate((lid[:, ::-1], lid + n, walls))


def _triangles(outline: Floats) -> Ints:
    """Triangles of a polygon's inside, anticlockwise, shape (m, 3)."""
    found = Delaunay(outline).simplices
    inside = Outline(outline).contains_points(outline[found].mean(axis=1))
    kept = found[inside]
    a, b, c = (outline[kept[:, k]] for k in range(3))
    turned = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0]) < 0.0
    kept[turned] = kept[turned][:, ::-1]
    made: Ints = kept.astype(np.int32)
    return made


def along_z(ways: Floats) -> Floats:
    """Quaternions w, x, y, z that turn the z axis into some directions, shape (n, 4).

    Args:
        ways: Of any length but none, shape (n, 3).
    """
    x, y, z = (ways / np.linalg.norm(ways, axis=1, keepdims=True)).T
    aside = x * x + y * y
    up = np.where(z > 0.0, 1.0 + z, aside / np.maximum(1.0 - z, 1.0))  # 1 + z, without its cancellation near -z
    turns = np.stack((up, -y, x, np.zeros(len(z))), axis=-1)
    turns[(aside == 0.0) & (z < 0.0)] = (0.0, 1.0, 0.0, 0.0)
    made: Floats = turns / np.linalg.norm(turns, axis=1, keepdims=True)
    return made


def _linear(colours: Colours) -> Colours:
    """Colours as the page takes those of batches, which it does not decode: linear (IEC 61966-2-1), else they are too light."""
    shares = colours / 255.0
    light = np.where(shares <= 0.04045, shares / 12.92, ((shares + 0.055) / 1.055) ** 2.4)
    return np.round(255.0 * light).astype(np.uint8)


class _Batch:
    """Solids of one shape, each with a colour and sizes of its own.

    All that moves in a figure is in batches: viser's page draws a node's own pose in the next picture, and what is in a batch one or
    more pictures later, so that limbs of the one kind would come off a body of the other.

    Args:
        server: The scene's.
        name: In the scene's tree.
        mesh: The shape.
        colours: Of each, shape (n, 3).
        opacity: Of all.
        flat: Whether its sides are flat.
    """

    def __init__(
        self,
        server: "viser.ViserServer",
        name: str,
        mesh: Mesh,
        colours: Colours,
        opacity: float = 1.0,
        *,
        flat: bool = False,
    ) -> None:
        self._colours, n = colours, len(colours)
        self._scales = np.full((n, 3), 1e-6, np.float32)
        self.node = server.scene.add_batched_meshes_simple(
            name, *mesh, np.tile((1.0, 0.0, 0.0, 0.0), (n, 1)), np.zeros((n, 3)), batched_scales=self._scales,
            batched_colors=_linear(colours), opacity=None if opacity >= 1.0 else opacity, lod="off", cast_shadow=opacity >= 1.0,
            flat_shading=flat,
        )  # fmt: skip

    def paint(self, colours: Colours) -> None:
        """Give them other colours, shape (n, 3)."""
        if not np.array_equal(colours, self._colours):
            self._colours = colours
            self.node.batched_colors = _linear(colours)

    def _place(self, at: Floats, scales: Floats, seen: npt.NDArray[np.bool_]) -> None:
        self.node.batched_positions = np.where(seen[:, None], at, 0.0).astype(np.float32)
        shown = np.where(seen[:, None], scales, 1e-6).astype(np.float32)
        if not np.array_equal(shown, self._scales):
            self._scales = shown
            self.node.batched_scales = shown


class _Round(_Batch):
    """Round solids, with a radius [m] each, shape (n,)."""

    shape: ClassVar[Mesh]
    """Of radius 1."""

    def __init__(
        self, server: "viser.ViserServer", name: str, colours: Colours, radii: Floats, opacity: float = 1.0
    ) -> None:
        super().__init__(server, name, self.shape, colours, opacity)
        self._radii = radii


class Sticks(_Round):
    """Straight sticks."""

    shape = rod()

    def put(self, ends: Floats) -> None:
        """Put every stick between its ends, shape (n, 2, 3) [m]; one without length, or with an end that is NaN, is not seen."""
        ways = ends[:, 1] - ends[:, 0]
        lengths = np.linalg.norm(ways, axis=1)
        seen = np.asarray(lengths > 1e-6)  # NaN is not
        self.node.batched_wxyzs = along_z(np.where(seen[:, None], ways, (0.0, 0.0, 1.0))).astype(np.float32)
        self._place(ends[:, 0], np.column_stack((self._radii, self._radii, lengths)), seen)


class Balls(_Round):
    """Balls."""

    shape = ball()

    def put(self, centres: Floats, colours: Colours | None = None) -> None:
        """Put every ball at its centre, shape (n, 3) [m]; one with NaN is not seen. Colours stay, unless given."""
        seen = np.asarray(np.isfinite(centres).all(axis=1))
        self._place(centres, np.repeat(self._radii[:, None], 3, axis=1), seen)
        if colours is not None:
            self.paint(colours)


class Rigid(_Batch):
    """One solid of any shape."""

    def __init__(
        self,
        server: "viser.ViserServer",
        name: str,
        mesh: Mesh,
        shade: Colour,
        opacity: float = 1.0,
        *,
        flat: bool = False,
    ) -> None:
        super().__init__(server, name, mesh, np.array([shade], np.uint8), opacity, flat=flat)

    def put(self, at: Floats, turn: Sequence[float] | Floats) -> None:
        """Put its origin at a place [m], shape (3,), turned by a quaternion w, x, y, z."""
        self.node.batched_wxyzs = np.asarray(turn, np.float32)[None]
        self._place(np.asarray(at)[None], np.ones((1, 3)), np.array([True]))


DISC: Final = np.stack((np.cos(np.arange(24) * np.pi / 12.0), np.sin(np.arange(24) * np.pi / 12.0)), axis=-1)
"""Corners of a disc of radius 1."""
