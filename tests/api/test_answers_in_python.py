"""Errors in Python are Clamber's own, answers are short to look at, and single holds of generated boards can be moved."""

import math
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

import clamber
from clamber.execution.log_files import read_log
from clamber.execution.log_roles import samples_of

NO_NAME = "name_or_path: 3 is no name or path; give the text, or a `Path`, of one"


@pytest.mark.parametrize(
    ("call", "named"),
    [
        (lambda: clamber.plan("ladder", seconds="a"), "seconds: 'a' is not what it takes"),
        (lambda: clamber.plan("ladder", seconds=-1.0), "seconds: -1.0 is below 0"),
        (lambda: clamber.plan("ladder", seconds=math.nan), "seconds: nan is below 0, or no number"),
        (lambda: clamber.plan("ladder", "beam", width="wide"), "width: 'wide' is not what it takes"),
        (lambda: clamber.plan(3), "task: 3 is no task"),  # type: ignore[arg-type]
        (lambda: clamber.check(3), "what: 3 is no plan"),  # type: ignore[arg-type]
        (lambda: clamber.explain_infeasibility(None), "task: None is no task"),  # type: ignore[arg-type]
        (lambda: clamber.load_task(3), NO_NAME),  # type: ignore[arg-type]
        (lambda: clamber.load_robot(3), NO_NAME),  # type: ignore[arg-type]
        (lambda: clamber.load_world(3), NO_NAME),  # type: ignore[arg-type]
        (lambda: clamber.load_board(3), NO_NAME),  # type: ignore[arg-type]
        (lambda: clamber.load_plan(3), NO_NAME),  # type: ignore[arg-type]
        (lambda: clamber.load_walk(None), NO_NAME.replace("3", "None")),  # type: ignore[arg-type]
        (lambda: clamber.draw("ladder", 3), NO_NAME.replace("name_or_path", "path")),  # type: ignore[arg-type]
        (lambda: clamber.compare(3), "laws: 3 is no text, nor several; write it as"),  # type: ignore[arg-type]
        (lambda: clamber.compare("scct", "circle", radius="x"), "radius: 'x' is not what it takes; it takes float"),
        (lambda: clamber.compare("scct", "circle", dx=0.1), "dx: is no option here; there are centre, radius, lap"),
        (lambda: clamber.compare("scct", "spin"), "motion: 'spin' is not what it takes; it takes Literal['step', "),  # type: ignore[arg-type]
        (
            lambda: clamber.change_task("ladder", ["start.y=6in"]),
            "task: 'ladder' is no task; give one of `clamber.load",
        ),  # type: ignore[arg-type]
        (lambda: clamber.pose_problem(3), "task: 3 is no task; give one of `clamber.load_task`"),  # type: ignore[arg-type]
    ],
)
def test_a_wrong_argument_is_named(call: Any, named: str) -> None:
    with pytest.raises(clamber.ClamberError) as raised:
        call()
    assert named in str(raised.value)


@pytest.mark.slow
def test_answers_are_short_and_have_a_picture() -> None:
    result = clamber.plan("ladder", "greedy")
    verdict = clamber.check(result)
    for answer in (result, result.plan, verdict):
        assert len(repr(answer)) < 120 and "ladder" in repr(answer)
    page = result._repr_html_()
    assert page.startswith("<img") and "data:image/png;base64," in page and len(page) > 10_000


@pytest.mark.parametrize("name", ["libra", "gecko-wall", "ladder", "ladder-hand"])
def test_names_are_drawn(tmp_path: Path, name: str) -> None:
    with Image.open(clamber.draw(name, tmp_path / "picture.png")) as picture:
        assert min(picture.size) > 200


def test_a_hold_of_a_generated_board_is_moved() -> None:
    before, after = clamber.load_task("ladder"), clamber.load_task("ladder", ["board.holds.7.x=1in"])
    moved = [hold.number for hold, was in zip(after.world.holds, before.world.holds, strict=True) if hold.x != was.x]
    assert moved == [7]
    assert after.world.by_number(7).x == pytest.approx(0.0254)
    assert [hold.number for hold in after.world.holds] == [hold.number for hold in before.world.holds]
    with pytest.raises(clamber.ClamberError, match="has no '700'"):
        clamber.load_task("ladder", ["board.holds.700.x=1in"])


def test_an_angle_that_nothing_drives_is_no_joint(tmp_path: Path) -> None:
    rows = [float(k) for k in range(40)]
    columns = {"time [s]": rows, "right elbow angle": rows, "right elbow torque": rows, "body believed angle": rows}
    lines = [",".join(columns), *(",".join(map(str, row)) for row in zip(*columns.values(), strict=True))]
    (tmp_path / "log.csv").write_text("\n".join(lines) + "\n")
    found = samples_of(read_log(tmp_path / "log.csv"))
    assert [joint.name for joint in found.joints] == ["right elbow"]
    assert any("body believed" in note for note in found.notes)
