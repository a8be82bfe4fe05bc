"""How often a climb survives one of two hooks that carry coming off at any moment.

    PYTHONPATH=tests python tests/execution/slips_by_hand.py SEED N

Two rungs of the ladder under the usual noise; the seed draws when, of all ticks in which two limbs carry and the third is free, and which
limb's peg is not there for a quarter of a second.
"""

import sys
from collections import Counter

import numpy as np
from test_slip import Knocked

from clamber.families.climber.execution.climb_trace import TracedClimber

LAST = 3600
"""Ticks of two rungs in which two limbs carry and the third is free, about."""


def slip(seed: int) -> tuple[str, Knocked]:
    """What becomes of the climb of a seed, in a word, and the climb."""
    chance = np.random.default_rng(seed)
    left, which = int(chance.integers(1, LAST)), int(chance.integers(0, 2))

    def due(climber: TracedClimber) -> bool:
        nonlocal left
        mode = [task.mode for task in climber.body.tasks]
        if mode.count("stance") != 2 or "unloaded_contact" in mode or "contact_push" in mode:
            return False
        left -= 1
        climb.limb = [i for i, what in enumerate(mode) if what == "stance"][which]
        return left < 0

    climb = Knocked(seed, when=due)
    report = climb.climb()
    if climb.knocked is None:
        return "nothing came off", climb
    fell = any(action.outcome == "fell" for action in report.actions)
    return "climbed on" if report.done else "fell" if fell else "hangs", climb


if __name__ == "__main__":
    first, n = int(sys.argv[1]), int(sys.argv[2])
    told: Counter[str] = Counter()
    for seed in range(first, first + n):
        word, climb = slip(seed)
        told[word] += 1
        print(seed, word, climb.knocked, climb.sequencer.performer.report.reason, flush=True)
    print(dict(told))
