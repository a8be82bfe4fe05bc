"""Walks in contact dynamics: level, on a slope, without levelling, and what noise makes of the plant."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from clamber.execution.plant import PlantStoppedError
from clamber.families.walker.planning import load_walk
from clamber.families.walker.sim.walker_flaws import WalkerFlaws
from clamber.families.walker.sim.walker_plant import WalkerSim
from clamber.families.walker.trials.noise import WALK_NOISE, WalkNoise
from clamber.families.walker.trials.run_walk import WalkRun, run_walk, walk_flaws
from clamber.sim.plant_rules import PlantError
from clamber.trials.noise import NoiseError
from clamber.trials.work import split_settings
from tiers import first_fast

SHORT = "way.0.distance=15cm"


def walked(name: str, *changes: str, **options: object) -> WalkRun:
    walk = load_walk(name, (SHORT, *changes))
    return run_walk(walk, walk_flaws(walk, ()), **options)


@pytest.mark.slow
def test_a_short_walk_over_level_ground_ends_where_it_should() -> None:
    run = walked("level-walk")
    assert run.done, run.reason
    assert run.report.missed is not None
    assert run.report.missed[0] < 2e-3
    gone = run.true.pose[-1, :2] - run.true.pose[run.walking][0, :2]
    np.testing.assert_allclose(gone, 0.15 * np.array((math.cos(math.pi / 6), 0.5)), atol=2e-3)
    assert run.margin > 0.05
    assert run.to_json()["walk"] == "level-walk"


@pytest.mark.slow
def test_a_body_twist_is_walked_as_the_arc_that_it_makes() -> None:
    """At 2 mm/s ahead and 0.3 deg/s for a minute: an arc of 0.382 m radius through 18 deg."""
    walk = load_walk("level-walk", ("way=[{ twist = { vx = '2 mm/s', omega = '0.3 deg/s' }, lasts = '1 min' }]",))
    run = run_walk(walk, walk_flaws(walk, ()))
    assert run.done, run.reason
    radius, turn = 0.002 / math.radians(0.3), math.radians(18.0)
    arc = (radius * math.sin(turn), radius * (1.0 - math.cos(turn)))
    np.testing.assert_allclose(run.true.pose[-1, :2], arc, atol=2e-3)
    assert run.true.pose[-1, 3] == pytest.approx(turn, abs=math.radians(0.1))


@pytest.mark.slow
def test_a_path_of_many_places_is_walked_in_long_steps(tmp_path: Path) -> None:
    angles = np.linspace(0.0, math.pi / 4, 50)
    rows = [f"{0.3 * math.sin(a)},{0.3 * (1.0 - math.cos(a))},{a}\n" for a in angles]
    file = tmp_path / "bend.csv"
    file.write_text("x [m], y [m], heading [rad]\n" + "".join(rows), encoding="utf-8")
    walk = load_walk("level-walk", (f"way=[{{ path = '{file}' }}]",))
    run = run_walk(walk, walk_flaws(walk, ()))
    assert run.done, run.reason
    assert len(run.report.steps) <= 6
    placed = run.true.pose[run.walking]
    off = np.hypot(placed[:, 0], placed[:, 1] - 0.3) - 0.3  # from the circle; a frame slides along a chord
    assert np.abs(off).max() < 0.02
    np.testing.assert_allclose(
        placed[-1, :2], (0.3 * math.sin(math.pi / 4), 0.3 * (1.0 - math.cos(math.pi / 4))), atol=2e-3
    )


@pytest.mark.slow
@pytest.mark.parametrize("uphill", first_fast([90.0, 0.0, 180.0]))
def test_the_plate_stays_level_on_a_slope(uphill: float) -> None:
    run = walked("slope-walk", f"ground.uphill={uphill}deg")
    assert run.done, run.reason
    climbed = 0.15 * math.tan(math.radians(10.0)) * math.cos(math.radians(uphill))
    # the height over the feet may differ by where the legs have room
    assert run.true.feet[-1, ..., 2].mean() - run.true.feet[0, ..., 2].mean() == pytest.approx(climbed, abs=4e-3)
    assert run.tilt < math.radians(0.2)
    assert run.margin > 0.05


def test_without_levelling_a_slope_downhill_topples_it() -> None:
    """The centre of mass lies 70 mm downhill of where it is on level ground, and the margin there is 66 mm."""
    changes = ("level=false", "start.plate=ground", "ground.uphill=180deg", "way.0.distance=1m")
    run = walked("slope-walk", *changes)
    assert not run.done
    assert run.reason.startswith("fell")
    assert run.margin < 0.0
    lost = run.true.time[np.flatnonzero(run.true.margins > 0.0)[-1]]
    assert 0.0 < run.report.seconds - lost < 0.2
    assert abs(run.true.tilts[-1] - run.true.tilts[run.walking][0]) < math.radians(0.1)


@pytest.mark.slow
@pytest.mark.parametrize("uphill", first_fast([90.0, 0.0, 180.0]))
def test_a_start_tilted_by_ten_degrees_returns_to_level(uphill: float) -> None:
    noise = WalkNoise.of("usual", ["inclinometer_offset=0deg"])
    run = walked(
        "slope-walk", "start.plate=ground", f"ground.uphill={uphill}deg", "way.0.distance=2cm", noise=noise, seed=3
    )
    assert run.done, run.reason
    assert run.true.tilts[0] == pytest.approx(math.radians(10.0), abs=math.radians(0.4))
    assert run.tilt < math.radians(0.1)


def test_noise_is_drawn_key_by_key() -> None:
    base = WalkerFlaws()
    usual = WalkNoise.of("usual")
    one, again, other = usual.flaws(base, 1), usual.flaws(base, 1), usual.flaws(base, 2)
    assert one == again
    assert one.friction != other.friction
    width = WALK_NOISE["inclinometer_offset"].width
    assert max(map(abs, one.inclinometers.offsets)) <= width
    assert one.inclinometers.noise == WALK_NOISE["inclinometer_noise"].width
    calm = usual.changed(["friction=0%"]).flaws(base, 1)
    assert calm.friction == 1.0
    assert calm.inclinometers == one.inclinometers


@pytest.mark.parametrize("text", ["frictoin=1%", "friction=", "friction=-1%", "mass=100%", "force_noise=1deg"])
def test_noise_that_cannot_be_is_named(text: str) -> None:
    with pytest.raises(NoiseError, match="noise: "):
        WalkNoise.of("none", [text])


def test_settings_of_the_plant_are_split_and_read() -> None:
    walk = load_walk("slope-walk", ["payload=2kg"])
    for_walk, for_plant = split_settings(["plant.friction=50%", "level=false", "plant.payload=1kg"])
    assert for_walk == ["level=false"]
    flaws = walk_flaws(walk, for_plant)
    assert flaws.friction == 0.5
    assert flaws.payload == 3.0  # what it knows of and what it does not
    with pytest.raises(PlantError, match="physics_rate"):
        walk_flaws(walk, ["phisics_rate=1kHz"])
    with pytest.raises(PlantError, match="mass"):
        walk_flaws(walk, ["payload=1m"])


def test_a_robot_that_cannot_stand_falls_at_the_start() -> None:
    walk = load_walk("level-walk", ["arm=['0 deg', '0 deg', '0 deg', '0 deg']"])
    run = run_walk(walk, walk_flaws(walk, ["payload=40kg"]))
    assert not run.done
    assert run.reason.startswith("fell")
    assert not run.report.steps
    assert run.to_json()["steps"] == []


@pytest.mark.parametrize("lost", [False, True])
def test_a_plant_that_stops_at_the_start_has_not_fallen(lost: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    def stop(plant: WalkerSim) -> None:
        if lost:
            plant._qpos[0] = math.nan
        raise PlantStoppedError("the line is cut")

    monkeypatch.setattr(WalkerSim, "step", stop)
    walk = load_walk("level-walk")
    run = run_walk(walk, walk_flaws(walk, ()))
    assert run.reason.startswith("stopped: the line is cut")
    assert not run.report.steps
    assert (run.report.true_pose is None) == lost
    json.dumps(run.to_json(), allow_nan=False)


@pytest.mark.slow
def test_a_step_that_no_foot_gets_over_stops_the_robot_with_the_reason() -> None:
    """A step higher than feet can be drawn up: they stay before it, and it says that it cannot go on."""
    changes = ("start.x=35cm", "way.0.distance=30cm", "ground.blocks.0.height=12cm", "ground.blocks.1.height=12cm")
    walk = load_walk("step-walk", changes)
    run = run_walk(walk, walk_flaws(walk, ()))
    assert not run.done and "higher than it can be lifted" in run.reason
    assert run.true.pose[-1, 0] < 0.6
