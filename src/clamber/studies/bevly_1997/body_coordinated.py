"""Section 4.4.5: the weight fed forward, or the second leg commanded inside its peg (coordinated Jacobian transpose, Sunada 1992)."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from ...families.climber.execution.body_gains import BodyGains
from ...families.climber.trials.body_bench import SLOT, BodyEntry, BodyRun, run_body
from ...families.climber.trials.body_entries import COORDINATED, read_gains
from ...families.climber.trials.body_stand import BodyStand, bench_flaws, ladder_stand, push
from ...types import Floats
from ...viewing.study_lines_plot import Points, draw_panels
from ..result import Cells, Compared, Figure, StudyResult, Table, Verdict
from . import MILLI
from .body_entries import EARLIER, PEG_ERROR, PLANT, TABLE_4_1
from .limb_entries import SCCT

SEEDS: Final = 12
STAND: Final = 3.0
"""Time that the body stands [s]."""
FORCE: Final = 60.0
"""Of the push that asks legs to push as well as pull, half a sine of 0.5 s, as in `fig-4-19` [N]."""
WEIGHTS: Final = {"fed": 0.95, "not fed": 0.0}
"""Name -> part of the weight that is fed forward."""


@dataclass(frozen=True, slots=True)
class Claims:
    """What of the section is so here."""

    needless: bool
    """Unfed, the earlier scheme keeps both hooks on their pegs, and the control of 4.4 without the weight does not or moves farther."""
    knowing: bool
    """It loses hooks where pegs are off the map, and none where they are where the map has them."""
    pushing: bool
    """It loses a hook when the body is pushed and keeps its body better than that control with tips that can push."""


def judged(claims: Claims) -> Verdict:
    """holds: all three; open: some; differs: none."""
    found = (claims.needless, claims.knowing, claims.pushing)
    return "holds" if all(found) else "open" if any(found) else "differs"


def controls(stand: BodyStand) -> dict[tuple[str, str], BodyGains]:
    """Control, weight -> gains: Table 4.1's SCCT, and the earlier scheme as stiff in each direction."""
    earlier = read_gains(COORDINATED, TABLE_4_1, stand, "diagonal")
    return {
        (label, weight): replace(gains, weight_fed=part)
        for label, gains in ((SCCT, TABLE_4_1), (EARLIER, earlier))
        for weight, part in WEIGHTS.items()
    }


def compare_schemes() -> StudyResult:
    """Both controls with and without the weight: at rest, with pegs that are not where the map has them, and pushed."""
    stand, flaws = ladder_stand(), bench_flaws("nominal")
    ways = controls(stand)
    rest = push(stand.pose, flaws.period, force=(0.0, 0.0), seconds=0.5, after=STAND)
    shoved = push(stand.pose, flaws.period, force=(FORCE, 0.0), seconds=0.5)
    standing = {way: run_body(stand, rest, BodyEntry(" ".join(way), gains), flaws) for way, gains in ways.items()}
    drawn = [
        np.random.default_rng(seed).uniform(-PEG_ERROR, PEG_ERROR, (len(stand.robot.limbs), 2)) for seed in range(SEEDS)
    ]
    usual = {SCCT: (SCCT, "fed"), EARLIER: (EARLIER, "not fed")}
    lost = {
        label: sum(
            run_body(stand, rest, BodyEntry(label, ways[way]), flaws, map_errors=errors).trace.unhooked_at is not None
            for errors in drawn
        )
        for label, way in usual.items()
    }
    pushed = {
        (label, held): run_body(replace(stand, fixed=held == "fixed"), shoved, _entry(label, ways[way], held), flaws)
        for label, way in usual.items()
        for held in ("on hooks", "fixed")
    }
    sags = {way: _off(run) for way, run in standing.items()}
    on = {way: run.trace.unhooked_at is None for way, run in standing.items()}
    moved = {
        case: float(np.abs(run.trace.pose[:, 0] - run.trace.pose[shoved.begin, 0]).max())
        for case, run in pushed.items()
    }
    claims = Claims(
        needless=on[EARLIER, "not fed"]
        and (not on[SCCT, "not fed"] or sags[SCCT, "not fed"] > sags[EARLIER, "not fed"]),
        knowing=on[EARLIER, "not fed"] and lost[EARLIER] > 0,
        pushing=pushed[EARLIER, "on hooks"].trace.unhooked_at is not None
        and moved[EARLIER, "fixed"] < moved[SCCT, "fixed"],
    )
    return StudyResult(
        claim="Section 4.4.5: a second leg that is commanded inside its peg needs no weight fed forward; but it needs to know where the "
        "pegs are, and a leg that can push and pull. So the weight is fed, and the body is kept less accurately.",
        verdict=judged(claims),
        compared=(
            *(Compared(f"{label}, weight {weight}: hooks at rest", "on" if on[label, weight] else "came off") for label, weight in ways),
            *(Compared(f"{label}, weight {weight}: body off its aim at rest [mm]", sags[label, weight] * MILLI) for label, weight in ways),
            *(Compared(f"{label}, weight {weight}: second hook moved off its seat, most [mm]", _second(standing[label, weight]))
              for label, weight in ways),
            *(Compared(f"{label}: a hook came off, pegs up to 6.35 mm off the map, of {SEEDS}", count) for label, count in lost.items()),
            *(Compared(f"{label}, {held}, pushed by {FORCE:g} N: hooks", "on" if run.trace.unhooked_at is None else "came off")
              for (label, held), run in pushed.items() if held == "on hooks"),
            *(Compared(f"{label}, {held}, pushed by {FORCE:g} N: body moves along x [mm]", moved[label, held] * MILLI)
              for label, held in pushed),
            *(Compared(f"claim: {name}", "so" if found else "not so") for name, found in (
                ("the weight need not be fed", claims.needless), ("the pegs must be known", claims.knowing),
                ("legs must push and pull", claims.pushing))),
        ),
        deviations=(
            *PLANT,
            "The printed text gives no numbers. The earlier scheme is four springs, on the body's x, y and angle and on how deep the "
            "second leg is in its peg (8 N with a peg of 20 N/mm, ours), as stiff on the body as Table 4.1's SCCT in each direction.",
            f"The verdict counts three claims. The weight need not be fed: unfed, the scheme keeps both hooks within {SLOT * MILLI:g} mm "
            "of their pegs, where SCCT unfed does not or is farther off its aim. Pegs must be known: it loses a hook in one or more of "
            f"{SEEDS} maps that are up to 6.35 mm wrong along each axis, and none with the right one. Legs must push and pull: it loses a "
            "hook when pushed, but with tips fixed keeps the body better than SCCT. All: holds; some: open; none: differs.",
            f"That the weight need not be fed is so by that rule alone: unfed, the body sags by {sags[EARLIER, 'not fed'] * MILLI:.0f} mm "
            f"on its spring under the scheme and by {sags[SCCT, 'not fed'] * MILLI:.0f} mm under SCCT, and both keep their hooks.",
            f"At rest the body stands for {STAND:g} s after a second of settling; the push is that of `fig-4-19`.",
        ),
        table=Table(
            ("control", "weight", "hooks at rest", "body off its aim along x [mm]", "along y [mm]", "turned [deg]"),
            tuple(_row(way, run) for way, run in standing.items()),
        ),
        seeds=range(SEEDS),
        figures=(_figure(standing, rest.time),),
    )  # fmt: skip


def _entry(label: str, gains: BodyGains, held: str) -> BodyEntry:
    """Where tips are fixed, hooks cannot come off, and nothing limits their pulls."""
    return BodyEntry(label, replace(gains, limit="none") if held == "fixed" else gains)


def _end(run: BodyRun) -> Floats:
    out: Floats = run.trace.pose[-1] - run.trace.aim[-1]
    return out


def _off(run: BodyRun) -> float:
    """Distance of the body from its aim in the end [m]; infinity for one that left the finite numbers."""
    off = float(np.linalg.norm(_end(run)[:2]))
    return off if np.isfinite(off) else float("inf")


def _second(run: BodyRun) -> float | None:
    """How far the second hook is from its seat at most [mm]."""
    most = float(run.trace.off[:, -1].max()) * MILLI
    return most if np.isfinite(most) else None


def _row(way: tuple[str, str], run: BodyRun) -> Cells:
    x, y, turned = (float(value) if np.isfinite(value) else None for value in _end(run))
    return (
        *way, "on" if run.trace.unhooked_at is None else f"off after {run.trace.unhooked_at:.2f} s",
        None if x is None else x * MILLI, None if y is None else y * MILLI, None if turned is None else float(np.degrees(turned)),
    )  # fmt: skip


def _figure(standing: Mapping[tuple[str, str], BodyRun], time: Floats) -> Figure:
    return Figure(
        "heights",
        "Height of the body over its aim at rest, pegs as the map has them.",
        lambda path: draw_panels(
            {
                f"weight {weight}": {
                    label: Points(time, (run.trace.pose[:, 1] - run.trace.aim[:, 1]) * MILLI)
                    for (label, fed), run in standing.items()
                    if fed == weight
                }
                for weight in WEIGHTS
            },
            ("time [s]", "body above its aim [mm]"),
            "The body at rest on two hooks",
            path,
        ),
    )
