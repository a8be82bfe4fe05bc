"""`clamber limb tune|sweep` from the command line: tables within 80 columns, JSON, files, and mistakes in one line."""

import json
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from clamber.limb_bench import tune


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("sweep", "--vary", "nothing=0..1:2"), "nothing"),
        (("sweep", "--vary", "kp=1..2:2", "--scenario", "circle", "--measure", "across_max"), "across_max"),
        (("sweep", "--vary", "backlash=1deg..0deg:3"), "the range is empty"),
        (("sweep", "--vary", "kp=1..2:2", "-c", "nosuch"), "nosuch"),
        (("sweep", "--vary", "kp=1..2:2", "-o", "map.doc"), "map.doc"),
        (("sweep", "--vary", "payload=-1kg..1kg:3"), "payload"),
        (("tune", "nosuch"), "nosuch"),
        (("tune", "scct", "--margin", "0.5"), "margin"),
        (("tune", "scct", "--limb", "fourth"), "fourth"),
        (("tune", "scct", "--set", "control_rate=300Hz"), "control_rate"),
        (("tune", "scct", "--save", "nowhere/gains.toml"), "nowhere"),
    ],
)
def test_a_mistake_is_named_in_one_line(clamber: Any, words: tuple[str, ...], told: str) -> None:
    code, out, err = clamber("limb", *words)
    assert code == 2
    assert out == ""
    assert told in err
    assert "Traceback" not in err


@pytest.mark.slow
def test_a_sweep_is_told_as_table_json_picture_and_csv(clamber: Any, tmp_path: Path) -> None:
    words = (
        "limb",
        "sweep",
        "--scenario",
        "step",
        "--vary",
        "kp=1000..5000:3",
        "--kd",
        "4",
        "--kp",
        "100",
        "-c",
        "scct",
    )
    picture, table = tmp_path / "sweep.png", tmp_path / "sweep.csv"
    code, out, _ = clamber(*words, "-o", str(picture), "-q", "--workers", "1")
    assert code == 0
    assert max(map(len, out.splitlines()[:-1])) <= 80
    assert "scct: stable below kp = " in out
    assert picture.read_bytes().startswith(b"\x89PNG")
    code, out, _ = clamber(*words, "-o", str(table), "--json", "-q", "--workers", "1")
    assert json.loads(out)["points"][0]["winner"] == "scct"
    assert len(table.read_text().splitlines()) == 4


@pytest.mark.long
def test_a_tuning_is_saved_and_drawn(clamber: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of two damping times in place of ten: five minutes less."""
    monkeypatch.setattr(tune, "tune", partial(tune.tune, damping_times=(0.028, 0.04), effort="search"))
    gains, picture = tmp_path / "gains.toml", tmp_path / "tune.png"
    code, out, _ = clamber("limb", "tune", "scct", "--save", str(gains), "-o", str(picture), "-q")
    assert code == 0
    assert max(len(line) for line in out.splitlines() if not line.startswith("written")) <= 80
    assert 'law = "scct"' in gains.read_text()
    assert picture.read_bytes().startswith(b"\x89PNG")
