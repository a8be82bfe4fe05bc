"""`clamber limb ... --log` and back through `identify`; laws that feel; trials over workers."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from clamber.execution.log_files import read_log

RUNS = {
    "step": ("--seconds", "0.5", "-c", "scct", "-c", "joint-pd"),
    "circle": ("--lap", "1", "-c", "scct", "-c", "joint-pd"),
    "push": ("--from", "0.1", "--to", "0.3", "--seconds", "0.5", "-c", "scct", "-c", "joint-pd"),
    "open-loop": ("--seconds", "0.3", "-c", "scct", "-c", "jacobian-transpose"),
    "force": ("--slide", "0cm", "-c", "hybrid", "--friction-compensation", "none", "--friction-compensation", "model"),
}


@pytest.mark.parametrize("kind", RUNS)
def test_a_log_is_one_mcap_with_a_channel_a_law_or_a_csv_a_law_with_the_same_numbers(
    clamber: Any, kind: str, tmp_path: Path
) -> None:
    for suffix in ("mcap", "csv"):
        code, out, _ = clamber("limb", kind, *RUNS[kind], "-q", "--log", str(tmp_path / f"run.{suffix}"))
        assert code in (0, 1) and "written to" in out
    files = sorted(tmp_path.glob("run-*.csv"))
    assert len(files) == 2 and not (tmp_path / "run.csv").exists()
    for file in files:
        log = read_log(file)
        back = read_log(tmp_path / "run.mcap", log.notes["law"])
        assert back.notes == log.notes and log.notes["robot"] == "libra"
        assert back.columns.keys() == log.columns.keys()
        for name in log.columns:
            np.testing.assert_array_equal(back.columns[name], log.columns[name])


@pytest.mark.parametrize("suffix", ["mcap", "csv"])
def test_identify_finds_the_friction_of_a_circle_in_its_log(clamber: Any, suffix: str, tmp_path: Path) -> None:
    log = tmp_path / f"circle.{suffix}"
    assert clamber("limb", "circle", "-c", "scct:kp=400,kd=20", "-q", "--log", str(log))[0] == 0
    code, out, _ = clamber("limb", "identify", str(log), "--json")
    told = json.loads(out)
    assert code == 0 and told["robot"] == "libra" and told["limb"] == "right"
    from clamber.limb_bench.bench_limb import bench_limb

    joints = bench_limb().chain.joints
    for joint, record in zip(told["joints"], joints, strict=True):
        found = {each["name"]: each["value"] for each in joint["estimates"]}
        assert found["friction"] == pytest.approx(float(record["friction"]), rel=0.05)


def test_a_log_and_an_output_that_cannot_be_are_refused_before_anything_runs(clamber: Any, tmp_path: Path) -> None:
    for words in (
        ("--log", str(tmp_path / "a.txt")),
        ("--log", str(tmp_path / "nowhere" / "a.csv")),
        ("--log", str(tmp_path)),
        ("--log", str(tmp_path / "a.csv"), "--output", str(tmp_path / "a.csv")),
    ):
        code, out, err = clamber("limb", "step", *words)
        assert code == 2 and out == "" and err and "Traceback" not in err
    assert not list(tmp_path.iterdir())


def test_an_admittance_yields_to_a_push_as_its_spring_says_and_the_table_names_its_sensor(clamber: Any) -> None:
    law = "admittance:kp=400,kd=20,admittance_kp=1000,admittance_kd=100"
    words = ("limb", "push", "--force", "10N,0", "--from", "0.2", "--to", "2", "--seconds", "4", "-c", law)
    _, out, _ = clamber(*words, "--json", "-q")
    told = json.loads(out)
    assert told["plant"]["wrist"]["noise"] == 0.0 and told["plant"]["base"] is None
    # 10 N on 1000 N/m; what the servo leaves of friction is of the order of 0.2 mm
    assert told["laws"][0]["mean"]["true"]["along_max"] == pytest.approx(0.010, abs=0.0006)
    assert "ideal force sensor at the wrist" in " ".join(clamber(*words, "-q")[1].split())
    assert "force sensor" not in clamber("limb", "push", "-c", "scct", "-q")[1]


@pytest.mark.slow
def test_trials_over_workers_give_the_same_bytes(clamber: Any) -> None:
    words = ("limb", "step", "-c", "scct", "--seconds", "1", "--flaws", "nominal", "--trials", "4", "--json", "-q")
    told = []
    for workers in ("1", "2", "3"):
        code, out, _ = clamber(*words, "--workers", workers)
        assert code == 0
        told.append([line for line in out.splitlines() if '"tick"' not in line])
    assert told[0] == told[1] == told[2]
    measured = [trial["true"]["across_max"] for trial in json.loads(out)["laws"][0]["trials"]]
    assert len(set(measured)) > 1
