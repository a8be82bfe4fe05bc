"""Laws on the same limb, the same plant and the same command: run them, keep what happened."""

from collections.abc import Sequence
from dataclasses import dataclass

from ...control.controller import Controller
from ...control.law_settings import LawSettings
from ...execution.closed_loop import close_loop
from ...execution.trace import LimbTrace
from ...sim.limb_flaws import LimbFlaws
from ...sim.mujoco_limb import MujocoLimb
from .bench_limb import BenchLimb
from .scenario import Scenario


@dataclass(frozen=True, slots=True)
class Entry:
    """One law in a contest, under a label."""

    label: str
    settings: LawSettings


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """What one entry did."""

    entry: Entry
    trace: LimbTrace


def run_contest(limb: BenchLimb, scenario: Scenario, entries: Sequence[Entry], flaws: LimbFlaws) -> list[Run]:
    """Run every entry alone, from rest at the limb's start.

    Raises:
        LawError: If settings do not fit the limb.
        MeasurementError: If the simulation leaves the finite numbers.
    """
    plant = MujocoLimb(limb.chain, scenario.on(flaws), gears=limb.gears)
    out = []
    for entry in entries:
        controller = Controller(limb.chain, entry.settings, period=flaws.period)
        plant.reset(limb.q0)
        out.append(Run(entry, close_loop(plant, controller, scenario.aims)))
    return out
