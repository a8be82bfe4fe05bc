"""A body pushed many times: another friction, weight, height and size of the push each time, from either side."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from ....json_form import INLINE, Jsonable
from ....sim.limb_flaws import LimbFlaws
from .body_bench import BodyEntry, run_body
from .body_measures import BodyMeasures, measure_body
from .body_scenario import push
from .body_stand import BodyStand

FRICTION = 0.3
"""Joint friction differs by up to this part [-]."""
WEIGHT = 0.1
"""Likewise the weight, which the controller does not know of [-]."""
HEIGHT = 0.005
"""The body stands higher or lower by up to this [m]."""
STRENGTH = 0.1
"""The push is stronger or weaker by up to this part [-]."""


@dataclass(frozen=True, slots=True)
class PushTrial(Jsonable):
    """One push."""

    seed: int
    side: int
    """1 towards +x, -1 towards -x."""
    measures: Annotated[BodyMeasures, INLINE]


def push_trials(
    stand: BodyStand,
    entry: BodyEntry,
    flaws: LimbFlaws,
    *,
    force: tuple[float, float],
    seconds: float,
    trials: int,
    seed: int = 0,
    progress: Callable[[int, int], None] | None = None,
) -> list[PushTrial]:
    """Push the body sideways, half a sine, seeds from `seed` on; even seeds push towards +x.

    Args:
        stand: Where the robot is held.
        entry: Its control.
        flaws: Of the plant before each trial's own friction.
        force: Largest; its x goes either way [N].
        seconds: How long it acts.
        trials: How many.
        seed: The first.
        progress: Told after each trial how many have ended, and how many there are.
    """
    out = []
    for k in range(seed, seed + trials):
        draw = np.random.default_rng(k)
        friction, weight, strength = (1.0 + draw.uniform(-part, part) for part in (FRICTION, WEIGHT, STRENGTH))
        side = 1 if k % 2 == 0 else -1
        pose = stand.pose + np.array((0.0, draw.uniform(-HEIGHT, HEIGHT), 0.0))
        scenario = push(pose, flaws.period, force=(side * strength * force[0], strength * force[1]), seconds=seconds)
        run = run_body(
            replace(stand, pose=pose, weight=weight), scenario, entry,
            flaws.with_changes(friction=flaws.friction * friction),
        )  # fmt: skip
        out.append(PushTrial(k, side, measure_body(run, scenario)))
        if progress is not None:
            progress(k - seed + 1, trials)
    return out
