"""How stiff the stiff direction can be made, with play and delay, before the tip cycles: SCCT and J^T matched to it, beside figure 3.14."""

from typing import Final

import numpy as np

from ...control.law_settings import LawSettings
from ...limb_bench.measures import Entry
from ...limb_bench.runner import run_contest
from ...limb_bench.scenario import step_scenario
from ...sim.bench_limb import BenchLimb
from ...sim.limb_flaws import LimbFlaws
from ...units import DEGREE
from .limb_entries import MATCHED, SCCT, matched_transpose, scct, transpose

WORN: Final = LimbFlaws(backlash=2.0 * DEGREE, encoder_counts=400, delay=1)
"""As the robot is: play, encoders, 200 Hz, one sample of delay."""
TIMES: Final = tuple(2.0 ** (k / 4) for k in range(14, 24))
"""Stiffness along y over that of the reference."""
CYCLE: Final = 5e-4
"""Way of the tip, peak to peak, that counts as cycling [m]."""
SECONDS: Final = 6.0
LATE: Final = 5.0
"""From here on the tip is to rest [s]."""
NUDGE: Final = 0.005
"""A step along y that sets the tip moving [m]."""


def _stiffer(reference: LawSettings, times: float) -> LawSettings:
    """The reference with `times` the stiffness along y, its damping ratio kept."""
    (soft, stiff), (slow, fast) = np.broadcast_to(reference.kp, 2), np.broadcast_to(reference.kd, 2)
    return scct((float(soft), float(stiff * times)), (float(slow), float(fast * times**0.5)))


def first_to_cycle(limb: BenchLimb, reference: LawSettings) -> dict[str, float | None]:
    """Label of a law -> Kp of y of the SCCT that it is as stiff as, raised by fourths of a doubling until the tip cycles.

    None: it does not cycle at any that was tried.
    """
    scenario = step_scenario(limb, WORN.control_rate, dy=-NUDGE, seconds=SECONDS)
    out: dict[str, float | None] = dict.fromkeys((SCCT, *(transpose(match) for match in MATCHED)))
    for times in TIMES:
        gains = _stiffer(reference, times)
        laws = {
            SCCT: gains,
            **{transpose(match): matched_transpose(limb.chain, gains, limb.q0, match) for match in MATCHED},
        }
        trying = [Entry(label, law) for label, law in laws.items() if out[label] is None]
        for run in run_contest(limb, scenario, trying, WORN):
            late = run.trace.true_places()[run.trace.time >= LATE, 0, :2]
            if not np.ptp(late, axis=0).max() <= CYCLE:  # this way round, NaN counts as cycling
                out[run.entry.label] = float(np.broadcast_to(gains.kp, 2)[1])
    return out
