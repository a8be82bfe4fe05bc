"""What happens in a climb, sample by sample, and the log that it becomes."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ....compiled import Handle, ready
from ....execution.log import Log, LogError
from ....execution.plant import BodyTruth
from ....execution.sample_log import fields_of, note_of, report_notes, report_of, sample_log, table_of, width
from ....execution.samples import Samples
from ....types import Floats, Ints, Json
from ..control.body_estimate import sample_tick
from .climber import Climber

TOPIC: Final = "climb"
"""Channel of its log."""
POSE: Final = (("x", "m"), ("y", "m"), ("theta", "rad"))
JOINTS: Final = ("shoulder", "elbow")
EVERY: Final = 4
"""Ticks between samples; the last tick is always one."""
WHOLE: Final = frozenset({"step", "holds", "carries"})
"""Fields of whole numbers."""
UNKNOWN: Final = np.empty(0), np.empty((0, 2))
"""Pose and joint angles of a climber that nobody tells of."""
JOINTWISE: Final = ("angles", "true_angles", "torques")
"""Fields with two numbers a limb."""


def climb_titles(limbs: tuple[str, ...], *, true: bool) -> dict[str, tuple[str, ...]]:
    """Field of `ClimbTrace` -> titles of its columns in a log, in the order of a sample's numbers.

    Args:
        limbs: Their names.
        true: Whether the plant tells how things really are.
    """

    def poses(word: str) -> tuple[str, ...]:
        return tuple(f"body {axis} {word} [{unit}]" for axis, unit in POSE)

    def joints(word: str, unit: str) -> tuple[str, ...]:
        return tuple(f"{limb} {joint} {word} [{unit}]" for limb in limbs for joint in JOINTS)

    titles = {"time": ("time [s]",), "step": ("step",), "believed": poses("believed"), "aim": poses("aim")}
    if true:
        titles["true_pose"] = poses("true")
    titles["angles"] = joints("angle", "rad")
    if true:
        titles["true_angles"] = joints("output angle", "rad")
    titles["torques"] = joints("torque", "N m")
    titles["holds"] = tuple(f"{limb} hold" for limb in limbs)
    titles["carries"] = tuple(f"{limb} carries" for limb in limbs)
    return titles


def limb_notes(limbs: tuple[str, ...]) -> dict[str, str]:
    """What a climb's log says of itself from its start."""
    return {"limbs": json.dumps(limbs)}


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
        notes = limb_notes(self.limbs) | ({} if self.notes is None else report_notes(self.notes))
        return sample_log(self, climb_titles(self.limbs, true=self.true_pose is not None), notes, "climb")

    @classmethod
    def from_log(cls, log: Log) -> "ClimbTrace":
        """The trace of a climb's log; one that is cut has no notes.

        Raises:
            LogError: If it is no log of a climb.
        """
        if "limbs" not in log.notes:
            raise LogError(log.label, None, None, None, "is no log of a climb: its notes name no limbs")
        limbs = note_of(log, "limbs")
        if not isinstance(limbs, list) or not limbs or not all(isinstance(name, str) for name in limbs):
            raise LogError(log.label, None, None, None, "its note 'limbs' must be a list of names")
        limbs = tuple(limbs)
        fields = climb_titles(limbs, true="body x true" in log.columns)
        return cls.from_table(limbs, table_of(log, fields), report_of(log))

    @classmethod
    def from_table(cls, limbs: tuple[str, ...], table: Floats, notes: Json | None) -> "ClimbTrace":
        """The trace of samples under `climb_titles`, shape (rows, columns)."""
        n = len(limbs)
        titles = climb_titles(limbs, true=table.shape[1] > width(climb_titles(limbs, true=False)))
        shapes = dict.fromkeys(JOINTWISE, (n, 2)) | {"holds": (n,), "carries": (n,)}
        parts: dict[str, Any] = fields_of(table, titles, whole=WHOLE, shapes=shapes)
        return cls(limbs=limbs, notes=notes, **parts)


class TracedClimber(Climber):
    """A climber that keeps what happens at its ticks.

    Args:
        truth: What tells how it really is, for the log alone; None where nothing does.
        every: Ticks between samples.
    """

    def __init__(
        self, *args: Any, truth: Callable[[], BodyTruth] | None = None, every: int = EVERY, **options: Any
    ) -> None:
        super().__init__(*args, **options)
        self.truth = truth
        self.step = 0
        """Number of the action that is carried out."""
        self.samples = Samples(self, every)
        self._width = len(self.titles)
        self._sample = ready(sample_tick, Handle(self.body.work, self.load), 0.0, 0.0, *UNKNOWN, np.empty(self._width))

    @property
    def limbs(self) -> tuple[str, ...]:
        """Names of the limbs."""
        return tuple(limb.name for limb in self.robot.limbs)

    @property
    def titles(self) -> tuple[str, ...]:
        """Of a sample's numbers."""
        fields = climb_titles(self.limbs, true=self.truth is not None)
        return tuple(title for titles in fields.values() for title in titles)

    def tick(self) -> None:
        """As a climber's, kept; the tick of a fall is, too."""
        self.samples.over(super().tick)

    def brace_tick(self) -> None:
        """As a climber's, kept."""
        self.samples.over(super().brace_tick)

    def sample(self) -> Floats:
        """Of now, in the order of `titles`."""
        pose, q = UNKNOWN if self.truth is None else self.truth()[:2]
        row = np.empty(self._width)
        self._sample(self.time, float(self.step), np.ascontiguousarray(pose), np.ascontiguousarray(q), row)
        return row

    def trace(self, notes: Json | None = None) -> ClimbTrace:
        """All samples so far."""
        return ClimbTrace.from_table(self.limbs, self.samples.table(), notes)
