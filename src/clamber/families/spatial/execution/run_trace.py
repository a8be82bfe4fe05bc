"""What happens while a robot in space carries a plan out, sample by sample, and the log that it becomes."""

import json
from dataclasses import dataclass
from typing import Any, Final, Self

import numpy as np

from ....compiled import ready
from ....execution.log import Log, LogError
from ....execution.sample_log import fields_of, note_of, report_notes, report_of, sample_log, table_of, width
from ....execution.samples import Samples
from ....types import Floats, Ints, Json
from ..robot.chains import Chains
from .limbed_body import LimbedBody
from .reference_kernels import write_sample, write_truth

TOPIC: Final = "limbs"
"""Channel of its log."""
EVERY: Final = 10
"""Ticks between samples; the last tick is always one."""
NAMES: Final = "robot in space"
"""Note of a log that names limbs and joints."""
POSE: Final = (("x", "m"), ("y", "m"), ("z", "m"), ("qw", ""), ("qx", ""), ("qy", ""), ("qz", ""))
WRENCH: Final = (("fx", "N"), ("fy", "N"), ("fz", "N"), ("mx", "N m"), ("my", "N m"), ("mz", "N m"))
WHOLE: Final = frozenset({"action", "holds", "true_holds"})
"""Fields of whole numbers."""


@dataclass(frozen=True, slots=True)
class Named:
    """Limbs and joints of a robot by name."""

    limbs: tuple[str, ...]
    joints: tuple[str, ...]
    """Limb after limb, each from the base to the tip."""

    @classmethod
    def of(cls, chains: Chains) -> Self:
        """Of a robot."""
        return cls(chains.limb_names, tuple(name for limb in chains.joint_names for name in limb))

    def titles(self, *, true: bool) -> dict[str, tuple[str, ...]]:
        """Field of `RunTrace` -> titles of its columns in a log, in the order of a sample's numbers.

        Args:
            true: Whether the truth is told, too.
        """

        def pose(word: str) -> tuple[str, ...]:
            return tuple(f"base {axis} {word}" + (f" [{unit}]" if unit else "") for axis, unit in POSE)

        def joints(word: str, unit: str) -> tuple[str, ...]:
            return tuple(f"{name} {word} [{unit}]" for name in self.joints)

        def wrenches(word: str) -> tuple[str, ...]:
            return tuple(f"{name} {axis} {word} [{unit}]" for name in self.limbs for axis, unit in WRENCH)

        titles = {"time": ("time [s]",), "action": ("action",), "believed": pose("believed"), "wanted": pose("wanted")}
        titles["joints"], titles["torques"] = joints("position", "rad"), joints("torque", "N m")
        titles["wrenches"] = wrenches("felt")
        titles["holds"] = tuple(f"{name} hold" for name in self.limbs)
        if true:
            titles["true_pose"], titles["true_joints"] = pose("true"), joints("true position", "rad")
            titles["true_wrenches"] = wrenches("true")
            titles["true_holds"] = tuple(f"{name} hold true" for name in self.limbs)
        return titles

    def notes(self) -> dict[str, str]:
        """What a log says of itself from its start."""
        return {NAMES: json.dumps({"limbs": self.limbs, "joints": self.joints})}

    @classmethod
    def from_log(cls, log: Log) -> Self:
        """Of a log.

        Raises:
            LogError: If it is no log of a robot in space.
        """
        if NAMES not in log.notes:
            raise LogError(log.label, None, None, None, "is no log of a robot in space: its notes name no limbs")
        said = note_of(log, NAMES)
        try:
            return cls(tuple(map(str, said["limbs"])), tuple(map(str, said["joints"])))
        except (TypeError, KeyError):
            raise LogError(
                log.label, None, None, None, f"its note '{NAMES}' must be a table of limbs and joints"
            ) from None


@dataclass(frozen=True, slots=True, eq=False)
class RunTrace:
    """A run, `rows` samples long."""

    named: Named
    time: Floats
    """Shape (rows,) [s]."""
    action: Ints
    """Number of the plan's action that is carried out, from 1; 0 before the first, shape (rows,)."""
    believed: Floats
    """Of the base: place [m] and quaternion w, x, y, z, shape (rows, 7)."""
    wanted: Floats
    """Where it was to be, likewise."""
    joints: Floats
    """As sensed, shape (rows, n) [rad] or [m]."""
    torques: Floats
    """Commanded, shape (rows, n) [N m] or [N]."""
    wrenches: Floats
    """As felt by each tip, in its end effector's frame, shape (rows, limbs, 6) [N], [N m]."""
    holds: Ints
    """Number of the hold that each limb holds on to, as believed; 0: none, shape (rows, limbs)."""
    true_pose: Floats | None = None
    """Where the plant tells it, shape (rows, 7)."""
    true_joints: Floats | None = None
    """Shape (rows, n)."""
    true_wrenches: Floats | None = None
    """Of the surface on each tip, world frame, shape (rows, limbs, 6)."""
    true_holds: Ints | None = None
    """Numbers of the holds that limbs are truly on, 0: none, shape (rows, limbs)."""
    report: Json | None = None
    """What came out."""

    def to_log(self) -> Log:
        """Columns by name, with the report as a note."""
        notes = self.named.notes() | ({} if self.report is None else report_notes(self.report))
        return sample_log(self, self.named.titles(true=self.true_pose is not None), notes, TOPIC)

    @classmethod
    def from_log(cls, log: Log) -> Self:
        """The trace of a log.

        Raises:
            LogError: If it is no log of a robot in space.
        """
        named = Named.from_log(log)
        titles = named.titles(true="base x true" in log.columns)
        return cls.from_table(named, table_of(log, titles), report_of(log))

    @classmethod
    def from_table(cls, named: Named, table: Floats, report: Json | None) -> Self:
        """The trace of samples under `Named.titles`, shape (rows, columns)."""
        true = table.shape[1] > width(named.titles(true=False))
        shapes = {"wrenches": (len(named.limbs), 6), "true_wrenches": (len(named.limbs), 6)}
        parts: dict[str, Any] = fields_of(table, named.titles(true=true), whole=WHOLE, shapes=shapes)
        return cls(named=named, report=report, **parts)


class TracedBody(LimbedBody):
    """A robot that keeps what happens at its ticks; keyword `every` says how many ticks lie between samples."""

    def __init__(self, *args: Any, every: int = EVERY, **options: Any) -> None:
        super().__init__(*args, **options)
        self.named = Named.of(self.robot.chains)
        self.action = 0
        """Number of the plan's action that is carried out; 0 before the first."""
        self.samples = Samples(self, every)

    @property
    def titles(self) -> tuple[str, ...]:
        """Of a sample's numbers."""
        true = self.plant.truth() is not None
        return tuple(title for titles in self.named.titles(true=true).values() for title in titles)

    def tick(self) -> None:
        """As of any, kept; the tick of a fall is, too."""
        self.samples.over(super().tick)

    def sample(self) -> Floats:
        """Of now, in the order of `titles`."""
        true = self.plant.truth()
        n, limbs = len(self.law.torques), len(self.holds)
        row = np.empty(16 + 2 * n + 7 * limbs + (0 if true is None else 7 + n + 7 * limbs))
        row[0], row[1] = self.time, self.action
        at = self._write_sample(row, 2)
        if true is not None:
            write_truth(true.pose.position, true.pose.rotation, true.joints, true.wrenches, true.attached, row[at:])
        return row

    def _take_hold(self) -> None:
        super()._take_hold()
        self._write_sample = ready(write_sample, self.handle, np.zeros(1), 0)

    def trace(self, report: Json | None = None) -> RunTrace:
        """All samples so far."""
        return RunTrace.from_table(self.named, self.samples.table(), report)
