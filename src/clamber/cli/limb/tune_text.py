"""A tuning as people read it: one line for each law."""

import math
from pathlib import Path

from rich.console import Console

from ...limb_bench.steadiness import QUIET_FROM, STEADY
from ...limb_bench.tune import Tuning
from ...sim.flaw_texts import plant_words
from ..output import plain_table

HEADS = {
    "kp": "kp", "kd": "kd", "limit": "limit\nkp", "linear": "of\nlinear", "kxx": "Kxx\nN/mm", "kyy": "Kyy\nN/mm",
    "cycle": "p-p\nmm", "over": "over\n%", "iae": "IAE\nmm s",
}  # fmt: skip


def print_tuning(console: Console, result: Tuning, save: Path | None, output: Path | None) -> None:
    """Print what was found, and where it was written."""
    limb = result.limb
    console.print(f"recommended gains, {limb.robot.name}'s {limb.name} limb", style="bold")
    console.print(f"plant: {plant_words(result.flaws)}")
    console.print(
        f"margin: the limb comes to rest, within {1e3 * STEADY:g} mm after {QUIET_FROM:g} s, up to {result.margin:g} times the gains"
    )
    console.print()
    table = plain_table("law", *HEADS.values(), right=tuple(HEADS.values()))
    for law in result.laws:
        table.add_row(
            law.law,
            f"{law.kp:.4g}",
            f"{law.kd:.3g}",
            f"{law.limit_kp:.4g}",
            f"{law.limit_kp / law.linear_kp:.2f}",
            *(f"{value / 1e3:.1f}" for value in law.stiffness),
            f"{1e3 * law.peak_to_peak:.2f}" if math.isfinite(law.peak_to_peak) else "lost",
            f"{100 * law.overshoot:.0f}",
            f"{1e3 * law.iae:.2f}",
        )
    console.print(table)
    console.print()
    console.print(
        "kp, kd: N m/rad, N m s/rad; of jacobian-transpose N/m, N s/m;\n        of operational-space 1/s^2, 1/s"
    )
    console.print("of linear: limit kp over that of the linear loop; K: of the tip at the start")
    console.print(
        "p-p: true tip at rest, worst run; over: worst step of 2 cm, by encoders;\nIAE: of a step of 2 cm in -y"
    )
    for law in result.laws:
        if not law.steady:
            console.print(f"{law.law}: does not come to rest at these gains: {law.situation}", soft_wrap=True)
    for path in (save, output):
        if path is not None:
            console.print(f"written to {path}", soft_wrap=True)
