"""The result of an open-loop comparison: every transform's path as a value and as JSON."""

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

from ..execution.log import Log
from ..files import write_atomically
from ..sim.flaw_texts import plant_words
from ..sim.limb_flaws import LimbFlaws
from ..types import Json
from .bench_limb import BenchLimb
from .open_loop import FIRST, TRANSFORMS, OpenLoopRun, first_turn, run_open_loop
from .run_logs import run_logs

SCHEMA: Final = "clamber-open-loop-1"
FAR: Final = (0.02, 0.05)
"""Ways along the wanted direction at which the stray is told [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class OpenLoopResult:
    """Paths of one limb's tip under several transforms of the same wanted direction."""

    limb: BenchLimb
    flaws: LimbFlaws
    plant: str
    direction: float
    """From the x axis of the port frame [rad]."""
    renewed: bool
    """Whether the torques followed the pose."""
    runs: tuple[OpenLoopRun, ...]

    @property
    def moved(self) -> bool:
        """Whether any transform moved the tip far enough to have a direction."""
        return any(run.turned() is not None for run in self.runs)

    def plant_words(self) -> str:
        """The plant and what is not ideal about it, in one line."""
        return f"{self.plant}, {plant_words(self.flaws, rate=False)}"

    def predicted(self, run: OpenLoopRun) -> float:
        """Angle of the first acceleration from the wanted direction by the dynamics without friction [rad]."""
        return first_turn(self.limb.chain, self.limb.q0, run.torques, run.wanted)

    def to_json(self) -> Json:
        """Everything but the paths, in SI units and radians; `null` where the tip never got so far.

        Keys are stable: schema, limb, plant, force, direction, renewed, first, transforms.
        """
        return {
            "schema": SCHEMA,
            "limb": {
                "robot": self.limb.robot.name,
                "name": self.limb.name,
                "start": list(self.limb.start),
                "angles": [float(q) for q in self.limb.q0],
            },
            "plant": {"name": self.plant} | asdict(self.flaws),
            "force": self.runs[0].force,
            "direction": self.direction,
            "renewed": self.renewed,
            "first": FIRST,
            "transforms": [
                {
                    "law": run.transform,
                    "torques": run.torques.tolist(),
                    "turned": run.turned(),
                    "predicted": self.predicted(run),
                    "strays": [{"after": far, "stray": run.stray(far)} for far in FAR],
                    "moved": run.moved,
                }
                for run in self.runs
            ],
        }

    def logs(self) -> dict[str, Log]:
        """Transform -> every step of its run."""
        return run_logs(self.limb, self.flaws, ((run.transform, run.trace) for run in self.runs))

    def save(self, path: Path) -> None:
        """Write `to_json` to a file, whole or not at all."""
        write_atomically(path, json.dumps(self.to_json(), indent=2, allow_nan=False) + "\n")


def compare_open_loop(
    limb: BenchLimb,
    flaws: LimbFlaws,
    transforms: Sequence[str] = tuple(TRANSFORMS),
    *,
    force: float = 10.0,
    direction: float = -math.pi / 2,
    seconds: float = 0.7,
    renewed: bool = False,
    plant: str = "mujoco",
) -> OpenLoopResult:
    """Run every transform from rest at the limb's start; arguments and errors as in `run_open_loop`."""
    runs = tuple(
        run_open_loop(
            limb, transform, flaws, force=force, direction=direction, seconds=seconds, renewed=renewed, plant=plant
        )
        for transform in transforms
    )
    return OpenLoopResult(limb, flaws, plant, direction, renewed, runs)
