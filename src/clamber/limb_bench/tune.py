"""The largest gains of a law at which a limb still comes to rest, and gains a stated margin below them.

For each of some damping times kd/kp, kp grows from a little below the linear limit until a run does not come to rest (`steadiness`), and a
bisection closes in on the edge. Recommended is the edge divided by the margin, at the damping time with the largest kp among those whose
steps then overshoot little; the edge is proved on more frictions first, and lowered until it holds there. What comes out is tried again
at other poses, directions and frictions.
"""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from operator import attrgetter
from pathlib import Path
from typing import Annotated, Any, Final

import numpy as np

from ..control.law_settings import LAWS, LawSettings
from ..control.recommended import Recommended
from ..errors import StatedError
from ..jobs import Outcome, read_result
from ..json_form import Jsonable, Key, in_json
from ..sim.bench_limb import BenchLimb
from ..sim.limb_flaws import LimbFlaws
from ..types import Json
from .bench_limb import bench_limb
from .entries import read_law, tip_stiffness
from .measures import Entry, measure
from .result import BenchResult
from .runner import Crew, run_contest
from .scenario import step_scenario
from .stability import SECONDS, STEADY, Effort, linear_limit, overshoot, poses, scaled_gains, unrest

DAMPING_TIMES: Final = (0.01, 0.014, 0.02, 0.028, 0.04, 0.057, 0.08, 0.113, 0.16, 0.226)
"""kd/kp that are tried [s]."""
MARGIN: Final = 2.0
"""Gain margin: the edge over what is recommended [-]; 2 is 6 dB."""
OVERSHOOT: Final = 0.15
"""Most that a step of 2 cm may overshoot by the encoders at recommended gains, where some damping time allows it [-]."""
PRECISION: Final = 0.03
"""Of an edge, relative."""
FIRST: Final = 0.8
"""Where the search starts, over the linear limit."""
GROWTH: Final = 2.0**0.25
WIDEST: Final = 2.0**8
"""How far from the linear limit an edge is looked for, both ways."""
LOWER: Final = (0.5, 0.25)
"""Parts of the recommended gains that must be steady too: stability is then no island."""
LATER: Final = 11.0
"""From when on those must be still [s]: a quarter of the gains may take longer to arrive, which is no limit cycle."""


class TuningError(StatedError):
    """A tuning that cannot be: names the law or the key, the problem and what is allowed."""

    says = "{what}: {problem}; {allowed}"
    what: str
    problem: str
    allowed: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Edge:
    """Where a law stops coming to rest, at one damping time."""

    damping_time: float
    """kd over kp [s]."""
    kp: float
    """Largest that was found steady, in the law's unit."""
    beyond: float
    """Smallest found unsteady."""
    linear_kp: float
    """Where the linear loop without play and Coulomb friction turns unstable."""
    situation: str
    """The least steady run at `beyond`."""
    overshoot: float
    """Largest of steps of 2 cm by the encoders, at `kp` over the margin [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tuned(Jsonable):
    """What was found for one law."""

    law: str
    """As asked for: the name, with settings other than kp and kd."""
    edges: tuple[Edge, ...]
    """One of each damping time."""
    damping_time: float
    """The one that was taken [s]."""
    limit_kp: float
    """Its edge, proved with all frictions."""
    linear_kp: float
    kp: float
    """Recommended."""
    kd: float
    stiffness: tuple[float, float]
    """Of the tip along x and y at the limb's start, at the recommended gains [N/m]."""
    peak_to_peak: float
    """Largest of the true tip after 5 s at the recommended gains, over all frictions, poses and situations [m]."""
    situation: str
    """Where that was."""
    lower: float
    """The same at a half and a quarter of the gains, after 6 s, with the least friction [m]."""
    overshoot: float
    """Largest of steps of 2 cm by the encoders, at the recommended gains [-]."""
    iae: float
    """Of the true tip in a step of 2 cm in -y from the limb's start, 7 s [m s]."""

    @property
    @in_json()
    def steady(self) -> bool:
        """Whether the recommended gains, and less, come to rest everywhere they were tried."""
        return max(self.peak_to_peak, self.lower) <= STEADY


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Tuning(BenchResult):
    """What was found for a limb."""

    picture = "sweep:draw_tuning"
    limb: Annotated[
        BenchLimb,
        Key("robot", get=attrgetter("robot.name"), kind=str),
        Key(get=attrgetter("name"), kind=str),
        Key("start", get=attrgetter("start"), kind=tuple[float, float]),
    ]
    flaws: Annotated[LimbFlaws, Key("plant", kind=dict[str, Any])]
    margin: float
    laws: Annotated[tuple[Tuned, ...], Key(after="threshold")]

    @in_json(after="margin")
    def threshold(self) -> float:
        """Peak to peak below which a tip counts as steady [m]."""
        return STEADY

    @property
    def steady(self) -> bool:
        """Whether every law is steady at its recommended gains."""
        return all(law.steady for law in self.laws)

    def recommended(self) -> list[Recommended]:
        """Gains to be kept, of the laws that are steady with them."""
        keys = ("backlash", "encoder_counts", "delay", "control_rate", "friction", "upright")
        plant = {key: value for key, value in asdict(self.flaws).items() if key in keys}
        return [
            Recommended(
                robot=self.limb.robot.name, limb=self.limb.name, law=law.law, kp=law.kp, kd=law.kd, plant=plant,
                limit_kp=rounded_down(law.limit_kp, 4), margin=self.margin,
                stiffness=(round(law.stiffness[0], 1), round(law.stiffness[1], 1)),
            )
            for law in self.laws
            if law.steady
        ]  # fmt: skip


def rounded_down(value: float, digits: int) -> float:
    """The next number of so many digits that is not larger."""
    scale = 10.0 ** (math.floor(math.log10(value)) - digits + 1)
    return float(f"{math.floor(value / scale * (1 + 1e-12)) * scale:.{digits}g}")


def _rebuilt(item: Json) -> tuple[BenchLimb, LimbFlaws, LawSettings]:
    """Limb, plant, and the law with a kp of 1, of an item in a worker."""
    limb = bench_limb(item["robot"], item["limb"], tuple(item["start"]), upright=item["flaws"]["upright"])
    unit = replace(read_law(item["law"]), kp=1.0, kd=item["damping_time"], joint_kp=None, joint_kd=None)
    return replace(limb, q0=np.array(item["q0"])), LimbFlaws(**item["flaws"]), unit


def find_edge(item: Json) -> Json:
    """The edge of one law at one damping time; runs in a worker.

    Args:
        item: `robot`, `limb`, its `start` and `q0`, `law` as text, `damping_time`, `margin`, `flaws`.

    Returns:
        The fields of `Edge`, or `problem`.
    """
    limb, flaws, unit = _rebuilt(item)
    linear = linear_limit(limb.chain, unit, flaws, poses(limb))
    low, high, where = FIRST * linear, math.inf, ""
    while high == math.inf:
        found = unrest(limb, scaled_gains(unit, low), flaws, "search")
        if found.steady:
            break
        low, high, where = low / GROWTH, low, found.situation
        if low * WIDEST < linear:
            return {"problem": "came to rest with no gains that were tried"}
    while high == math.inf or high > low * (1.0 + PRECISION):
        middle = low * GROWTH if high == math.inf else math.sqrt(low * high)
        if middle > linear * WIDEST:
            return {"problem": "came to rest with all gains that were tried"}
        found = unrest(limb, scaled_gains(unit, middle), flaws, "search")
        if found.steady:
            low = middle
        else:
            high, where = middle, found.situation
    return {
        "damping_time": item["damping_time"],
        "kp": low,
        "beyond": high,
        "linear_kp": linear,
        "situation": where,
        "overshoot": overshoot(limb, scaled_gains(unit, low / item["margin"]), flaws),
    }


def settle_gains(item: Json) -> Json:
    """Prove an edge, step back from it by the margin, and try what comes out; runs in a worker.

    Args:
        item: As of `find_edge`, with `kp` of the edge, and the `effort` of the last trial.

    Returns:
        The fields of `Tuned` beside `law` and `edges`.
    """
    limb, flaws, unit = _rebuilt(item)
    effort: Effort = item["effort"]
    limit = item["kp"]
    while not unrest(limb, scaled_gains(unit, limit), flaws, "full").steady:
        limit /= 1.0 + PRECISION
    kp = rounded_down(limit / item["margin"], 3)
    law = replace(unit, kp=kp, kd=float(f"{kp * item['damping_time']:.3g}"))
    worst = unrest(limb, law, flaws, effort, stop=False)
    lower = max(unrest(limb, scaled_gains(law, part), flaws, "search", since=LATER).peak_to_peak for part in LOWER)
    scenario = step_scenario(limb, flaws.control_rate, seconds=SECONDS)
    (run,) = run_contest(limb, scenario, [Entry(law.law, law)], flaws)
    told = measure(run, scenario, limb)
    stiffness = tip_stiffness(limb.chain, law, limb.q0)
    return {
        "damping_time": item["damping_time"],
        "limit_kp": limit,
        "kp": kp,
        "kd": law.kd,
        "stiffness": [float(stiffness[0, 0]), float(stiffness[1, 1])],
        "peak_to_peak": worst.peak_to_peak,
        "situation": worst.situation,
        "lower": lower,
        "overshoot": overshoot(limb, law, flaws),
        "iae": told.true.iae,
    }


def tune(
    limb: BenchLimb,
    laws: Sequence[str],
    flaws: LimbFlaws,
    *,
    robot: str | None = None,
    margin: float = MARGIN,
    damping_times: Sequence[float] = DAMPING_TIMES,
    effort: Effort = "fine",
    crew: Crew | None = None,
) -> Tuning:
    """Find recommended gains of laws on a limb.

    Args:
        limb: On the bench; the poses that are tried are its own, its start is where stiffness is told.
        laws: Names, with settings other than kp and kd, such as "resolved-rate:weight=inertia"; none: all.
        flaws: The plant.
        robot: Name or file that `limb` was loaded from; None: its robot's name.
        margin: The edge over what is recommended.
        damping_times: kd/kp that are tried [s].
        effort: Of the last trial of the recommended gains.
        crew: Who works, and the file that keeps each edge as it is found.

    Raises:
        TuningError: If the margin is not more than 1, or a law has no edge.
        UnknownNameError: If there is no such law.
        LawError: If a law's settings are not allowed.
    """
    if not margin > 1.0:
        raise TuningError("margin", f"is {margin:g}", "must be more than 1")
    names = list(laws) or list(LAWS)
    for name in names:
        read_law(name).record(limb.chain, flaws.period)
    about: Json = {"robot": robot or limb.robot.name, "limb": limb.name, "flaws": asdict(flaws)}
    about |= {"start": list(limb.start), "q0": limb.q0.tolist(), "margin": margin}
    items: list[Json] = [about | {"law": name, "damping_time": time} for name in names for time in damping_times]
    title = f"the tuning of {limb.robot.name}'s {limb.name} limb"
    crew = crew or Crew()
    ends = crew.map(find_edge, items, about=about, title=title)
    edges = {
        name: _edges(name, [end for item, end in zip(items, ends, strict=True) if item["law"] == name], crew.store)
        for name in names
    }
    best = {name: chosen_edge(found) for name, found in edges.items()}
    last: list[Json] = [
        about | {"law": name, "damping_time": edge.damping_time, "kp": edge.kp, "effort": effort}
        for name, edge in best.items()
    ]
    settled = [_result(name, end) for name, end in zip(best, crew.map(settle_gains, last), strict=True)]
    return Tuning(
        limb=limb,
        flaws=flaws,
        margin=margin,
        laws=tuple(
            Tuned(
                law=name,
                edges=edges[name],
                linear_kp=best[name].linear_kp,
                **told | {"stiffness": tuple(told["stiffness"])},
            )
            for name, told in zip(names, settled, strict=True)
        ),
    )


def chosen_edge(edges: Sequence[Edge]) -> Edge:
    """The edge with the largest kp among those that overshoot little; where none does, the one that overshoots least."""
    calm = [edge for edge in edges if edge.overshoot <= OVERSHOOT]
    return max(calm, key=lambda edge: edge.kp) if calm else min(edges, key=lambda edge: edge.overshoot)


def _result(law: str, end: Outcome) -> Json:
    if end.result is None:
        raise TuningError(law, end.error or "failed", "nothing is recommended")
    return end.result


def _edges(law: str, ends: Sequence[Outcome], store: Path | None) -> tuple[Edge, ...]:
    told = [_result(law, end) for end in ends]
    found = tuple(read_result(Edge, one, store) for one in told if "problem" not in one)
    if not found:
        raise TuningError(law, told[0]["problem"], "nothing is recommended")
    return found
