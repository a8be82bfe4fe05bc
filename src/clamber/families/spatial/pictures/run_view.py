"""A run of a robot in space as it truly was, as a film and a picture that can be set to any of its moments."""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from matplotlib.figure import Figure

from ....types import Floats, Json
from ....viewing.recording import FRAMES, Frame, Part, View
from ....viewing.route import draw_way
from ....viewing.view import Picture
from ..execution.run_trace import RunTrace
from ..planning.task import SpatialTask
from ..robot.bodies import rotation
from ..robot.kinematics import LinkFrames, Posed, centre_of_mass, link_frames
from .camera import Camera
from .moments import SWINGING, Moment
from .robot_artists import RobotArtists
from .spatial_view import (
    describe_holds,
    draw_film,
    force_gauges,
    shown_places,
    torque_gauges,
    used_torques,
)
from .world_artists import picture_bounds

SHOWN: Final = 60
"""Moments by which the picture's bounds are chosen, at most."""
WORDS: Final = ("above 20 mm", "10 to 20", "5 to 10", "within 5 mm")
"""What grades mean: how far a tip was from its hold, or the body from where it was to be."""
OFF: Final = (0.02, 0.01, 0.005)
"""[m]."""
GHOSTS: Final = 4
"""Moments that a whole run shows beside its end."""


class RunView(View[Moment]):
    """A run.

    Args:
        task: Robot and world.
        trace: What happened.
        camera: From where it is seen.
    """

    rows = ("Body", "Holds")
    verdict_row = "Motion"
    strip_title = "How near every motion came to its aim"
    noun = "Motion"
    words = WORDS

    def __init__(self, task: SpatialTask, trace: RunTrace, camera: Camera) -> None:
        self.task, self.trace, self.camera = task, trace, camera
        self.title = task.title or task.name
        self.names = task.robot.chains.limb_names
        self._motions: Sequence[Json] = (trace.report or {}).get("motions", [])
        self.seconds = float(trace.time[-1])
        starts = [float(motion["start"]) for motion in self._motions]
        self.starts = np.array([0.0, *starts])
        self.ends = np.array([0.0, *(float(motion["start"] + motion["seconds"]) for motion in self._motions)])
        self.steps = ("start", *(motion_in_words(motion) for motion in self._motions))
        self.grades = (3, *(_grade(motion) for motion in self._motions))
        rows = np.unique(np.linspace(0, len(trace.time) - 1, SHOWN).astype(int))
        self.shown = shown_places(task, [self._moment(int(row)) for row in rows])
        self.bounds = picture_bounds(camera, self.shown)
        self.gauges = (torque_gauges(task), force_gauges(task))

    def at(self, time: float) -> Moment:
        """See `Film`: as the nearest sample has it."""
        trace = self.trace
        return self._moment(min(int(np.searchsorted(trace.time, time)), len(trace.time) - 1))

    def settled(self, step: int) -> Moment:
        """See `View`."""
        return self.at(float(self.ends[step]))

    def motion(self, step: int) -> list[Part[Moment]]:
        """See `View`: as long in the film as it took."""
        start, end = float(self.starts[step]), float(self.ends[step])
        kind = "move" if self._motions[step - 1]["limb"] is None else "swing"
        return [Part(kind, lambda share, way: self.at(start + share * (end - start)))]

    def values(self, at: Moment) -> tuple[Floats, ...]:
        """See `Film`: torques as shares of all that motors have, sizes of contact forces [N]."""
        scaled = self.task.robot.spec.torque_share * at.torques
        return used_torques(self.task, scaled), np.linalg.norm(at.wrenches[:, :3], axis=1)

    def lines(self, step: int, at: Moment) -> tuple[str, ...]:
        """See `View`."""
        x, y, z = at.body.place.tolist()
        return f"x {x:.3f}, y {y:.3f}, z {z:.3f} m", describe_holds(self.names, at.holds)

    def verdict(self, step: int) -> str:
        """See `View`."""
        if step == 0:
            return "stands"
        motion = self._motions[step - 1]
        off = motion["off"]
        words = str(motion["outcome"])
        words += f", {1e3 * off:.1f} mm off" if off is not None and math.isfinite(off) else ""
        return f"{words}: {motion['reason']}" if motion["reason"] else words

    def failed(self, step: int) -> bool:
        """See `View`."""
        return step > 0 and self._motions[step - 1]["outcome"] != "ok"

    def draw(self, picture: Picture[Moment]) -> RobotArtists:
        """See `View`."""
        return draw_film(picture, self.task, self.camera, self.shown)

    def _moment(self, row: int) -> Moment:
        """The robot at a sample, truly where that is told."""
        trace, chains = self.trace, self.task.robot.chains
        limbs = len(chains.limb_names)
        used = chains.used
        pose = trace.believed[row] if trace.true_pose is None else trace.true_pose[row]
        flat = trace.joints[row] if trace.true_joints is None else trace.true_joints[row]
        q = np.zeros(used.shape)
        torques = np.zeros(used.shape)
        q[used], torques[used] = flat, trace.torques[row]
        body = Posed(pose[:3], rotation(pose[3:]), q)
        frames: LinkFrames = link_frames(chains, body)
        numbers = trace.holds[row] if trace.true_holds is None else trace.true_holds[row]
        holds = tuple(int(number) - 1 if number > 0 else SWINGING for number in numbers)
        normals = np.full((limbs, 3), math.nan)
        held = [limb for limb in range(limbs) if holds[limb] >= 0]
        normals[held] = self.task.world.normals[[holds[limb] for limb in held]]
        if trace.true_wrenches is not None:
            wrenches = trace.true_wrenches[row]
        else:
            own = trace.wrenches[row].reshape(limbs, 2, 3)
            wrenches = np.einsum("lij,lpj->lpi", frames.axes[:, -1], own).reshape(limbs, 6)
        return Moment(
            body,
            np.concatenate((body.place, np.zeros(3))),
            frames,
            holds,
            normals,
            wrenches,
            torques,
            centre_of_mass(chains, body, frames),
            np.zeros(0),
        )


class RunPicture(Picture[Moment]):
    """A run as a figure, animated or whole."""

    view: RunView

    def __init__(self, view: RunView) -> None:
        super().__init__(view)
        self.show(len(view.steps) - 1, view.at(view.seconds))

    def frames(self, most: int) -> list[Frame[Moment]]:
        """Evenly over the run."""
        view = self.view
        count = max(2, min(most, FRAMES["swing"] * max(1, len(view.steps) - 1)))
        times = np.linspace(0.0, view.seconds, count)
        return [Frame(view.step_at(float(time)), view.at(float(time)), 1.0) for time in times]

    def whole(self) -> Figure:
        """The end, some moments before it, and the way of the body."""
        view = self.view
        for time in np.linspace(0.0, view.seconds, GHOSTS + 1)[:-1]:
            RobotArtists(self.wall, view.task, view.camera, view.bounds, 0.35).update(view.at(float(time)))
        trace = view.trace
        draw_way(self.wall, view.camera.flat((trace.believed if trace.true_pose is None else trace.true_pose)[:, :3]))
        return self.figure


def motion_in_words(motion: Json) -> str:
    """A motion of a report."""
    if motion["limb"] is None:
        return "the body moves"
    return f"{motion['limb']} to hold {motion['hold']}"


def _grade(motion: Json) -> int:
    """Of a motion, 0 the worst."""
    off = motion["off"]
    if motion["outcome"] != "ok" or off is None or not math.isfinite(off):
        return 0
    return sum(off <= limit for limit in OFF)
