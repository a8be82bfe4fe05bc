"""Laws on the same limb, the same plant and the same command: run them, keep what happened."""

from collections.abc import Sequence
from dataclasses import dataclass

from ...control.controller import Controller
from ...control.law_settings import LawSettings
from ...execution.closed_loop import close_loop
from ...execution.trace import LimbTrace
from ...sim.limb_flaws import LimbFlaws
from ...sim.plants import plant_maker
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


def run_contest(
    limb: BenchLimb, scenario: Scenario, entries: Sequence[Entry], flaws: LimbFlaws, plant: str = "mujoco"
) -> list[Run]:
    """Run every entry alone, from rest at the limb's start, on the plant of that name.

    Raises:
        UnknownNameError: If there is no such plant.
        PlantError: If the plant does not have one of the flaws.
        LawError: If settings do not fit the limb.
        MeasurementError: If the simulation leaves the finite numbers.
    """
    stage = plant_maker(plant)(limb.chain, scenario.on(flaws), gears=limb.gears)
    out = []
    for entry in entries:
        controller = Controller(limb.chain, entry.settings, period=flaws.period)
        stage.reset(limb.q0)
        out.append(Run(entry, close_loop(stage, controller, scenario.aims)))
    return out
