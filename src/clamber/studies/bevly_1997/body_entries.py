"""What chapter 4 compares on the body: SCCT, J^T held as stiffly in every sense, joint PD and the scheme of 4.4.5."""

from dataclasses import replace
from typing import Final

from ...families.climber.execution.body_gains import BodyGains
from ...families.climber.trials.body_bench import BodyEntry
from ...families.climber.trials.body_entries import COORDINATED, read_gains
from ...families.climber.trials.body_stand import BodyStand
from ...limb_bench.entries import MATCHES
from .limb_entries import SCCT, transpose

OWN: Final = "our own control"
BIASED: Final = f"{SCCT}, alpha {BodyGains().alpha:g}"
JOINT_PD: Final = "joint PD"
EARLIER: Final = "scheme of 4.4.5"
TABLE_4_1: Final = BodyGains(
    kp=(100.0, 50.0, 10.0), kd=(5.0, 2.5, 0.5), mapping="thesis", limit="thesis", alpha=0.0, weight_fed=0.95
)
"""The printed gains, the printed map T, the printed limit of the hooks' accelerations."""
OURS: Final = BodyGains()
"""Our own control as it climbs: map, limit and gains of ours."""
OUR_ALPHA: Final = replace(TABLE_4_1, alpha=OURS.alpha)
"""Printed ones with an alpha of ours."""
PEG_ERROR: Final = 0.00635
"""How well the thesis knows its pegs, each way along each axis [m]."""
PLANT: Final = (
    "The plant is our simulation, not the robot: contact dynamics of MuJoCo, hooks and pegs as drawn for it (their sizes are not "
    "printed).",
    "T is the printed one with its mistakes mended (section 4.4.1: rows swapped, signs, the moment of the x forces left out).",
    f"The limit of 4.4.2 keeps a hook's acceleration along its grab direction at alpha or more, \"some offset greater than or equal to "
    f'zero"; its number is not printed. 0 is taken for it, without a bias; {OURS.alpha:g} m/s^2 is ours.',
)


def scct_and_transposes(stand: BodyStand, reference: BodyGains) -> list[BodyEntry]:
    """SCCT as `reference`, J^T in every sense as stiff at the stand's start, and with the same numbers."""
    return [
        BodyEntry(SCCT, reference),
        *(BodyEntry(transpose(m), read_gains("jacobian-transpose", reference, stand, m)) for m in MATCHES),
    ]


def rivals(stand: BodyStand, reference: BodyGains) -> list[BodyEntry]:
    """Joint PD in the mean as stiff as `reference`, and the scheme of 4.4.5, as stiff in each direction, the weight not fed."""
    return [
        BodyEntry(JOINT_PD, read_gains("leg-by-leg:joint-pd", reference, stand, "mean")),
        BodyEntry(EARLIER, read_gains(COORDINATED, reference, stand, "diagonal")),
    ]
