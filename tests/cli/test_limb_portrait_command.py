"""`clamber limb portrait`: tables, pictures, JSON, and mistakes in one line."""

import json
from functools import partial
from pathlib import Path
from typing import Any

import pytest


@pytest.fixture
def run(clamber: Any) -> Any:
    return partial(clamber, "limb", "portrait")


@pytest.mark.slow
def test_tables_fit_80_columns_and_pictures_are_written(run: Any, tmp_path: Path) -> None:
    code, out, _ = run("implicit-admittance", "hybrid", "-o", str(tmp_path / "new"), "-q")
    assert code == 0
    *tables, written = out.splitlines()
    assert max(map(len, tables)) <= 80
    assert written.endswith(str(tmp_path / "new"))
    assert "Kxx" in out and "joint friction" in out
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == ["hybrid.png", "implicit-admittance.png"]


def test_markdown_and_json_tell_the_same_figures(run: Any) -> None:
    _, rows, _ = run("scct", "--markdown", "-q")
    _, text, _ = run("scct", "--json", "-q")
    (law,) = json.loads(text)["laws"]
    cells = [cell.strip() for cell in rows.strip().strip("|").split("|")]
    assert cells[0] == "scct"
    told = [law["figures"][name][plant] for name in ("step", "circle", "fed", "push") for plant in ("ideal", "nominal")]
    assert [float(cell) for cell in cells[1:]] == pytest.approx([1e3 * value for value in told], abs=0.0051)


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (("sctt",), "sctt"),
        (("all", "scct"), "all"),
        (("scct", "--reference", "scct:kp=-1"), "kp"),
        (("scct", "--robot", "gecko4"), "gecko4"),
        (("scct", "-o", __file__), __file__),
    ],
)
def test_mistakes_are_named_in_one_line(run: Any, words: tuple[str, ...], named: str) -> None:
    code, out, err = run(*words, "-q")
    assert code == 2
    assert out == "" and named in err and "Traceback" not in err
