"""Section 4.4.4: how stiff the body may be along x before it cycles, its place measured at one hook and pulled at two."""

from dataclasses import replace
from itertools import product
from typing import Final

import numpy as np

from ...families.climber.execution.body_gains import BodyGains
from ...families.climber.pictures.body_plots import draw_onsets
from ...families.climber.sim.climber_model import HookShape
from ...families.climber.trials.body_bench import BodyEntry, run_body
from ...families.climber.trials.body_stand import BodyStand, bench_flaws, ladder_stand, push
from ...sim.limb_flaws import LimbFlaws
from ..result import Cells, Compared, Figure, StudyResult, Table
from . import MILLI
from .body_entries import BIASED, OUR_ALPHA, OURS, OWN, PLANT, TABLE_4_1
from .limb_entries import SCCT

GAINS: Final = tuple(float(100.0 * 2 ** (k / 2)) for k in range(-4, 15))
"""Kpx that are tried, a root of two apart."""
CYCLE: Final = 0.001
"""A body that moves to and fro along x by more than this is cycling [m]."""
WAIT: Final = 5.0
"""After the nudge; what moves in the last two seconds of it counts [s]."""
NUDGE: Final = 8.0
"""[N], half a sine of 0.2 s."""
PLAY: Final = {"no": HookShape(side_play=0.0), "1 mm": HookShape(side_play=0.001), "3 mm": HookShape(side_play=0.003)}
"""Slot's width over the peg's diameter."""
BACKLASH: Final = (0.0, 1.0, 2.0)
"""Of each joint, whole [deg]."""
PLACES: Final = {"one hook": True, "both hooks": False}
"""What tells the body's place: the first holding limb alone, as in the thesis, or the mean of both."""
HELD: Final = ("on hooks", "fixed")
BESIDE: Final = {f"on hooks, {BIASED}": BIASED, f"on hooks, {OWN}": OWN}
"""How the tips are held and by which other control -> that control; with 0 and 2 deg of backlash and 1 mm of play."""
Swings = dict[tuple[str, str, float, str], list[float]]
"""Held, place, backlash [deg], play -> peak to peak along x for each of GAINS [mm]."""


def gains_at(kpx: float, control: str = SCCT) -> BodyGains:
    """Gains of a control at a Kpx; our own is as much stiffer along x than it is as Kpx is than the table's, its damping a rate."""
    part = kpx / TABLE_4_1.kp[0]
    if control == OWN:
        return replace(OURS, stiffness=(part * OURS.stiffness[0], *OURS.stiffness[1:]))
    kdx = TABLE_4_1.kd[0] * part**0.5
    reference = OUR_ALPHA if control == BIASED else TABLE_4_1
    return replace(reference, kp=(kpx, *reference.kp[1:]), kd=(kdx, *reference.kd[1:]))


def peak_to_peak(stand: BodyStand, kpx: float, first_limb: bool, flaws: LimbFlaws, control: str = SCCT) -> float:
    """How far the body still moves to and fro along x, well after a nudge [m]."""
    gains = gains_at(kpx, control)
    if stand.fixed:
        gains = replace(gains, limit="none")
    scenario = push(stand.pose, flaws.period, force=(NUDGE, 0.0), seconds=0.2, after=WAIT)
    trace = run_body(stand, scenario, BodyEntry("", gains, first_limb=first_limb), flaws).trace
    return float(np.ptp(trace.pose[-round(2.0 / flaws.period) :, 0])) if np.isfinite(trace.pose).all() else float("inf")


def find_onset(swings: list[float]) -> float | None:
    """The least Kpx from which on the body cycles with every stiffer one; None: with none."""
    onset = None
    for kpx, swing in zip(reversed(GAINS), reversed(swings), strict=True):
        if swing <= CYCLE * MILLI:
            break
        onset = kpx
    return onset


def find_end(swings: list[float]) -> float | None:
    """The largest Kpx up to which the body sways with every softer one; None: with none."""
    end = None
    for kpx, swing in zip(GAINS, swings, strict=True):
        if swing <= CYCLE * MILLI:
            break
        end = kpx
    return end


def sweep_stiffness() -> StudyResult:
    """Every stiffness with every backlash and play, by either way to tell the body's place."""
    swings: Swings = {}
    for held, (place, first), backlash, (play, shape) in product(HELD, PLACES.items(), BACKLASH, PLAY.items()):
        if held == "fixed" and play != "no":
            continue
        stand = replace(ladder_stand(fixed=held == "fixed"), shape=shape)
        flaws = bench_flaws("nominal").with_changes(backlash=float(np.radians(backlash)))
        swings[held, place, backlash, play] = [
            min(peak_to_peak(stand, kpx, first, flaws) * MILLI, 1e3) for kpx in GAINS
        ]
    for (held, control), (place, first), backlash in product(BESIDE.items(), PLACES.items(), (0.0, BACKLASH[-1])):
        stand = replace(ladder_stand(), shape=PLAY["1 mm"])
        flaws = bench_flaws("nominal").with_changes(backlash=float(np.radians(backlash)))
        swings[held, place, backlash, "1 mm"] = [
            min(peak_to_peak(stand, kpx, first, flaws, control) * MILLI, 1e3) for kpx in GAINS
        ]
    onsets = {case: find_onset(found) for case, found in swings.items()}

    def bound(*case: object) -> float:
        return onsets[case] or float("inf")  # type: ignore[index]

    worst = BACKLASH[-1]
    by_place = all(bound("on hooks", "one hook", worst, p) < bound("on hooks", "both hooks", worst, p) for p in PLAY)
    by_backlash = bound("on hooks", "one hook", worst, "no") < bound("on hooks", "one hook", 0.0, "no")
    by_play = bound("on hooks", "one hook", 0.0, "3 mm") < bound("on hooks", "one hook", 0.0, "no")
    swaying = {case: find_end(found) for case, found in swings.items()}
    rows: list[Cells] = [
        (*case, onsets[case] or f"none to {GAINS[-1]:.3g}", *(round(swing, 2) for swing in found))
        for case, found in swings.items()
    ]
    return StudyResult(
        claim="Section 4.4.4: as x is measured at one leg but +x is controlled by the other, joint backlash and the play between hooks and "
        "pegs limit how stiff LIBRA can be along x.",
        verdict="holds" if by_backlash and by_play and by_place else "open" if by_backlash or by_play else "differs",
        compared=(
            *(
                Compared(
                    f"{held}, place by {place}, backlash {b:g} deg, {p} play in hooks: cycles from Kpx",
                    onset or "none tried",
                )
                for (held, place, b, p), onset in onsets.items()
            ),
            *(
                Compared(
                    f"{held}, place by {place}, backlash {b:g} deg, {p} play in hooks: sways up to Kpx",
                    end or "none tried",
                )
                for (held, place, b, p), end in swaying.items()
                if held != "fixed"
            ),
            Compared("Kpx of Table 4.1", TABLE_4_1.kp[0], 100.0),
        ),
        deviations=(
            *PLANT,
            f"Kpx is raised by roots of two from {GAINS[0]:.3g} to {GAINS[-1]:.4g}, Kdx from the table's with its root; the other "
            f"gains are the table's. The body is nudged by {NUDGE:g} N; it cycles if it still moves by more than {CYCLE * MILLI:g} mm "
            "along x from 3 to 5 s after. The onset is the least Kpx from which on all stiffer ones cycle.",
            "The verdict is holds if, measured at one hook, 2 deg of backlash alone bring the onset below that of none, 3 mm of play "
            "in the hooks alone likewise, and with 2 deg of backlash measuring at one hook below measuring at both, whatever the play.",
            f'There is another end with an alpha of ours: with "{BIASED}" soft bodies sway slowly by centimetres on their hooks ("sways '
            'up to"); with alpha 0, the printed case, none of them does.',
            f'"{OWN}", its map, limit and gains ours, stands beside and decides nothing; at Kpx 100 it has its own stiffness along x, '
            f"{OURS.stiffness[0]:g} N/m, and else as much more or less.",
            "400 counts a motor turn and a sample of delay throughout, so even without any play there is an end to stiffness; with the "
            "tips fixed (no hooks, no limit on pulls) what is left is the joints' backlash.",
        ),
        table=Table(
            ("held", "place by", "backlash [deg]", "play", "cycles from Kpx", *(f"{kpx:.4g} [mm]" for kpx in GAINS)),
            tuple(rows),
        ),
        figures=(
            Figure(
                "onsets",
                "Motion to and fro along x that is left, by Kpx.",
                lambda path: draw_onsets(
                    GAINS, {case: found for case, found in swings.items() if case[0] == "on hooks"}, CYCLE * MILLI, path
                ),
            ),
        ),
    )
