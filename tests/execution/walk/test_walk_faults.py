"""A walker with a fault: it stops where it stands, goes on or falls, and says which fault it has noticed."""

import pytest

from clamber.execution.fault import FAULTS, Fault, draw_fault
from clamber.families.walker.planning import load_walk
from clamber.families.walker.trials.noise import WalkNoise
from clamber.families.walker.trials.run_walk import WalkRun, run_walk, walk_flaws
from clamber.families.walker.trials.trials import failing_of
from clamber.trials.fault_trials import ENDINGS, ending_of_run
from tiers import first_fast

START = 6.0
"""Of every fault [s]: the robot stands and levels itself."""
LEG = 3
"""Channel of the Delta-frame's first leg."""


def walked(fault: Fault | None) -> WalkRun:
    walk = load_walk("level-walk", ("way.0.distance=3cm",))
    return run_walk(walk, walk_flaws(walk, ()), noise=WalkNoise.of("usual"), seed=2, fault=fault)


def fault_of(kind: str, size: float, channel: int = LEG) -> Fault:
    return Fault(kind=kind, start=START, size=size, channel=channel, where="delta leg 1", seed=2)


@pytest.mark.slow
def test_a_walk_without_a_fault_notices_none() -> None:
    run = walked(None)
    assert run.done, run.reason
    assert run.report.findings == []


@pytest.mark.parametrize(
    ("kind", "size", "found"),
    first_fast(
        [
            ("nan", 9.0, "no number"),
            ("lost", 1.0, "no reading"),
            ("spikes", 0.1, "jump"),
            ("late", 3.0, "late readings"),
            ("late", 8.0, "no reading"),  # none for more than 50 ms
            ("dead", 1.0, "no answer"),
            ("stuck", 1.0, "no answer"),
            ("drift", 0.004, ""),
            ("weak", 0.3, ""),
            ("repeated", 0.2, "no reading"),
            ("jitter", 0.2, "uneven ticks"),
        ],
        2,
    ),
)
def test_every_fault_ends_in_a_report_that_names_it(kind: str, size: float, found: str) -> None:
    run = walked(fault_of(kind, size))
    ending = ending_of_run(run.done, run.report)
    assert ending in ENDINGS and ending != "error"
    kinds = {finding.kind for finding in run.report.findings}
    assert found in kinds or not found or ending == "recovered"
    if run.reason.startswith("fault: "):
        assert run.report.ending == "held"  # on three feet at least, motors that stay where they are
        assert run.report.findings[0].time >= START
    if FAULTS[kind].target == "sensor" and run.report.findings:
        assert run.report.findings[0].where == "delta leg 1"


def test_faults_of_a_walker_are_drawn_of_what_it_has() -> None:
    failing = failing_of(load_walk("level-walk", ()).robot)
    assert "hold" not in failing.kinds and len(failing.kinds) == len(FAULTS) - 1
    assert len(failing.sensors) == len(failing.motors) + 8  # forces and inclines have no motors
    places = {draw_fault(["stuck"], seed, failing, (1.0, 2.0)).where for seed in range(400)}
    assert places == set(failing.sensors)
