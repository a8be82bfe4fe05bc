"""Walks from end to end on legs that stand on springs: where they lead, how level they are, what ends them, what is told."""

import itertools
import math

import numpy as np
import pytest
from spring_walks import BEST, NOISE, RADIUS, stood
from springs_walker import Ground, flat, slope

from clamber.execution.sequencer import Sequencer
from clamber.families.walker.control.track import straight, through
from clamber.families.walker.execution.footstep_plan import TrackCourse
from clamber.families.walker.execution.settings import WalkSettings
from clamber.families.walker.execution.walk_report import WalkReport
from clamber.families.walker.execution.walk_trace import PHASES, WalkTrace
from clamber.families.walker.execution.walking import Walking
from clamber.types import Floats
from tracks import turn_about

TEN = math.radians(10.0)


def ahead(distance: float, direction: float = BEST):  # type: ignore[no-untyped-def]
    return lambda pose: straight(pose, direction, distance, RADIUS)


def walk(ground: Ground, lay, *, calibrated: bool = True, neutral: float = 0.0, **options):  # type: ignore[no-untyped-def]
    walker, plant = stood(ground, **options)
    sequencer = Sequencer(Walking(walker, lambda pose: TrackCourse(lay(pose), neutral=neutral), calibrated=calibrated))
    report = sequencer.run()
    return report, walker.trace(report.to_json()), plant


def worst_tilt(report: WalkReport, trace: WalkTrace) -> float:
    return math.degrees(trace.tilt()[trace.time > report.prepared].max())


@pytest.mark.slow
def test_a_walk_on_the_flat_comes_to_its_place_by_dead_reckoning() -> None:
    report, trace, plant = walk(flat, ahead(0.15))
    assert report.done
    assert report.reason == ""
    assert report.missed is not None
    assert report.missed[0] < 0.003
    assert report.missed[1] < math.radians(0.2)
    assert np.hypot(*(trace.true_pose[-1, :2] - trace.true_pose[0, :2])) == pytest.approx(0.15, abs=0.004)  # type: ignore[index]
    assert worst_tilt(report, trace) < 0.1
    assert plant.dragged < 1e-3
    assert {step.outcome for step in report.steps} == {"ok"}
    frames = [step.frame for step in report.steps]
    assert all(a != b for a, b in itertools.pairwise(frames))
    assert set(np.unique(trace.phase)) == set(range(len(PHASES)))


@pytest.mark.slow
@pytest.mark.parametrize("uphill", [BEST, BEST + math.pi, BEST + math.pi / 2], ids=["up", "down", "across"])
def test_the_plate_stays_level_on_ten_degrees(uphill: float) -> None:
    report, trace, _ = walk(slope(TEN, uphill), ahead(0.2), tilt=TEN, uphill=uphill)
    assert report.done
    assert worst_tilt(report, trace) < 0.1
    walked = trace.time > report.prepared
    assert trace.true_margin is not None
    assert trace.true_margin[walked].min() > 0.04


@pytest.mark.slow
def test_without_levelling_the_centre_of_mass_is_seventy_millimetres_nearer_to_the_edge() -> None:
    level, trace, _ = walk(slope(TEN, BEST + math.pi), ahead(0.1), tilt=TEN, uphill=BEST + math.pi)
    settings = WalkSettings(level=False, limits=WalkSettings().limits)
    report, tilted, _ = walk(slope(TEN, BEST + math.pi), ahead(0.1), tilt=TEN, uphill=BEST + math.pi, settings=settings)
    assert level.done
    lifted = tilted.time > report.prepared
    assert report.reason.startswith(("fell", "step")) or tilted.true_margin[lifted].min() < 0.02  # type: ignore[index]
    assert trace.true_margin[trace.time > level.prepared].min() > 0.05  # type: ignore[index]


@pytest.mark.slow
def test_a_turn_on_the_spot_comes_to_its_heading() -> None:
    report, trace, _ = walk(flat, lambda pose: turn_about(pose, pose[:2], math.radians(60.0), RADIUS))
    assert report.done
    assert report.missed is not None
    assert report.missed[0] < 0.004
    assert report.missed[1] < math.radians(0.3)
    assert math.degrees(trace.true_pose[-1, 3]) == pytest.approx(60.0, abs=0.4)  # type: ignore[index]


@pytest.mark.slow
def test_a_path_round_a_corner_is_followed_with_the_heading_kept() -> None:
    corners = np.array(((0.0, 0.15, 0.0), (0.15, 0.15, 0.0)))
    report, trace, _ = walk(flat, lambda pose: through(pose, pose + corners, RADIUS))
    assert report.done
    place = trace.true_pose[-1] - trace.true_pose[0]  # type: ignore[index]
    np.testing.assert_allclose(place[:2], (0.15, 0.15), atol=0.005)
    assert abs(place[3]) < math.radians(0.2)


@pytest.mark.slow
def test_offsets_of_the_inclinometers_are_found_before_the_walk_on_a_slope() -> None:
    offsets = np.radians((0.2, -0.15))
    report, trace, _ = walk(
        slope(TEN, 1.0), ahead(0.1), tilt=TEN, uphill=1.0, calibrated=False, offsets=tuple(offsets), seed=4
    )
    assert report.done
    np.testing.assert_allclose(report.offsets, offsets, atol=math.radians(0.04))
    assert worst_tilt(report, trace) < 0.1


@pytest.mark.slow
def test_ground_that_is_missing_shortens_the_step_and_then_ends_the_walk() -> None:
    def ditch(x: float, y: float) -> float:
        return -0.6 if y > 0.33 else 0.0

    report, _, plant = walk(ditch, ahead(0.6))
    assert not report.done
    assert "ground" in report.reason or "stuck" in report.reason
    assert any(step.outcome == "moved" and step.tries > 1 for step in report.steps)
    assert not plant.fallen
    feet = plant.truth().feet.reshape(6, 3)
    assert feet[:, 1].max() < 0.33 + 1e-6


@pytest.mark.slow
def test_the_log_of_a_walk_is_the_walk() -> None:
    report, trace, _ = walk(flat, ahead(0.05))
    back = WalkTrace.from_log(trace.to_log())
    for name in ("time", "step", "phase", "believed", "forces", "stands", "true_pose", "true_margin", "true_feet"):
        np.testing.assert_array_equal(getattr(back, name), getattr(trace, name))
    assert back.notes is not None
    assert back.notes["done"] is True
    assert len(back.notes["steps"]) == len(report.steps)
    assert back.notes["steps"][0]["times"]["slide"] > 0.0


def test_the_log_of_a_fall_keeps_that_too_few_feet_stand() -> None:
    _, trace, _ = walk(flat, ahead(0.02))
    assert trace.true_margin is not None
    trace.margin[-1] = trace.true_margin[-3:] = -np.inf
    back = WalkTrace.from_log(trace.to_log())
    np.testing.assert_array_equal(back.margin, trace.margin)
    np.testing.assert_array_equal(back.true_margin, trace.true_margin)


@pytest.mark.slow
def test_the_same_seed_walks_the_same_walk() -> None:
    rows: list[Floats] = []
    for _ in range(2):
        _, trace, _ = walk(flat, ahead(0.05), seed=7, noise=NOISE)
        rows.append(trace.believed)
    np.testing.assert_array_equal(rows[0], rows[1])
