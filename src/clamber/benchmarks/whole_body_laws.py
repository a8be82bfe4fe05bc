"""Every law of a whole body on the first steps of three robots, and the time of its tick beside placo's and TSID's on the same moments."""

from collections.abc import Sequence
from functools import partial
from typing import Final

import numpy as np

from ..control.whole_body.law import BodyLaw, WholeBody
from ..families.spatial.control.laws import BODY_LAWS, USUAL
from ..families.spatial.trials.law_rivals import RIVALS, Tick, installed
from ..families.spatial.trials.law_trials import Moment, first_steps, law_at, spatial_task, try_law
from .control_speed import round_times
from .rows import NOTHING, Row, Say, keep_quiet

TASKS: Final = ("wall-gripper", "stones-quadruped", "corners-magnet")
ROUNDS: Final = 15
EXTRAS: Final = {"placo": "placo", "tsid": "tsid"}
"""Rival -> the extra that has it; their Pinocchios are not the same."""


def _tick_all(laws: Sequence[BodyLaw]) -> None:
    for law in laws:
        law.look()
        law.tick()


def _ask_all(tick: Tick, many: int) -> None:
    for i in range(many):
        tick(i)


def law_rows(*, tasks: Sequence[str] = TASKS, rounds: int = ROUNDS, say: Say = keep_quiet) -> list[Row]:
    """Stand, a move of the body, a regrab and another move by each law; errors as they truly were, ticks on moments of the first run."""
    rows: list[Row] = []
    for name in tasks:
        task = spatial_task(name)
        plan = first_steps(task)
        moments: list[Moment] = []
        for law in BODY_LAWS:
            say(f"{name}: first steps by {law}")
            trial, seen = try_law(task, plan, law)
            moments = seen if law == USUAL else moments
            said = f"{name}, {law}"
            rows += [
                Row(f"{said}: motions carried out ({trial.reason or 'done'})", trial.motions, "motions"),
                Row(f"{said}: body off its aim, at most", 1e3 * trial.body, "mm"),
                Row(f"{said}: swinging tip off its path, at most", 1e3 * trial.tip, "mm"),
                Row(f"{said}: tip that holds slid, at most", 1e3 * trial.slid, "mm"),
                Row(f"{said}: largest share of a torque", 100.0 * trial.torque, "%"),
                Row(f"{said}: contacts that came off", trial.off, "contacts"),
            ]
        say(f"{name}: ticks")
        kinds = {law: [law_at(task, moment, law) for moment in moments] for law in BODY_LAWS}
        works = {law: partial(_tick_all, laws) for law, laws in kinds.items()}
        missing = []
        for rival, make in RIVALS.items():
            if installed(rival):
                works[rival] = partial(_ask_all, make(kinds[USUAL]), len(moments))
            else:
                missing.append(f"{rival} (not installed: pip install 'clamber[{EXTRAS[rival]}]')")
        times = np.median(round_times(tuple(works.values()), rounds), axis=0) / len(moments)
        rows += [Row(f"{name}, {law}: tick", 1e6 * seconds, "us") for law, seconds in zip(works, times, strict=True)]
        told = [law.told for law in kinds[USUAL] if isinstance(law, WholeBody)]
        solving = np.median([each["setup_time"] + each["solve_time"] for each in told])
        rows.append(Row(f"{name}, {USUAL}: of its tick DAQP's", 1e6 * float(solving), "us"))
        rows += [Row(f"{name}, {rival}", NOTHING, "us") for rival in missing]
    return rows
