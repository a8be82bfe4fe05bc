"""A climb as frames: what every animation shows, whatever it is written as."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from .climber import Snapshot
from .motion import Phase, Transition
from .view import ClimbView

FRAMES: Final = {"move": 5, "swing": 10, "reach": 8, "release": 2, "still": 1}
"""Frames of a phase where there is room for all."""
PAUSE: Final = 2.5
"""Frames' worth of time that a settled stance is shown."""


@dataclass(frozen=True, slots=True)
class Frame:
    """One frame of an animation."""

    step: int
    """Number of the action it belongs to, from 1; 0 is the start."""
    snapshot: Snapshot
    length: float
    """How long it is shown, in frame times [-]."""


def make_frames(view: ClimbView, most: int) -> list[Frame]:
    """The frames of a climb, at most `most` of them: long plans get fewer per action, then not every action.

    Forces and torques pass evenly from one stance to the next; only those of settled stances are computed.
    """
    task, stances = view.task, view.replay.stances
    transitions = [Transition(task.robot, task.world, before, after).phases() for before, after in pairwise(stances)]
    wanted = sum(FRAMES[phase.kind] for phases in transitions for phase in phases)
    thin = min(1.0, most / max(wanted + 1, 1))
    frames = [Frame(0, view.snapshot(0), 3 * PAUSE)]
    for step, phases in enumerate(transitions, start=1):
        frames += _step_frames(view, step, phases, thin)
    frames[-1] = Frame(frames[-1].step, frames[-1].snapshot, 6 * PAUSE)
    if len(frames) > most:
        frames = [frames[k] for k in np.linspace(0, len(frames) - 1, most).round().astype(int)]
    return frames


def _step_frames(view: ClimbView, step: int, phases: list[Phase], thin: float) -> list[Frame]:
    first, last = view.snapshot(step - 1), view.snapshot(step)
    counts = [max(1 if k == len(phases) - 1 else 0, round(thin * FRAMES[p.kind])) for k, p in enumerate(phases)]
    total, done = sum(counts), 0
    frames = []
    for phase, count in zip(phases, counts, strict=True):
        for k in range(1, count + 1):
            done += 1
            share = k / count
            way = done / total
            ease = share * share * (3.0 - 2.0 * share) if phase.kind != "move" else share
            settled = done == total
            frames.append(
                Frame(
                    step,
                    Snapshot(
                        phase.at(ease),
                        last.forces if settled else first.forces + (last.forces - first.forces) * way,
                        last.torques if settled else first.torques + (last.torques - first.torques) * way,
                    ),
                    (1.0 if phase.kind == "move" else PAUSE) if settled else 1.0,
                )
            )
    return frames
