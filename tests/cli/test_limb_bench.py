"""`clamber limb step|circle|push`: tables, pictures, JSON, exit codes, and mistakes in one line."""

import csv
import json
from pathlib import Path
from typing import Any

import pytest

from clamber.control.law_settings import LAWS

SHORT = {
    "step": ("--seconds", "1"),
    "circle": ("--lap", "1"),
    "push": ("--from", "0.1", "--to", "0.4", "--seconds", "1"),
}


@pytest.mark.parametrize("kind", SHORT)
@pytest.mark.parametrize("flaws", ["ideal", "nominal"])
def test_the_usual_laws_are_compared_within_80_columns(clamber: Any, kind: str, flaws: str) -> None:
    code, out, _ = clamber("limb", kind, *SHORT[kind], "--flaws", flaws, "--all", "-q")
    assert code == 0
    assert max(map(len, out.splitlines())) <= 80
    for label in ("scct", "jacobian-transpose", "operational-space", "joint-pd", "resolved-rate"):
        assert label in out
    assert "matched by 'yy'" in out
    assert ("by encoders" in out) == (flaws == "nominal")
    assert kind != "circle" or all(law in out for law in LAWS)  # those that are not shown are named


@pytest.mark.parametrize("match", ["yy", "mean", "diagonal", "none"])
def test_the_table_says_what_was_matched(clamber: Any, match: str) -> None:
    _, out, _ = clamber("limb", "step", "-c", "scct", *SHORT["step"], "--match", match)
    assert ("not matched" if match == "none" else f"matched by '{match}'") in out


def test_trials_tell_mean_and_worst_and_how_far_they_are(clamber: Any) -> None:
    words = ("limb", "step", "-c", "scct", *SHORT["step"], "--flaws", "nominal", "--trials", "3")
    code, out, err = clamber(*words)
    assert code == 0 and "3 trials, mean and worst" in " ".join(out.split()) and "  worst" in out
    assert "3 of 3 trials" in err
    assert clamber(*words, "-q")[2] == ""
    told = json.loads(clamber(*words, "-q", "--json")[1])
    assert told["trials"] == 3 and told["plant"]["seed"] == 0  # drawn though no seed was named


def test_the_second_plant_agrees_on_where_a_step_ends(clamber: Any) -> None:
    ends = []
    for plant in ("mujoco", "ode"):
        told = json.loads(clamber("limb", "step", "-c", "scct", *SHORT["step"], "--plant", plant, "--json")[1])
        ends.append(told["laws"][0]["trials"][0]["true"])
    assert ends[0]["across_max"] == pytest.approx(ends[1]["across_max"], abs=2e-5)
    assert ends[0]["rest"] == pytest.approx(ends[1]["rest"], abs=1e-4)


def test_json_is_one_value_with_its_schema(clamber: Any) -> None:
    code, out, _ = clamber("limb", "step", "-c", "scct", "-c", "joint-pd", *SHORT["step"], "--seed", "3", "--json")
    told = json.loads(out)
    assert code == 0
    assert set(told) == {
        *("schema", "scenario", "limb", "plant", "match", "beyond_limits", "seed", "trials", "laws"),
    }
    assert told["schema"] == "clamber-limb-1" and told["plant"]["seed"] == 3
    assert [law["label"] for law in told["laws"]] == ["scct", "joint-pd"]


def test_results_are_written_as_picture_json_and_csv(clamber: Any, tmp_path: Path) -> None:
    for suffix in ("png", "json", "csv"):
        path = tmp_path / f"laws.{suffix}"
        code, out, _ = clamber("limb", "push", "-c", "scct", *SHORT["push"], "-o", str(path))
        assert code == 0 and "written to" in out
    assert (tmp_path / "laws.png").read_bytes().startswith(b"\x89PNG")
    assert json.loads((tmp_path / "laws.json").read_text())["scenario"]["kind"] == "push"
    assert next(csv.DictReader((tmp_path / "laws.csv").read_text().splitlines()))["law"] == "scct"


def test_one_comes_out_where_every_law_is_unstable(clamber: Any) -> None:
    wild = ("-c", "scct:kp=4000,kd=0", "--set", "delay=6", *SHORT["step"])
    code, out, _ = clamber("limb", "step", *wild)
    assert code == 1 and "unstable" in out
    assert clamber("limb", "step", *wild, "-c", "scct")[0] == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("step", "--kd", "-1"), "kd = -1.0: must be 0 or more"),
        (("step", "-c", "scct:kd=-1"), "scct: kd = -1.0: must be 0 or more"),
        (("step", "--set", "damping=-1"), "plant: damping = -1.0: must be 0 or more"),
        (("step", "--start", "311mm,0"), "is singular"),
        (("step", "--start", "40cm,0"), "start (0.4, 0) m is out of reach"),
        (("step", "-c", "sct"), "did you mean 'scct'?"),
        (("step", "--by", "10cm,0"), "step: target = (0.32, 0) m: must be"),
        (("circle", "--centre", "15cm,0", "--radius", "17cm", "--start", "15cm,17cm"), "circle: target = (0.32, 0) m"),
        (("circle", "--start", "22cm,0"), "circle: start = (0.22, 0) m: must lie on the circle"),
        (("push", "--force", "0,0"), "push: force"),
        (("push", "--from", "3", "--to", "2"), "must start at 0 s or later"),
        (("step", "--set", "control_rate=300Hz"), "control_rate = 300 Hz: must divide the physics rate of 2000 Hz"),
        (("step", "--set", "bakclash=2deg"), "did you mean 'backlash'?"),
        (("step", "--set", "backlash=2"), "lacks its unit"),
        (("step", "--plant", "mojuco"), "no plant is called 'mojuco'"),
        (("step", "--limb", "fourth"), "no limb of libra is called 'fourth'"),
        (("step", "--robot", "hoshino"), "hoshino: the limb bench takes robots of the family 'limbed'"),
        (("step", "--plant", "ode", "--flaws", "nominal"), "the ODE plant has none: take the plant 'mujoco'"),
        (("step", "--elbow", "up"), "elbow = up: must be + or -"),
    ],
)
def test_a_mistake_is_named_in_one_line_and_nothing_is_written(
    clamber: Any, tmp_path: Path, words: tuple[str, ...], said: str
) -> None:
    path = tmp_path / "laws.json"
    code, out, err = clamber("limb", *words, "-o", str(path), "-q")
    assert code == 2
    assert out == "" and said in err and err.count("\n") == 1
    assert err.startswith("clamber: ") and "Traceback" not in err
    assert not list(tmp_path.iterdir())


def test_a_file_that_cannot_be_written_is_named_before_anything_runs(clamber: Any, tmp_path: Path) -> None:
    assert clamber("limb", "step", "-o", str(tmp_path / "laws.xyz"))[0] == 2
    assert clamber("limb", "step", "-o", str(tmp_path / "none" / "laws.png"))[0] == 2


def test_controllers_and_plants_are_listed(clamber: Any) -> None:
    code, out, _ = clamber("list", "controllers", "--json")
    assert code == 0
    assert [entry["name"] for entry in json.loads(out)["controllers"]] == list(LAWS)
    assert "mujoco" in clamber("list", "plants")[1]
