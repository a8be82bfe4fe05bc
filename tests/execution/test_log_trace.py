from pathlib import Path

import numpy as np

from clamber.control.law_settings import LawSettings
from clamber.execution.log_files import read_log, write_log
from clamber.execution.trace import trace_log
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.measures import Entry
from clamber.limb_bench.runner import run_contest
from clamber.limb_bench.scenario import circle_scenario
from clamber.sim.limb_flaws import LimbFlaws


def test_a_run_comes_back_from_its_log_file_to_the_last_bit(tmp_path: Path) -> None:
    limb = bench_limb(start=(0.27, 0.0))
    scenario = circle_scenario(limb, 200.0, lap=0.5, laps=1)
    trace = run_contest(limb, scenario, [Entry("scct", LawSettings(law="scct"))], LimbFlaws(backlash=0.03))[0].trace
    log = trace_log(trace, notes={"robot": "libra"})
    for name in ("run.csv", "run.mcap"):
        write_log(log, tmp_path / name)
        back = read_log(tmp_path / name)
        assert list(back.columns) == list(log.columns)
        for column, values in log.columns.items():
            np.testing.assert_array_equal(back.column(column), values)
