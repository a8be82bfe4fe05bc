"""`clamber ditch`."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

Clamber = Callable[..., tuple[int, str, str]]


@pytest.mark.slow
def test_ditch_tells_the_widest_by_angle(clamber: Clamber, tmp_path: Path) -> None:
    code, out, _ = clamber("ditch", "--straight", "--json", "-o", str(tmp_path / "map.png"))
    assert code == 0
    rows = {row["theta_deg"]: row for row in json.loads(out)}
    assert min(rows) == -17 and max(rows) == 47
    assert rows[0]["widest_m"] == pytest.approx(0.16006, abs=1e-5)
    assert rows[0]["direction_deg"] % 60 == 30
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")


def test_ditch_crosses_after_a_pivot(clamber: Clamber, tmp_path: Path) -> None:
    words = ("ditch", "--width", "180 mm", "--reserve", "5 mm", "--margin", "20 mm")
    code, out, _ = clamber(*words, "--json", "-o", str(tmp_path / "crossing.png"))
    assert code == 0
    told = json.loads(out)
    assert told["status"] == "found" and told["pivots"] > 0
    assert all(min(v for v in slide["margins"].values()) >= -1e-9 for slide in told["slides"])
    assert (tmp_path / "crossing.png").read_bytes().startswith(b"\x89PNG")
    code, out, _ = clamber(*words)
    assert code == 0 and "pivots" in out


def test_ditch_says_why_there_is_no_way(clamber: Clamber) -> None:
    code, out, _ = clamber("ditch", "--width", "300 mm")
    assert code == 1
    assert "impossible: the widest ditch that it crosses" in " ".join(out.split())


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("libra",), "robot 'libra': family = 'libra': must be a two-frame walker"),
        (("--width", "-1 mm"), "width = -0.001: must be finite and 0 or more"),
        (("--width", "1 kg"), "is no unit of length"),
    ],
)
def test_ditch_names_what_is_wrong(clamber: Clamber, words: tuple[str, ...], told: str) -> None:
    code, _, err = clamber("ditch", *words)
    assert code == 2
    assert told in " ".join(err.split())
