"""What happens in a climb, sample by sample, and the log that it becomes."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, Protocol

import numpy as np

from ...types import Floats, Ints, Json
from ..log import Log, LogError
from .climber import Climber

TOPIC: Final = "climb"
"""Channel of its log."""
POSE: Final = (("x", "m"), ("y", "m"), ("theta", "rad"))
JOINTS: Final = ("shoulder", "elbow")
EVERY: Final = 4
"""Ticks between samples; the last tick is always one."""


class Truth(Protocol):
    """How a climber really is."""

    @property
    def pose(self) -> Floats:
        """Body x, y [m], theta [rad]."""

    @property
    def q(self) -> Floats:
        """Joint angles at the gears' outputs, shape (limbs, 2) [rad]."""

    @property
    def tips(self) -> Floats:
        """World frame, shape (limbs, 2) [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class ClimbTrace:
    """A climb, `rows` samples long."""

    limbs: tuple[str, ...]
    time: Floats
    """Shape (rows,) [s]."""
    step: Ints
    """Number of the action that is carried out, from 1; 0 before the first, shape (rows,)."""
    believed: Floats
    """Body pose by the held limbs, the play counted, shape (rows, 3) [m], [rad]."""
    aim: Floats
    """Of the body, shape (rows, 3)."""
    angles: Floats
    """Joints by their encoders, shape (rows, limbs, 2) [rad]."""
    torques: Floats
    """Commanded, shape (rows, limbs, 2) [N m]."""
    holds: Ints
    """Number of each limb's hold, 0 if it is free, shape (rows, limbs)."""
    carries: Ints
    """Whether the limb carries the body, shape (rows, limbs)."""
    true_pose: Floats | None = None
    """Where the plant tells it: of the body, shape (rows, 3)."""
    true_angles: Floats | None = None
    """At the gears' outputs, shape (rows, limbs, 2) [rad]."""
    notes: Json | None = None
    """What came out, as the report has it."""

    def to_log(self) -> Log:
        """Columns by name, with `notes` as JSON."""
        columns: dict[str, Floats] = {"time": self.time, "step": self.step.astype(float)}
        units = {"time": "s"}
        for word, poses in (("believed", self.believed), ("aim", self.aim), ("true", self.true_pose)):
            for k, (axis, unit) in enumerate(POSE):
                if poses is not None:
                    columns[f"body {axis} {word}"], units[f"body {axis} {word}"] = poses[:, k], unit
        for i, limb in enumerate(self.limbs):
            for word, values, unit in (
                ("angle", self.angles, "rad"),
                ("output angle", self.true_angles, "rad"),
                ("torque", self.torques, "N m"),
            ):
                for j, joint in enumerate(JOINTS):
                    if values is not None:
                        name = f"{limb} {joint} {word}"
                        columns[name], units[name] = values[:, i, j], unit
            columns[f"{limb} hold"] = self.holds[:, i].astype(float)
            columns[f"{limb} carries"] = self.carries[:, i].astype(float)
        notes = {"limbs": json.dumps(self.limbs)}
        if self.notes is not None:
            notes["report"] = json.dumps(self.notes)
        return Log(columns, units, notes, "climb")

    @classmethod
    def from_log(cls, log: Log) -> "ClimbTrace":
        """The trace that `to_log` made a log of.

        Raises:
            LogError: If it is no log of a climb.
        """
        if "limbs" not in log.notes:
            raise LogError(log.label, None, None, None, "is no log of a climb: its notes name no limbs")
        limbs = tuple(json.loads(log.notes["limbs"]))

        def poses(word: str) -> Floats:
            return np.stack([log.column(f"body {axis} {word}") for axis, _ in POSE], axis=1)

        def joints(word: str) -> Floats:
            every = [[log.column(f"{limb} {joint} {word}") for joint in JOINTS] for limb in limbs]
            return np.moveaxis(np.array(every), 2, 0)

        def marks(word: str) -> Ints:
            return np.stack([log.column(f"{limb} {word}") for limb in limbs], axis=1).astype(np.int32)

        true = "body x true" in log.columns
        return cls(
            limbs=limbs, time=np.asarray(log.column("time")), step=log.column("step").astype(np.int32),
            believed=poses("believed"), aim=poses("aim"), angles=joints("angle"), torques=joints("torque"),
            holds=marks("hold"), carries=marks("carries"), true_pose=poses("true") if true else None,
            true_angles=joints("output angle") if true else None,
            notes=json.loads(log.notes["report"]) if "report" in log.notes else None,
        )  # fmt: skip


class TracedClimber(Climber):
    """A climber that keeps what happens at its ticks.

    Args:
        truth: What tells how it really is, for the log alone; None where nothing does.
        every: Ticks between samples.
    """

    def __init__(
        self, *args: Any, truth: Callable[[], Truth] | None = None, every: int = EVERY, **options: Any
    ) -> None:
        super().__init__(*args, **options)
        self.truth, self._every = truth, every
        self.step = 0
        """Number of the action that is carried out."""
        self._rows: list[tuple[Any, ...]] = []
        self._kept = -1

    def tick(self) -> None:
        """As a climber's, kept; the tick of a fall is, too."""
        try:
            super().tick()
        except BaseException:
            self.keep()
            raise
        if self.ticks % self._every == 0:
            self.keep()

    def keep(self) -> None:
        """Take a sample of now, in place of one that there is."""
        if self._kept == self.ticks:
            self._rows.pop()
        self._kept = self.ticks
        body, true = self.body, None if self.truth is None else self.truth()
        self._rows.append((
            self.time, self.step, body.settled.copy(), body.aim.copy(), body.q.copy(), body.torques.copy(),
            [task.hold for task in body.tasks], [task.doing == "hold" for task in body.tasks],
            None if true is None else true.pose, None if true is None else true.q,
        ))  # fmt: skip

    def trace(self, notes: Json | None = None) -> ClimbTrace:
        """All samples so far."""
        self.keep()
        time, step, believed, aim, q, torques, holds, carries, pose, true_q = zip(*self._rows, strict=True)
        known = self.truth is not None
        return ClimbTrace(
            limbs=tuple(limb.name for limb in self.robot.limbs), time=np.array(time), step=np.array(step, np.int32),
            believed=np.array(believed), aim=np.array(aim), angles=np.array(q), torques=np.array(torques),
            holds=np.array(holds, np.int32), carries=np.array(carries, np.int32),
            true_pose=np.array(pose) if known else None, true_angles=np.array(true_q) if known else None, notes=notes,
        )  # fmt: skip
