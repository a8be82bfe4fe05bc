"""A plan as frames: what every animation shows, whatever it is written as."""

from dataclasses import dataclass
from typing import Final, Generic

import numpy as np

from .view import Moment, Part, View

FRAMES: Final = {
    "move": 5, "swing": 10, "reach": 8, "release": 2, "still": 1, "slide": 3, "land": 4, "both": 3, "lift": 4,
}  # fmt: skip
"""Frames of a phase where there is room for all."""
EVEN: Final = frozenset({"move", "slide"})
"""Phases that often follow each other: they neither speed up nor slow down, and are not paused after."""
PAUSE: Final = 2.5
"""Frames' worth of time that a settled stance is shown."""


@dataclass(frozen=True, slots=True)
class Frame(Generic[Moment]):
    """One frame of an animation."""

    step: int
    """Number of the action it belongs to, from 1; 0 is the start."""
    moment: Moment
    length: float
    """How long it is shown, in frame times [-]."""


def make_frames(view: View[Moment], most: int) -> list[Frame[Moment]]:
    """The frames of a plan, at most `most` of them: long plans get fewer per action, then not every action."""
    steps = len(view.replay.reasons)
    motions = [view.motion(step) for step in range(1, steps + 1)]
    wanted = sum(FRAMES[part.kind] for parts in motions for part in parts)
    thin = min(1.0, most / max(wanted + 1, 1))
    frames = [Frame(0, view.settled(0), 3 * PAUSE)]
    for step, parts in enumerate(motions, start=1):
        frames += _step_frames(step, parts, thin)
    frames[-1] = Frame(frames[-1].step, frames[-1].moment, 6 * PAUSE)
    if len(frames) > most:
        frames = [frames[k] for k in np.linspace(0, len(frames) - 1, most).round().astype(int)]
    return frames


def _step_frames(step: int, parts: list[Part[Moment]], thin: float) -> list[Frame[Moment]]:
    counts = [max(1 if k == len(parts) - 1 else 0, round(thin * FRAMES[p.kind])) for k, p in enumerate(parts)]
    total, done = sum(counts), 0
    frames = []
    for part, count in zip(parts, counts, strict=True):
        for k in range(1, count + 1):
            done += 1
            share = k / count
            ease = share if part.kind in EVEN else share * share * (3.0 - 2.0 * share)
            pause = 1.0 if done < total or part.kind in EVEN else PAUSE
            frames.append(Frame(step, part.at(ease, done / total), pause))
    return frames
