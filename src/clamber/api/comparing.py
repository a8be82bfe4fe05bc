"""Compare control laws on one limb: the same motion, the same plant, gains matched unless stated."""

from collections.abc import Sequence
from inspect import signature
from typing import Any, Final

from ..limb_bench.bench_limb import bench_limb, load_geared
from ..limb_bench.entries import Match, make_entries, match_pose, reference_law
from ..limb_bench.result import LimbResult, Matching, compare_laws
from ..limb_bench.runner import Contest
from ..limb_bench.scenario import MOTIONS, MotionKind
from ..sim.flaw_texts import named_flaws, read_flaws
from .options import check_kind, check_options, texts

CENTRE: Final = (0.22, 0.0)
RADIUS: Final = 0.05


def compare(
    laws: Sequence[str] = (),
    motion: MotionKind = "step",
    *,
    robot: str = "libra",
    limb: str | None = None,
    tip: tuple[float, float] | None = None,
    flaws: str = "ideal",
    changes: Sequence[str] = (),
    plant: str = "mujoco",
    match: Match = "yy",
    reference: str = "scct",
    kp: float | None = None,
    kd: float | None = None,
    trials: int = 1,
    workers: int = 1,
    seed: int | None = None,
    **how: Any,
) -> LimbResult:
    """Run control laws on one limb, each alone, and measure how well they did.

    Args:
        laws: Texts NAME[:key=value,...], such as "scct" or "jacobian-transpose:kp=1000,kd=100" (`clamber list controllers`); a usual set
            where none is named.
        motion: "step" (dx, dy [m], seconds), "circle" (centre [m], radius [m], lap [s], laps) or "push" (force [N], start, end, seconds).
        robot: A climber's name or file.
        limb: Its limb; None: the first.
        tip: Where the tip is at the start, port frame [m]; None: (0.22, 0), or on the circle.
        flaws: "ideal", or "nominal": backlash, rate and encoders of the robot's file and one sample of delay.
        changes: Texts "key=value" that change the plant, such as "backlash=2deg" or "payload=0.3kg".
        plant: What simulates the limb (`clamber list plants`).
        match: Which stiffness at the tip laws without gains of their own share with `reference`: "yy", "mean", "diagonal", "none".
        reference: The law that is matched to.
        kp, kd: Its gains, in its own units; None: its usual ones.
        trials: Plants that are drawn, from the seed on.
        workers: Processes for them.
        seed: Of play, encoder phase, noise and model error.
        how: Of the motion.

    Returns:
        `rows`, one a law: `entry.label`, `entry.settings`, `stiffness` (2, 2) [N/m], and of every trial `measures` with errors [m] by the
        true angles (`true`) and by the encoders (`encoder`), `work` [J], `saturated` [-]. `to_json()`, `save_table(path)`.

    Raises:
        OptionError: If the motion has no such option, or one of another kind.
        ClamberError: If a law, a limb, a plant or a setting cannot be.
    """
    laws, changes = texts("laws", laws), texts("changes", changes)
    check_kind("motion", motion, MotionKind)
    parameters = signature(MOTIONS[motion]).parameters.values()
    check_options(how, {one.name: one.annotation for one in parameters if one.kind is one.KEYWORD_ONLY}, signed=True)
    properties = read_flaws(named_flaws(flaws, load_geared(robot)[0]), changes, seed, drawn=trials > 1)
    if tip is None:
        x, y = how.get("centre", CENTRE)
        tip = (x + how.get("radius", RADIUS), y) if motion == "circle" else CENTRE
    on_bench = bench_limb(robot, limb, tip, upright=properties.upright)
    scenario = MOTIONS[motion](on_bench, properties.control_rate, **how)
    at = match_pose(on_bench, scenario)
    towards = reference_law(reference, kp, kd)
    contest = Contest(on_bench, scenario, make_entries(on_bench, laws, towards, match, at), properties, plant)
    return compare_laws(contest, trials=trials, workers=workers, matching=Matching(towards, match, at))
