"""Trials with a fault each: what a trial keeps of it, and what many say by kind."""

from collections.abc import Iterable
from dataclasses import dataclass
from statistics import median
from typing import Annotated, Final, Literal, Protocol, TypeAlias, get_args

from ..execution.fault import Fault
from ..execution.run_report import Finding, RunReport
from ..json_form import INLINE, Count, Jsonable, in_json
from ..types import Json
from .trial_runs import wilson_interval

Ending: TypeAlias = Literal["recovered", "held", "stopped safely", "fell", "error"]
ENDINGS: Final[tuple[Ending, ...]] = get_args(Ending)
"""How a trial with a fault may end: it came to its goal in spite of it; it noticed the fault and held its posture, or came to rest
elsewhere, as one does that ends for another reason while it stands; it fell; it raised, or its workers died."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TriedFault(Jsonable):
    """The fault that a trial's robot had, and how that ended."""

    fault: Annotated[Fault, INLINE]
    noticed: float | None
    """When the robot noticed it first [s]; None if it never did."""
    noticed_as: str
    """As what, such as "no answer"."""
    at: str
    """Where, as the robot has it."""
    early: list[Finding]
    """Faults that the robot noticed before there was one: false alarms."""
    ending: Ending


def ending_of_run(done: bool, report: RunReport) -> Ending:
    """One of `ENDINGS` for a run that has a report."""
    if done:
        return "recovered"
    if report.ending:
        return report.ending
    return "fell" if "fell" in report.reason.partition("(")[0] else "stopped safely"


def told_fault(fault: Fault | None, done: bool, report: RunReport) -> Json | None:
    """What a trial keeps of its fault as plain data; None without one."""
    if fault is None:
        return None
    noticed = [finding for finding in report.findings if finding.time >= fault.start]
    return TriedFault(
        fault=fault,
        noticed=noticed[0].time if noticed else None,
        noticed_as=noticed[0].kind if noticed else "",
        at=noticed[0].where if noticed else "",
        early=[finding for finding in report.findings if finding.time < fault.start],
        ending=ending_of_run(done, report),
    ).to_json()


class Tried(Protocol):
    """A trial of a climb or walk."""

    @property
    def fault(self) -> Json | None:
        """See `told_fault`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FaultRow(Jsonable):
    """Trials with one kind of fault."""

    kind: str
    """Of the fault; "error" for trials that raised before one was told."""
    n: Count
    noticed: Count
    """In which the robot noticed a fault after it had begun."""
    located: Count
    """In which it named the sensor, motor or hold that had failed."""
    delay: float | None
    """Median time from the beginning of the fault until it was noticed [s]; None if it never was."""
    early: Count
    """In which it noticed a fault before there was one."""
    endings: dict[str, Count]
    """How many came to each ending."""

    @in_json()
    def intervals(self) -> dict[str, tuple[float, float]]:
        """95 % interval of each ending's share."""
        return {name: wilson_interval(k, self.n) for name, k in self.endings.items()}


def fault_rows(trials: Iterable[Tried]) -> tuple[FaultRow, ...]:
    """A row for each kind of fault, in the order of their names, and one for all."""
    raised: Json = {"kind": "error", "ending": "error", "noticed": None}
    told = [raised if one.fault is None else one.fault for one in trials]
    kinds = sorted({one["kind"] for one in told})
    rows = [_row(kind, [one for one in told if one["kind"] == kind]) for kind in kinds]
    return (*rows, _row("all", told)) if told else ()


def _row(kind: str, told: list[Json]) -> FaultRow:
    delays = [one["noticed"] - one["start"] for one in told if one["noticed"] is not None]
    return FaultRow(
        kind=kind,
        n=len(told),
        noticed=len(delays),
        located=sum(bool(one.get("at")) and one["at"] == one["where"] for one in told),
        delay=median(delays) if delays else None,
        early=sum(bool(one.get("early")) for one in told),
        endings={name: sum(one["ending"] == name for one in told) for name in ENDINGS},
    )
