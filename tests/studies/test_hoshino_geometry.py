"""Hoshino 1995, sections 2 and 3: the geometry of the two frames."""

import json
import re
from pathlib import Path

import pytest

from clamber.families.walker.robot import TwoFrames
from clamber.studies.hoshino_1995.printed_numbers import PRINTED, SIXTHS, judge_numbers, slide_seconds
from clamber.studies.hoshino_1995.walker import hoshino
from clamber.studies.library import OF_FRAMES, STUDIES
from clamber.studies.markdown import write_markdown

VERDICTS = {
    "table": "consistent",  # four numbers of ours were fitted to five of theirs
    "fig-4": "holds",
    "fig-5": "holds",
}


def test_the_printed_numbers_come_out_to_their_last_place() -> None:
    result = OF_FRAMES["table"]()
    assert result.verdict == VERDICTS["table"]
    numbers = result.numbers
    assert numbers["walking speed, a step per cycle [mm/min]"] == pytest.approx(130.0, abs=0.5)
    assert numbers["turning speed while sliding [deg/min]"] == pytest.approx(150.0, abs=0.5)
    json.dumps(result.to_json(), allow_nan=False)


def test_regions_grow_by_strokes_alone_and_shrink_within_the_guard() -> None:
    result = OF_FRAMES["fig-4"]()
    assert result.verdict == VERDICTS["fig-4"]
    assert result.numbers["angle of the largest guarded area [deg]"] == 20
    guarded = [float(v) for k, v in result.numbers.items() if k.startswith("area within 0.9")]  # type: ignore[arg-type]
    assert guarded[:5] == sorted(guarded[:5]) and guarded[4:] == sorted(guarded[4:], reverse=True)


@pytest.mark.slow
def test_a_wide_ditch_takes_a_pivot(tmp_path: Path) -> None:
    result = OF_FRAMES["fig-5"]()
    assert result.verdict == VERDICTS["fig-5"]
    assert result.numbers["a ditch of 200 mm ahead, theta = 0, theta_w = 0: pivots"] > 0  # type: ignore[operator]
    write_markdown([result, OF_FRAMES["fig-4"]()], tmp_path)
    pages = tmp_path / "hoshino-1995"
    for name in ("fig-4-regions", "fig-4-areas", "fig-5-maps", "fig-5-curves", "fig-5-crossing"):
        assert (pages / f"{name}.png").read_bytes().startswith(b"\x89PNG")


def test_the_page_on_geometry_shows_these_areas() -> None:
    page = (Path(__file__).resolve().parents[2] / "docs" / "walker-geometry.md").read_text(encoding="utf-8")
    numbers = OF_FRAMES["fig-4"]().numbers
    rows = re.findall(r"^\| (-?\d+) \| ([\d.]+) \| ([\d.]+) \|$", page, re.MULTILINE)
    assert len(rows) == 6
    for theta, strokes, guarded in rows:
        assert float(strokes) == pytest.approx(numbers[f"area by strokes alone, theta = {theta} deg [cm^2]"], abs=0.06)
        of = f"area within 0.9 of the singular distance, theta = {theta} deg [cm^2]"
        assert float(guarded) == pytest.approx(numbers[of], abs=0.06)


def test_every_result_of_the_frames_is_listed() -> None:
    assert set(OF_FRAMES) <= set(STUDIES["hoshino-1995"])


def test_a_slide_takes_as_long_as_its_busiest_actuator() -> None:
    """Turning on the spot changes all three lengths alike: from end to end by the whole stroke."""
    robot = hoshino()
    frames = TwoFrames.of(robot.mechanism)
    whole = slide_seconds(frames, robot.mechanism.speed, (0, 0, -0.31383), (0, 0, 0.83708))
    assert whole == pytest.approx(0.25 / robot.mechanism.speed, rel=1e-4)
    # along an actuator its length changes as much as the way is long
    assert slide_seconds(frames, 0.01, (0, 0, 0), (0, -0.05, 0)) == pytest.approx(5.0, rel=1e-9)


@pytest.mark.parametrize(
    ("ours", "directions"),
    [
        ((-48.6, *PRINTED[1:]), SIXTHS),
        ((*PRINTED[:2], 161.0, *PRINTED[3:]), SIXTHS),
        ((*PRINTED[:4], 149.4), SIXTHS),
        (PRINTED, (*SIXTHS[:5], 329.0)),
        (PRINTED, SIXTHS[:5]),
    ],
)
def test_the_printed_numbers_can_be_missed(ours: tuple[float, ...], directions: tuple[float, ...]) -> None:
    assert judge_numbers(PRINTED, SIXTHS) == "consistent"
    assert judge_numbers(ours, directions) == "differs"
