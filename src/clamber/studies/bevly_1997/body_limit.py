"""Section 4.4.2: hooks whose accelerations are limited to at least alpha along the grab direction, on a rung of the ladder."""

import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from ...families.climber.execution.body_gains import BodyGains
from ...families.climber.execution.climb_trace import ClimbTrace
from ...families.climber.pictures.pictures import draw_heights
from ...families.climber.trials.body_rung import FRICTION, PEG_ERROR, WEIGHT, RungTrial, climb_rungs, watch_rung
from ...jobs import LocalProcesses
from ..result import Cells, Compared, Figure, StudyResult, Table, Value, Verdict
from . import MILLI
from .body_entries import OURS, OWN, PLANT, TABLE_4_1

SEEDS: Final = range(1_000_005_000, 1_000_005_020)
"""Of the noise: those of its page, held out when that was written."""
PLANTS: Final = ("ideal", "nominal")
PRINTED: Final = "alpha 0"
ALPHAS: Final = (0.03, 0.1, OURS.alpha)
"""Offsets that are tried besides [m/s^2]."""
CONTROLS: Final[dict[str, BodyGains]] = {
    PRINTED: TABLE_4_1,
    **{f"alpha {alpha:g}": replace(TABLE_4_1, alpha=alpha) for alpha in ALPHAS},
    "no limit": replace(TABLE_4_1, limit="none"),
    OWN: OURS,
}
"""Label -> gains; all but the last with the printed map and the gains of Table 4.1."""


def judge_limit(ideal: RungTrial, noisy: Sequence[RungTrial]) -> Verdict:
    """holds: the rung is climbed on the ideal plant and under all noise, hooks on; open: hooks stay on alone; differs: one comes off.

    Args:
        ideal: With alpha 0, everything as it is believed to be.
        noisy: Likewise of every seed of the noise.
    """
    trials = (ideal, *noisy)
    if any(trial.lost for trial in trials) or not ideal.done:
        return "differs"
    return "holds" if all(trial.done for trial in trials) else "open"


def limit_pulls() -> StudyResult:
    """A rung with every alpha, without noise and with."""
    alone = {(label, plant): watch_rung(gains, plant) for label, gains in CONTROLS.items() for plant in PLANTS}
    noisy = climb_rungs(CONTROLS, SEEDS, executor=LocalProcesses(os.cpu_count() or 1))
    return StudyResult(
        claim="Section 4.4.2: endpoint accelerations are limited to at least alpha along the grab direction, alpha some offset of 0 or "
        "more, so that a leg never pulls away from its peg.",
        verdict=judge_limit(alone[PRINTED, "ideal"][0], noisy[PRINTED]),
        compared=(
            *(
                Compared(f"{label}, {plant} plant, no noise: {name}", value)
                for (label, plant), (trial, trace) in alone.items()
                for name, value in _rung_numbers(trial, trace).items()
            ),
            *(
                Compared(f"{label}, noise: rungs climbed, of {len(SEEDS)}", sum(trial.done for trial in trials))
                for label, trials in noisy.items()
            ),
            *(
                Compared(f"{label}, noise: rungs with a hook off, of {len(SEEDS)}", sum(trial.lost for trial in trials))
                for label, trials in noisy.items()
            ),
        ),
        deviations=(
            *PLANT,
            f'All but "{OWN}" have the printed map T, the gains of Table 4.1 and 0.95 of the weight fed forward; "{OWN}" is this '
            "robot's own, its map, limit and gains ours, beside.",
            "A rung: leg 1 up, leg 3 over, leg 2 up, leg 3 off, body up by 6 in, from the ladder's start. A hook came off if the tip of "
            "a limb that carries was more than 8 mm from its peg at any tick; a robot whose body stays off its aim by 50 mm and more "
            "gives up, hooks on.",
            "The verdict is holds if with alpha 0 the rung is climbed on the ideal plant and on every seed of the noise, each hook on "
            "its peg; open if every hook stays on and the ideal rung is climbed, but rungs under noise are not; differs if a hook "
            "comes off or the ideal rung is not climbed. Nothing else in the table decides.",
            f"Noise: pegs off by up to {PEG_ERROR * MILLI:g} mm an axis (but for the three that the robot is put on), friction "
            f"+-{FRICTION:.0%}, weight +-{WEIGHT:.0%}; 2 deg of backlash, 400 counts, a sample of delay. Seeds were held out when "
            "this was written: nothing had been tuned on them.",
        ),
        seeds=SEEDS,
        table=_table(noisy),
        figures=(
            Figure(
                "heights",
                "Height of the body less its aim on the ideal plant, without noise, by alpha.",
                lambda path: draw_heights({label: alone[label, "ideal"][1] for label in CONTROLS}, path),
            ),
        ),
    )


def _rung_numbers(trial: RungTrial, trace: ClimbTrace) -> dict[str, Value]:
    assert trace.true_pose is not None
    above = (trace.true_pose - trace.aim)[:, 1] * MILLI
    return {
        "ended by": trial.reason or "the end of the rung",
        "time [s]": trial.seconds,
        "a hook came off": "yes" if trial.lost else "no",
        "body above its aim, most [mm]": float(np.max(above)),
        "body below its aim, most [mm]": float(-np.min(above)),
    }


def _table(noisy: Mapping[str, Sequence[RungTrial]]) -> Table:
    rows: list[Cells] = []
    for label, trials in noisy.items():
        reasons = Counter("climbed" if trial.done else trial.reason.split(":")[0] for trial in trials)
        ends = "; ".join(f"{reason} ({count})" for reason, count in reasons.most_common())
        rows.append((label, sum(t.done for t in trials), sum(t.lost for t in trials), len(trials), ends))
    return Table(
        ("control, under noise", "rungs climbed", "a carrying hook came off", "of", "how they ended"), tuple(rows)
    )
