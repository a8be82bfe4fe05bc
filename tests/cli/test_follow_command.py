"""`clamber follow` on the command line."""

import json
from collections.abc import Callable
from pathlib import Path

from clamber.execution.log_files import read_log

Call = Callable[..., tuple[int, str, str]]


def test_a_shipped_path_is_followed_drawn_and_logged(clamber: Call, tmp_path: Path) -> None:
    picture, table, log = (tmp_path / f"run.{suffix}" for suffix in ("png", "csv", "mcap"))
    words = ("follow", "circle", "--dof", "4", "-o", str(picture), "-o", str(table), "-o", str(log), "--json")
    code, out, _ = clamber(*words)
    assert code == 0
    told = json.loads(out)
    assert told["reached"]
    assert told["supports"] == "delta"
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert read_log(table).rows == read_log(log).rows
    assert read_log(log).notes["dof"] == "4"


def test_a_path_out_of_reach_says_how_near_it_can_come(clamber: Call) -> None:
    code, out, _ = clamber("follow", "wide", "--dof", "4")
    assert code == 1
    assert "out of reach: the closest reachable point is" in " ".join(out.split())


def test_mistakes_are_told_without_a_traceback(clamber: Call, tmp_path: Path) -> None:
    file = tmp_path / "path.csv"
    file.write_text("x [m],y [m],z [kg]\n0,0,0\n1,0,0\n")
    for words, told in (
        ((str(file),), "column 'z' = [kg]: is no unit of length"),
        (("circle", "--dof", "6"), "no set has 6 degrees of freedom"),
        (("circle", "--robot", "libra"), "must be a two-frame walker with an arm"),
        (("circle", "-o", str(tmp_path / "run.txt")), "no picture or log has the suffix '.txt'"),
        (("circle", "--speed", "3kg"), "kg"),
        (("circl",), "did you mean 'circle'"),
    ):
        code, _, err = clamber("follow", *words)
        assert code == 2
        assert told in err
        assert "Traceback" not in err
