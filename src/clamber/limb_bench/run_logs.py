"""Runs of the limb bench as logs, for files that `clamber limb identify` and other tools read."""

from collections.abc import Iterable

from ..execution.log import Log
from ..execution.log_trace import trace_log
from ..execution.trace import LimbTrace
from ..sim.limb_flaws import LimbFlaws
from .bench_limb import BenchLimb


def run_logs(limb: BenchLimb, flaws: LimbFlaws, traces: Iterable[tuple[str, LimbTrace]]) -> dict[str, Log]:
    """Label -> log of labelled traces; notes name robot, limb, law and whether weight acted, which identification needs.

    Raises:
        LogError: If not even the first tick of a run is finite.
    """
    notes = {"robot": limb.robot.name, "limb": limb.name} | ({"upright": "yes"} if flaws.upright else {})
    return {label: trace_log(trace, notes=notes | {"law": label}) for label, trace in traces}
