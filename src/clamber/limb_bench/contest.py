"""Laws on the same limb, the same plant and the same command: run them, keep what happened."""

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from ..control.chain import Chain
from ..control.law_settings import LawSettings
from ..control.outside_law import LoopController, controller_of
from ..execution.closed_loop import close_loop
from ..execution.trace import LimbTrace
from ..sim.limb_flaws import ForceSensor, LimbFlaws
from ..sim.plants import plant_maker
from .bench_limb import BenchLimb
from .scenario import Scenario

MISBELIEVED: Final = ("rotor", "damping", "friction", "mass", "inertia")
"""What a controller may be wrong about, joint by joint; lengths and angles it knows."""
MOMENT_ARM: Final = 0.05
"""Noise of a sensor's moments over that of its forces, of a size with the sensor [m]."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One law in a contest, under a label."""

    label: str
    settings: LawSettings
    own_gains: bool = True
    """Whether its gains are as stated for it, not matched to a reference."""


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """What one entry did."""

    entry: Entry
    trace: LimbTrace
    tick_seconds: float
    """Of one call of the controller from Python, on this machine [s]."""


def believed_chain(chain: Chain, flaws: LimbFlaws) -> Chain:
    """The chain as a controller believes it that is wrong by up to `flaws.model_error`, drawn from the seed."""
    if flaws.model_error == 0.0:
        return chain
    assert flaws.seed is not None
    # a stream of its own: the plant's draws stay the same whatever is believed
    draw = np.random.default_rng(np.random.SeedSequence(flaws.seed, spawn_key=(1000,)))
    joints = chain.joints.copy()
    for j in range(chain.n):
        for key in MISBELIEVED:
            joints[key][j] *= 1.0 + draw.uniform(-flaws.model_error, flaws.model_error)
    return Chain(chain.name, chain.joint_names, joints, chain.root.copy(), chain.plane).with_shares("inertia")


def with_sensors(flaws: LimbFlaws, entries: Sequence[Entry]) -> LimbFlaws:
    """The plant with the force sensors that the laws read and `flaws` does not have: ideal but for its `wrench_noise`."""
    noise, seed = flaws.wrench_noise, flaws.seed or 0
    needed = frozenset[str]().union(*(entry.settings.sensors() for entry in entries))
    added = {
        place: ForceSensor(noise=noise, moment_noise=MOMENT_ARM * noise, seed=2 * seed + k)
        for k, place in enumerate(("wrist", "base"))
        if place in needed and getattr(flaws, place) is None
    }
    return flaws.with_changes(**added)


def run_contest(
    limb: BenchLimb,
    scenario: Scenario,
    entries: Sequence[Entry],
    flaws: LimbFlaws,
    *,
    plant: str = "mujoco",
    timed: bool = True,
) -> list[Run]:
    """Run every entry alone, from rest at the limb's start; a run that leaves the finite numbers ends in NaN.

    Laws that read a force have one to read: the plant gets the sensors of `with_sensors`.

    Args:
        limb: On the bench.
        scenario: What is asked of it.
        entries: The laws.
        flaws: Of the plant.
        plant: Its name.
        timed: Whether to measure how long a tick takes; else `Run.tick_seconds` is NaN.

    Raises:
        UnknownNameError: If there is no such plant.
        PlantError: If the plant does not have one of the flaws.
        LawError: If settings do not fit the limb.
    """
    moved = plant_maker(plant)(limb.chain, scenario.on(with_sensors(flaws, entries)), gears=limb.gears)
    believed = believed_chain(limb.chain, flaws)
    out = []
    for entry in entries:
        controller = controller_of(believed, entry.settings, period=flaws.period)
        moved.reset(limb.q0)
        trace = close_loop(moved, controller, scenario.aims, keep=True)
        out.append(Run(entry, trace, _tick_seconds(controller, trace) if timed else math.nan))
    return out


def _tick_seconds(controller: LoopController, trace: LimbTrace, most: int = 200) -> float:
    """Seconds of one tick, by the law again on what was sensed: the best of three rounds."""
    rounds = []
    count = min(most, len(trace.time))
    states = [trace.sensed[k] for k in range(count) if np.isfinite(trace.sensed[k]).all()]
    if not states:
        return float("nan")
    for _ in range(3):
        controller.reset()
        begin = time.perf_counter()
        for k, state in enumerate(states):
            controller.command(trace.aims[k], state)
        rounds.append((time.perf_counter() - begin) / len(states))
    return min(rounds)
