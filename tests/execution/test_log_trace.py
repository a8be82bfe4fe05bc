from pathlib import Path

import numpy as np
import pytest

from clamber.control.law_settings import LawSettings
from clamber.execution.log import LogError
from clamber.execution.log_files import read_log, write_log
from clamber.execution.trace import log_trace, trace_log
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.measures import Entry
from clamber.limb_bench.runner import run_contest
from clamber.limb_bench.scenario import circle_scenario
from clamber.sim.limb_flaws import LimbFlaws


def test_a_run_comes_back_from_its_log_file_to_the_last_bit(tmp_path: Path) -> None:
    limb = bench_limb(start=(0.27, 0.0))
    scenario = circle_scenario(limb, 200.0, lap=0.5, laps=1)
    trace = run_contest(limb, scenario, [Entry("scct", LawSettings(law="scct"))], LimbFlaws(backlash=0.03))[0].trace
    for name in ("run.csv", "run.mcap"):
        write_log(trace_log(trace, notes={"robot": "libra"}), tmp_path / name)
        back = log_trace(read_log(tmp_path / name), trace.chain)
        for key in ("time", "sensed", "true", "commanded", "applied", "wrenches"):
            np.testing.assert_array_equal(getattr(back, key), getattr(trace, key))
        for key in ("aims", "reports"):
            ours, theirs = getattr(back, key), getattr(trace, key)
            for field in ours.dtype.names:
                np.testing.assert_array_equal(ours[field], theirs[field])


def test_a_log_of_another_limb_is_no_trace_of_this_one() -> None:
    limb = bench_limb(start=(0.27, 0.0))
    scenario = circle_scenario(limb, 200.0, lap=0.1, laps=1)
    trace = run_contest(limb, scenario, [Entry("scct", LawSettings(law="scct"))], LimbFlaws())[0].trace
    with pytest.raises(LogError, match="column 'left shoulder angle': no such column"):
        log_trace(trace_log(trace), bench_limb(limb="left").chain)
