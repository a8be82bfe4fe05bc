"""A climber in space: its body, links and end effectors, and the forces of the holds on it."""

from typing import TYPE_CHECKING, Final

import numpy as np

from ....types import Floats
from ....viewing import style
from ....viewing.browser.solids import Balls, Sticks, colour, prism
from ..planning.task import LimbedTask
from .climber import SMALLEST_FORCE, Snapshot, force_scale
from .geometry import Posture, body_outline, end_effector
from .torques import torque_limits
from .wall_space import in_space, turned

if TYPE_CHECKING:
    import viser

LIMBS: Final = 5.0
"""How far in front of the wall the limbs are, in radii of a link [-]."""
BODY: Final = (2.2, 5.4)
"""Where the body begins and ends, likewise [-]."""
GRIP_POINTS: Final = 12
"""Corners of the line that an end effector is drawn as."""
GRADES: Final = (style.ALERT, "#F2A65A", "#9FADBA", "#9FADBA")
"""Colour of the body by the smallest margin of its stance (`margins.grade`)."""
HEAT: Final = ((0.0, "#1E8A4C"), (0.5, "#C9A800"), (0.8, "#E06A10"), (0.95, style.ALERT))
"""Colour of a joint from a share of its torque limit on."""


def link_radius(task: LimbedTask) -> float:
    """Radius with which links are drawn [m]."""
    return max(task.robot.link_radius, 0.004)


class ClimberFigure:
    """A climber that can be set to any moment.

    Args:
        server: The scene's.
        name: In the scene's tree.
        task: Its robot is drawn, and its board's holds are what it holds.
        opacity: Of everything; a ghost has less, and shows no loads.
    """

    def __init__(self, server: "viser.ViserServer", name: str, task: LimbedTask, opacity: float = 1.0) -> None:
        robot = task.robot
        self._task, self._ghost = task, opacity < 1.0
        self._radius = link_radius(task)
        self._depths = self._radius * (LIMBS + 0.5 * (np.arange(len(robot.limbs)) % 2))
        self._limits = torque_limits(task).ravel()
        self.root = server.scene.add_frame(name, show_axes=False)
        outline = body_outline(robot)
        corners = np.stack((outline.real, outline.imag), axis=-1)
        self._body = server.scene.add_mesh_simple(
            f"{name}/body",
            *prism(corners, BODY[0] * self._radius, BODY[1] * self._radius),
            color=colour(GRADES[3]),
            flat_shading=True,
            opacity=opacity if self._ghost else None,
            cast_shadow=not self._ghost,
        )
        self._grade = 3
        top = 0.5 * float(np.ptp(corners, axis=0).min()) * 0.5
        up = in_space(np.array([[(0.0, 0.0), (0.0, top)]]), 0.0)[..., [0, 2, 1]]
        up[..., 2] = BODY[1] * self._radius
        mark = Sticks(
            server,
            f"{name}/body/up",
            np.array([colour(style.INK)], np.uint8),
            np.array([0.22 * self._radius]),
            opacity,
        )
        mark.put(up)
        paint = [colour(style.PARTS[i % len(style.PARTS)]) for i in range(len(robot.limbs))]
        r = self._radius
        # of each limb: both links, the way from the second to the tip, and the end effector
        sizes = [r, 0.8 * r, 0.3 * r, *([0.3 * r] * GRIP_POINTS)]
        n = len(sizes)
        self._links = Sticks(
            server,
            f"{name}/links",
            np.repeat(np.array(paint, np.uint8), n, axis=0),
            np.tile(sizes, len(paint)),
            opacity,
        )
        joints = np.tile((1.35 * r, 1.2 * r, 0.8 * r), len(paint))
        self._joint_colours = np.array([c for one in paint for c in (one, one, one)], np.uint8)
        self._joints = Balls(server, f"{name}/joints", self._joint_colours, joints, opacity)
        self._heat = [(share, np.array(colour(shade), np.uint8)) for share, shade in HEAT]
        self._arrows = None if self._ghost else server.scene.add_arrows(
            f"{name}/forces", np.array([[(0.0, 0.0, 0.0), (0.0, 0.0, 1e-3)]]), colour(style.FORCE),
            shaft_radius=0.42 * r, head_radius=1.0 * r, head_length=2.4 * r, visible=False,
        )  # fmt: skip

    def show(self, at: Snapshot, grade: int = 3) -> None:
        """Put everything where a moment has it; the body takes the colour of a grade."""
        posture = at.posture
        self._body.position = tuple(in_space(np.array((posture.x, posture.y)), 0.0))
        self._body.wxyz = turned(posture.angle)
        if grade != self._grade and not self._ghost:
            self._grade = grade
            self._body.color = colour(GRADES[grade])
        chains = self._chains(posture)
        self._links.put(np.concatenate([self._limb_sticks(i, chains[i], posture) for i in range(len(chains))]))
        self._joints.put(chains[:, :3].reshape(-1, 3), None if self._ghost else self._hot(at.torques))
        if self._arrows is not None:
            self._show_forces(at, chains[:, 3])

    def hide(self, hidden: bool = True) -> None:
        """Take the figure out of sight, or bring it back."""
        self.root.visible = not hidden

    def remove(self) -> None:
        """Take the figure away for good."""
        self.root.remove()

    def _chains(self, posture: Posture) -> Floats:
        """Port, elbow, end of the second link and tip of each limb in space, shape (n_limbs, 4, 3).

        Where an elbow passes from one side to the other its links look shorter on the wall: in space it turns out of it.
        """
        robot = self._task.robot
        depths = np.repeat(self._depths[:, None], 4, axis=1)
        for i, limb in enumerate(robot.limbs):
            seen = float(np.hypot(*(posture.chains[i, 1] - posture.chains[i, 0])))
            out = np.sqrt(max(limb.l1**2 - seen**2, 0.0))
            if out > 1e-3 * limb.l1:
                depths[i, 1] += out
                depths[i, 2] += out * (1.0 - limb.l2 / abs(limb.second_link))
        return in_space(posture.chains, depths)

    def _limb_sticks(self, i: int, chain: Floats, posture: Posture) -> Floats:
        limb = self._task.robot.limbs[i]
        size = self._radius if limb.end.kind == "foot" else 1.25 * self._radius
        line = end_effector(
            limb.end.kind, posture.chains[i, 3], float(posture.grips[i]), size, closed=posture.held[i] >= 0
        )
        line = line[np.linspace(0, len(line) - 1, GRIP_POINTS + 1).round().astype(int)]
        grip = in_space(line, self._depths[i])
        ends = [np.stack((chain[:-1], chain[1:]), axis=1), np.stack((grip[:-1], grip[1:]), axis=1)]
        if limb.end.kind != "foot":  # what holds it is at the end of the link, not at the middle of its mouth
            ends[0][2] = np.nan
            back = int(np.argmin(np.linalg.norm(grip - chain[2], axis=1)))
            ends[0][2] = np.stack((chain[2], grip[back]))
        return np.concatenate(ends)

    def _hot(self, torques: Floats) -> "np.ndarray[tuple[int, ...], np.dtype[np.uint8]]":
        shares = np.abs(torques.ravel()) / self._limits
        colours = self._joint_colours.copy()
        for k, share in enumerate(shares):
            i, joint = divmod(k, 2)
            colours[3 * i + joint] = next(shade for least, shade in reversed(self._heat) if share >= least)
        return colours

    def _show_forces(self, at: Snapshot, tips: Floats) -> None:
        assert self._arrows is not None
        seen = np.hypot(*at.forces.T) > SMALLEST_FORCE * self._task.robot.weight
        seen &= np.array([held >= 0 for held in at.posture.held]) & np.isfinite(at.forces).all(axis=1)
        self._arrows.visible = bool(seen.any())
        if seen.any():
            starts = tips[seen] + (0.0, -3.0 * self._radius, 0.0)
            ways = in_space(at.forces[seen] * force_scale(self._task), 0.0)
            self._arrows.points = np.stack((starts, starts + ways), axis=1).astype(np.float32)
