"""What happens in a walk, sample by sample, and the log that it becomes."""

import json
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from ....control.support import support_margin
from ....execution.log import Log, LogError
from ....execution.sample_log import fields_of, report_notes, report_of, sample_log, table_of, width
from ....execution.samples import Samples
from ....types import Floats, Ints, Json
from ..robot import LEG_NAMES
from .walker import LEGS, Walker

TOPIC: Final = "walk"
"""Channel of its log."""
EVERY: Final = 5
"""Ticks between samples; the last tick is always one."""
POSE: Final = (("x", "m"), ("y", "m"), ("z", "m"), ("alpha", "rad"), ("beta", "rad"), ("gamma", "rad"))
PLACE: Final = (("x", "m"), ("y", "m"), ("theta", "rad"))
PHASES: Final = ("prepare", "lift", "slide", "lower", "settle")
"""What a walk does, by number."""
WHOLE: Final = frozenset({"step", "phase", "stands"})
"""Fields of whole numbers."""
NO_INSIDE: Final = -1.0
"""What samples and logs have for a margin of minus infinity, where fewer than three feet stand: less than any where it stands [m]."""


def walk_titles(*, true: bool, arm: bool = False) -> dict[str, tuple[str, ...]]:
    """Field of `WalkTrace` -> titles of its columns in a log, in the order of a sample's numbers.

    Args:
        true: Whether the truth is told, too.
        arm: Whether that tells of a tool.
    """

    def poses(word: str) -> tuple[str, ...]:
        return tuple(f"plate {axis} {word} [{unit}]" for axis, unit in POSE)

    def places(word: str) -> tuple[str, ...]:
        return tuple(f"Y-frame {axis} {word} [{unit}]" for axis, unit in PLACE)

    titles = {"time": ("time [s]",), "step": ("step",), "phase": ("phase",), "believed": poses("believed")}
    titles["place"] = places("believed")
    titles["lengths"] = tuple(f"{leg} length [m]" for leg in LEG_NAMES)
    titles["commanded"] = tuple(f"{leg} commanded [m]" for leg in LEG_NAMES)
    titles["actuators"] = tuple(f"actuator {i + 1} commanded [m]" for i in range(3))
    titles["forces"] = tuple(f"{leg} force [N]" for leg in LEG_NAMES)
    titles["stands"] = tuple(f"{leg} stands" for leg in LEG_NAMES)
    titles["inclines"] = ("incline along x [rad]", "incline along y [rad]")
    titles["margin"] = ("margin believed [m]",)
    if true:
        titles["true_pose"], titles["true_place"] = poses("true"), places("true")
        titles["true_margin"] = ("margin true [m]",)
        titles["true_feet"] = tuple(f"{leg} sole {axis} [m]" for leg in LEG_NAMES for axis in "xyz")
        titles["true_forces"] = tuple(f"{leg} ground force {axis} [N]" for leg in LEG_NAMES for axis in "xyz")
        titles["true_centre"] = tuple(f"centre of mass {axis} true [m]" for axis in "xyz")
        titles["thrusts"] = tuple(f"actuator {i + 1} force [N]" for i in range(3))
    if true and arm:
        titles["true_tool"] = tuple(f"tool {axis} true [m]" for axis in "xyz")
    return titles


def walker_notes() -> dict[str, str]:
    """What a walk's log says of itself from its start."""
    return {"walker": json.dumps(LEG_NAMES)}


@dataclass(frozen=True, slots=True, eq=False)
class WalkTrace:
    """A walk, `rows` samples long."""

    time: Floats
    """Shape (rows,) [s]."""
    step: Ints
    """Number of the step that is carried out, from 1; 0 before the first, shape (rows,)."""
    phase: Ints
    """Which of `PHASES`, shape (rows,)."""
    believed: Floats
    """Pose of the plate, shape (rows, 6) [m], [rad]."""
    place: Floats
    """Of the Y-frame in the Delta-frame, shape (rows, 3) [m], [rad]."""
    lengths: Floats
    """Of the legs, as sensed, shape (rows, 6) [m]."""
    commanded: Floats
    """Likewise as commanded."""
    actuators: Floats
    """Commanded, shape (rows, 3) [m]."""
    forces: Floats
    """Along the legs, shape (rows, 6) [N]."""
    stands: Ints
    """1 for feet that stand, as believed, shape (rows, 6)."""
    inclines: Floats
    """As read, shape (rows, 2) [rad]."""
    margin: Floats
    """Of the believed centre of mass inside the feet that stand, shape (rows,) [m]."""
    true_pose: Floats | None = None
    """Where the plant tells it, shape (rows, 6)."""
    true_place: Floats | None = None
    """Shape (rows, 3)."""
    true_margin: Floats | None = None
    """Of the true centre of mass inside the feet that touch, shape (rows,) [m]."""
    true_feet: Floats | None = None
    """Soles, shape (rows, 6, 3) [m]."""
    true_forces: Floats | None = None
    """Of the ground on each foot, world frame, shape (rows, 6, 3) [N]."""
    true_centre: Floats | None = None
    """Centre of mass, shape (rows, 3) [m]."""
    thrusts: Floats | None = None
    """Of the actuators, truly, shape (rows, 3) [N]; positive pushes the frames' attachments apart."""
    true_tool: Floats | None = None
    """The arm's tool point, shape (rows, 3) [m]; None without an arm."""
    notes: Json | None = None
    """What came out, as the report has it."""

    def tilt(self) -> Floats:
        """Angle of the plate from the horizontal, truly where that is told, shape (rows,) [rad]."""
        pose = self.believed if self.true_pose is None else self.true_pose
        tilt: Floats = np.arccos(np.clip(np.cos(pose[:, 4]) * np.cos(pose[:, 5]), -1.0, 1.0))
        return tilt

    def to_log(self) -> Log:
        """Columns by name, with `notes` as JSON."""
        notes = walker_notes() | ({} if self.notes is None else report_notes(self.notes))
        true = None if self.true_margin is None else np.maximum(self.true_margin, NO_INSIDE)
        finite = replace(self, margin=np.maximum(self.margin, NO_INSIDE), true_margin=true)
        titles = walk_titles(true=self.true_pose is not None, arm=self.true_tool is not None)
        return sample_log(finite, titles, notes, TOPIC)

    @classmethod
    def from_log(cls, log: Log) -> "WalkTrace":
        """The trace of a walk's log.

        Raises:
            LogError: If it is no log of a walk.
        """
        if "walker" not in log.notes:
            raise LogError(log.label, None, None, None, "is no log of a walk: its notes name no walker's legs")
        titles = walk_titles(true="plate x true" in log.columns, arm="tool x true" in log.columns)
        return cls.from_table(table_of(log, titles), report_of(log))

    @classmethod
    def from_table(cls, table: Floats, notes: Json | None) -> "WalkTrace":
        """The trace of samples under `walk_titles`, shape (rows, columns)."""
        true, arm = (table.shape[1] > width(walk_titles(true=true)) for true in (False, True))
        shapes = {"true_feet": (LEGS, 3), "true_forces": (LEGS, 3)}
        parts: dict[str, Any] = fields_of(table, walk_titles(true=true, arm=arm), whole=WHOLE, shapes=shapes)
        for margin in ("margin", "true_margin"):
            if margin in parts:
                parts[margin] = np.where(parts[margin] > NO_INSIDE, parts[margin], -np.inf)
        return cls(notes=notes, **parts)


class TracedWalker(Walker):
    """A walker that keeps what happens at its ticks; keyword `every` says how many ticks lie between samples."""

    def __init__(self, *args: Any, every: int = EVERY, **options: Any) -> None:
        super().__init__(*args, **options)
        self.step, self.phase = 0, 0
        """Number of the step that is carried out, and which of `PHASES`."""
        self.samples = Samples(self, every)

    @property
    def titles(self) -> tuple[str, ...]:
        """Of a sample's numbers, once the robot is on the ground."""
        true = self.plant.truth()
        fields = walk_titles(true=true is not None, arm=true is not None and bool(np.isfinite(true.tool).all()))
        return tuple(title for titles in fields.values() for title in titles)

    def tick(self) -> None:
        """As a walker's, kept; the tick of a fall is, too."""
        self.samples.over(super().tick)

    def brace_tick(self) -> None:
        """One tick without a command: motors of length stay where they were last told to be. Kept, too."""
        self.samples.over(self._let_pass)

    def _let_pass(self) -> None:
        self.plant.step()
        self.ticks += 1

    def sample(self) -> Floats:
        """Of now, in the order of `titles`; finite."""
        true = self.plant.truth()
        parts = [
            (self.time, self.step, self.phase), self.pose, self.place, self.sensed, self.commanded, self.actuators,
            self.forces, self.stands, self.readings, (max(self.margin(), NO_INSIDE),),
        ]  # fmt: skip
        if true is not None:
            feet = true.feet.reshape(LEGS, 3)
            margin = max(support_margin(feet, true.touching.ravel(), true.centre), NO_INSIDE)
            parts += [true.pose, true.place, (margin,), feet.ravel(), true.forces.ravel(), true.centre, true.thrusts]
            parts += [true.tool] if np.isfinite(true.tool).all() else []
        return np.concatenate([np.asarray(part, float) for part in parts])

    def trace(self, notes: Json | None = None) -> WalkTrace:
        """All samples so far."""
        return WalkTrace.from_table(self.samples.table(), notes)
