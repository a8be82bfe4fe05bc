"""Laws on the same limb, the same plant and the same command: run them, keep what happened."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from ...control.chain import Chain
from ...control.controller import Controller
from ...control.law_settings import LawSettings
from ...errors import UnknownNameError
from ...execution.closed_loop import close_loop
from ...execution.trace import LimbTrace
from ...sim.limb_flaws import LimbFlaws
from ...sim.limb_plants import PLANTS
from .bench_limb import BenchLimb
from .scenario import Scenario

MISBELIEVED: Final = ("rotor", "damping", "friction", "mass", "inertia")
"""What a controller may be wrong about, joint by joint; lengths and angles it knows."""


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


def run_contest(
    limb: BenchLimb, scenario: Scenario, entries: Sequence[Entry], flaws: LimbFlaws, *, plant: str = "mujoco"
) -> list[Run]:
    """Run every entry alone, from rest at the limb's start; a run that leaves the finite numbers ends in NaN.

    Raises:
        LawError: If settings do not fit the limb.
        UnknownNameError: If there is no such plant.
    """
    if plant not in PLANTS:
        raise UnknownNameError("plant", plant, tuple(PLANTS))
    moved = PLANTS[plant](limb.chain, scenario.on(flaws), gears=limb.gears)
    believed = believed_chain(limb.chain, flaws)
    out = []
    for entry in entries:
        controller = Controller(believed, entry.settings, period=flaws.period)
        moved.reset(limb.q0)
        trace = close_loop(moved, controller, scenario.aims, keep=True)
        out.append(Run(entry, trace, _tick_seconds(controller, trace)))
    return out


def _tick_seconds(controller: Controller, trace: LimbTrace, most: int = 200) -> float:
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
