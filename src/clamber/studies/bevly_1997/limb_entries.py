"""What section 3.4.3 compares, on our plant: leg 1 on both elbow branches, SCCT, J^T matched to it in every sense, and the baselines."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from ...control.chain import Chain
from ...control.law_settings import LawSettings, PerAxis
from ...limb_bench.bench_limb import bench_limb
from ...limb_bench.entries import MATCHES, Match, match_gains, tip_stiffness
from ...limb_bench.measures import Entry
from ...sim.bench_limb import BenchLimb
from ...sim.limb_flaws import LimbFlaws
from ...types import Floats
from ..result import Compared, Verdict

CENTRE: Final = (0.22, 0.0)
"""Where the limb starts, or what it circles about, port frame [m]."""
BRANCHES: Final = {"elbow +": 1, "elbow -": -1}
"""Name of an elbow branch -> sign of the elbow angle."""
IDEAL: Final = LimbFlaws()
"""The friction of Table 3.1, and nothing else that is not ideal."""
SMOOTH: Final = LimbFlaws(friction=0.0)
"""Without Coulomb friction, too."""
SCCT: Final = "SCCT"
PLAIN_RATE: Final = "resolved rate"
WEIGHTED_RATE: Final = "resolved rate, weighted"
OPERATIONAL: Final = "operational space"
BASELINES: Final = (OPERATIONAL, PLAIN_RATE, WEIGHTED_RATE)
MATCHED: Final[tuple[Match, ...]] = ("yy", "mean", "diagonal")
"""The matchings that decide; with "none" J^T takes the same numbers in N/m, which is no comparison."""
PLANT: Final = (
    "The plant is our simulation, not the robot: leg 1 with the joints of Table 3.1, links of 0.30 and 0.15 kg (ours), 200 Hz; "
    "no backlash, no encoder steps, no delay.",
    "It is not said which way the elbow points; (0.22, 0) m is an elbow of 92 or -88 deg with the hook counted in, so both are run.",
)
"""Deviations that every result of the limb shares."""
GAINS: Final = (
    "The gains are not printed; they are ours, with errors in m and torques in N m. K' is diag(0.525, 1): its two entries are "
    "printed alike in 3.26 and 3.27 by mistake.",
    "Operational space has the same gains over the largest joint inertia (its gains are accelerations); resolved rate takes "
    "SCCT's, and weighted by inertia it is SCCT itself as long as the gains of x and y are equal.",
)


def transpose(match: Match) -> str:
    """Label of J^T matched to SCCT in a sense."""
    return f"J^T, {match}"


def leg_1(start: tuple[float, float] = CENTRE) -> dict[str, BenchLimb]:
    """Leg 1 of LIBRA with its tip at `start`, by elbow branch."""
    return {name: bench_limb("libra", "1", start, elbow=sign) for name, sign in BRANCHES.items()}


def scct(kp: PerAxis, kd: PerAxis) -> LawSettings:
    """SCCT with its gains."""
    return LawSettings(law="scct", kp=kp, kd=kd)


def matched_transpose(chain: Chain, reference: LawSettings, q: Floats, match: Match) -> LawSettings:
    """J^T with the stiffness that `reference` has at `q` in a sense; with "none", with the same numbers."""
    return match_gains(chain, replace(reference, law="jacobian-transpose"), reference, q, match)


def entries(chain: Chain, q: Floats, reference: LawSettings) -> list[Entry]:
    """SCCT as `reference`, J^T in every matching at `q`, and the baselines."""
    inertia = chain.largest_inertia
    return [
        Entry(SCCT, reference),
        *(Entry(transpose(match), matched_transpose(chain, reference, q, match)) for match in MATCHES),
        Entry(
            OPERATIONAL,
            LawSettings(law="operational-space", kp=_over(reference.kp, inertia), kd=_over(reference.kd, inertia)),
        ),
        Entry(PLAIN_RATE, LawSettings(law="resolved-rate", kp=reference.kp, kd=float(np.max(reference.kd)))),
        Entry(
            WEIGHTED_RATE,
            LawSettings(law="resolved-rate", kp=reference.kp, kd=float(np.max(reference.kd)), weight="inertia"),
        ),
    ]


def _over(gain: PerAxis, by: float) -> PerAxis:
    return tuple(value / by for value in gain) if isinstance(gain, tuple) else gain / by


def gains_shown(settings: LawSettings) -> tuple[str, str]:
    """Kp and Kd of a law as text."""
    return _shown(settings.kp), _shown(settings.kd)


def _shown(gain: PerAxis) -> str:
    return ", ".join(f"{value:.4g}" for value in np.atleast_1d(gain))


def judged(better: Mapping[Match, bool]) -> Verdict:
    """holds: SCCT is better in every sense of the same stiffness; differs: in none; open: the sense decides."""
    won = [better[match] for match in MATCHED]
    return "holds" if all(won) else "open" if any(won) else "differs"


def stiffness_facts(chain: Chain, q: Floats, reference: LawSettings) -> tuple[Compared, ...]:
    """SCCT's stiffness at the tip, measured from its torques, and how far J^-T K' J^-1 Kp is from it."""
    measured = tip_stiffness(chain, reference, q)
    inverse = np.linalg.inv(chain.jacobian(q)[:2])
    told = inverse.T @ np.diag(chain.joints["share"]) @ inverse @ np.diag(np.broadcast_to(reference.kp, 2))
    return (
        Compared("SCCT's stiffness at the tip: xx [N/m]", float(measured[0, 0])),
        Compared("SCCT's stiffness at the tip: yy [N/m]", float(measured[1, 1])),
        Compared("SCCT's stiffness at the tip: xy [N/m]", float(measured[0, 1])),
        Compared("SCCT's stiffness at the tip: yx [N/m]", float(measured[1, 0])),
        Compared(
            "J^-T K' J^-1 Kp less the measured one, over it: largest [-]",
            float(np.abs(told - measured).max() / np.abs(measured).max()),
        ),
    )
