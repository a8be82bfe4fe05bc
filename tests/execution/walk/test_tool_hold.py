"""A tool that is held at a point while the robot walks past it, on legs that stand on springs."""

import math
from typing import Any, Literal

import numpy as np
import pytest
from spring_walks import BEST, RADIUS, ROBOT, stood
from springs_walker import SpringsWalker, flat, slope

from clamber.execution.sequencer import Sequencer
from clamber.families.walker.control.track import straight
from clamber.families.walker.control.walker_balance import mass_centre
from clamber.families.walker.execution.footstep_plan import TrackCourse
from clamber.families.walker.execution.motions import ROOM
from clamber.families.walker.execution.predicted_heights import predict_heights
from clamber.families.walker.execution.settings import WalkSettings
from clamber.families.walker.execution.tool_hold import CHANGE, ToolHold
from clamber.families.walker.execution.walk_trace import PHASES, TracedWalker
from clamber.families.walker.execution.walker import RefusedError, Walker
from clamber.families.walker.execution.walking import Walking
from clamber.types import Floats
from tiers import first_fast

ARM = ROBOT.arm
assert ARM is not None


def tool_of(pose: Floats, joints: Floats) -> Floats:
    """Place of the tool, link by link, for a plate that is level but for a turn."""
    assert ARM is not None
    turn = pose[3] + joints[0]
    out, up, pitch = ARM.out, ARM.up, 0.0
    for length, joint in zip(ARM.links, joints[1:], strict=True):
        pitch += joint
        out += length * math.cos(pitch)
        up += length * math.sin(pitch)
    place: Floats = pose[:3] + np.array((out * math.cos(turn), out * math.sin(turn), up))
    return place


class Watched(SpringsWalker):
    """Keeps the commanded joints and the true plate of every tick."""

    def reset(self, pose: Floats, place: Floats, legs: Floats, arm: Floats) -> None:
        super().reset(pose, place, legs, arm)
        self.kept: list[tuple[float, Floats, Floats]] = []

    def step(self) -> None:
        super().step()
        self.kept.append((self.time, self.truth().pose, self.arm.copy()))


@pytest.mark.slow
def test_the_tool_comes_stays_and_leaves_within_range_and_speed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("spring_walks.SpringsWalker", Watched)
    walker, plant = stood(flat, noise=0.0)
    holds: list[ToolHold] = []

    def lay(pose: Floats) -> TrackCourse:
        track = straight(pose, BEST, 0.3, RADIUS)
        point = np.array((0.3, 0.17, walker.pose[2] + 0.2))
        holds.append(ToolHold(walker, track, point, 0.06))
        holds[0].start(walker)
        return TrackCourse(track)

    report = Sequencer(Walking(walker, lay)).run()
    assert report.done, report.reason
    told = holds[0].told()
    assert told.began is not None
    assert told.ended is not None
    assert told.missed < 1e-5
    assert isinstance(plant, Watched)
    held = [(pose, joints) for time, pose, joints in plant.kept if told.began < time <= told.ended]
    ys = np.array([pose[1] for pose, _ in held])
    assert ys.min() == pytest.approx(told.first, abs=3e-3)
    assert ys.max() == pytest.approx(told.last, abs=3e-3)
    errors = [float(np.linalg.norm(tool_of(pose, joints) - told.points[0])) for pose, joints in held]
    assert max(errors) < 3e-3  # the plate's tilt is left out, and what the robot is off by its own reckoning
    assert ARM is not None
    arms = np.array([joints for _, _, joints in plant.kept])
    assert (arms >= np.array(ARM.lowest) - 1e-9).all()
    assert (arms <= np.array(ARM.highest) + 1e-9).all()
    assert (np.abs(np.diff(arms, axis=0)) <= walker.period * np.array(ARM.fastest) + 1e-9).all()
    np.testing.assert_allclose(arms[-1], ARM.rest, atol=1e-6)


@pytest.mark.slow
def test_the_tool_goes_along_a_line_evenly_with_the_way(monkeypatch: pytest.MonkeyPatch) -> None:
    """Through a corner, 0.13 m of line on 0.12 m of way; the tool waits wherever the robot stands."""
    monkeypatch.setattr("spring_walks.SpringsWalker", Watched)
    walker, plant = stood(flat, noise=0.0)
    holds: list[ToolHold] = []
    up = walker.pose[2] + 0.2
    line = np.array(((0.3, 0.12, up), (0.3, 0.2, up), (0.3, 0.2, up + 0.05)))

    def lay(pose: Floats) -> TrackCourse:
        track = straight(pose, BEST, 0.3, RADIUS)
        holds.append(ToolHold(walker, track, line, 0.06))
        holds[0].start(walker)
        return TrackCourse(track)

    assert Sequencer(Walking(walker, lay)).run().done
    told = holds[0].told()
    assert (told.began, told.ended) != (None, None)
    assert told.missed < 5e-4
    middle = 0.185  # where the way passes half of the line's length
    np.testing.assert_allclose((told.first, told.last), (middle - 0.06, middle + 0.06), atol=1e-3)
    assert isinstance(plant, Watched)
    assert told.began is not None
    assert told.ended is not None
    for time, pose, joints in plant.kept:
        if told.began < time <= told.ended:
            gone = 0.13 * np.clip((pose[1] - told.first) / (told.last - told.first), 0.0, 1.0)
            place = line[0] + (0.0, min(gone, 0.08), max(0.0, gone - 0.08))
            assert np.linalg.norm(tool_of(pose, joints) - place) < 4e-3


@pytest.mark.slow
def test_the_reach_that_is_told_is_that_of_the_stretched_arm() -> None:
    walker, _ = stood(flat, noise=0.0)
    assert ARM is not None
    height = 0.1
    track = straight(np.array((0.0, 0.0, 0.0)), BEST, 2.0, RADIUS)
    point = np.array((0.3, 1.0, walker.pose[2] + ARM.up + height))
    hold = ToolHold(walker, track, point, 0.9)
    along = math.sqrt((ARM.out + math.sqrt(sum(ARM.links) ** 2 - height**2)) ** 2 - 0.3**2)
    np.testing.assert_allclose(hold.reach, [(1.0 - along, 1.0 + along)], atol=1e-3)
    assert hold.reach[0][0] < hold.first < hold.last < hold.reach[0][1]


def test_a_point_out_of_reach_is_refused_with_what_is_missing() -> None:
    walker, _ = stood(flat)
    track = straight(np.zeros(3), BEST, 0.2, RADIUS)
    assert ARM is not None
    away = 1.2
    point = np.array((away, 0.1, walker.pose[2] + ARM.up))
    with pytest.raises(RefusedError, match="nowhere") as refused:
        ToolHold(walker, track, point, 0.05)
    assert refused.value.margin == pytest.approx(ARM.out + sum(ARM.links) - away, abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("uphill", first_fast([BEST, None]))
def test_feet_that_sink_in_do_not_raise_what_is_believed(uphill: float | None) -> None:
    """The springs give 0.9 mm under a frame that carries alone; without reckoning with it, every step would add as much."""
    ground = flat if uphill is None else slope(math.radians(5.0), uphill)
    walker, _ = stood(ground, noise=0.0, settings=WalkSettings(longest=0.08))
    sequencer = Sequencer(Walking(walker, lambda pose: TrackCourse(straight(pose, BEST, 0.25, RADIUS))))
    off = walker.pose[2] - walker.plant.truth().pose[2]  # type: ignore[union-attr]
    report = sequencer.run()
    assert report.done, report.reason
    assert len(report.steps) > 5
    assert walker.pose[2] - walker.plant.truth().pose[2] - off == pytest.approx(0.0, abs=1.5e-3)  # type: ignore[union-attr]


@pytest.mark.long
def test_the_tool_has_the_plates_height_only_while_a_frame_slides(monkeypatch: pytest.MonkeyPatch) -> None:
    """A point higher than the arm's shoulder: the plate comes up to it, within its room, faded in and out; the tool stays."""
    monkeypatch.setattr("spring_walks.SpringsWalker", Watched)
    seen: list[tuple[int, float, float, float, float]] = []

    class Seen(ToolHold):
        def aims(self, walker: Walker) -> Floats:
            before = walker.room.raised
            out = super().aims(walker)
            assert isinstance(walker, TracedWalker)
            room = walker.room
            if room.raised != before:
                seen.append((walker.phase, float(room.weights[2]), before, room.raised, walker.height))
                assert room.lowest - 1e-9 <= walker.height <= room.highest + 1e-9
                assert room.weights[[0, 1, 3, 4, 5]].tolist() == [0.0] * 5
            return out

        def raise_wished(self, walker: Walker) -> float:
            wished = super().raise_wished(walker)
            lifts.append(wished - walker.room.raised)
            return wished

    lifts: list[float] = []
    told = {}
    for served in ("arm", "height"):
        walker, plant = stood(flat, noise=0.0)
        holds: list[ToolHold] = []

        def lay(
            pose: Floats, walker: TracedWalker = walker, holds: list[ToolHold] = holds, served: Any = served
        ) -> TrackCourse:
            track = straight(pose, BEST, 0.3, RADIUS)
            point = np.array((0.3, 0.15, walker.pose[2] + ARM.up + 0.63))
            holds.append(Seen(walker, track, point, 0.1, served))
            holds[0].start(walker)
            return TrackCourse(track)

        assert Sequencer(Walking(walker, lay)).run().done
        told[served] = holds[0].told()
        assert isinstance(plant, Watched)
        began, ended = told[served].began, told[served].ended
        assert began is not None
        assert ended is not None
        place = told[served].points[0]
        held = [tool_of(pose, joints) for time, pose, joints in plant.kept if began < time <= ended]
        assert max(float(np.linalg.norm(tool - place)) for tool in held) < 3e-3
    assert {phase for phase, *_ in seen} == {PHASES.index("slide")}
    steps = np.array([(after - before) / walker.period for _, _, before, after, _ in seen])
    weights = np.array([weight for _, weight, *_ in seen])
    assert np.abs(steps).max() <= 0.4 * ROBOT.legs.speed + 1e-9
    assert np.abs(steps[weights < 0.02]).max(initial=0.0) < 1e-4
    assert np.abs(lifts).max() == pytest.approx(
        CHANGE
    )  # down again after the tool has left, but never faster than the legs can
    assert told["arm"].raised == (0.0, 0.0)
    assert told["height"].raised[1] > 0.02
    assert told["height"].measures[1] > 1.02 * told["arm"].measures[1]  # it takes two slides to come up


@pytest.mark.slow
@pytest.mark.parametrize("served", first_fast(["height", "arm"]))
def test_the_reach_with_the_plates_height_is_that_of_the_stretched_arm_on_a_plate_as_high_as_legs_allow(
    served: Literal["arm", "height"],
) -> None:
    """On the flat a foot that is lifted by 50 mm leaves the plate 46 mm upwards: longest leg less room; the rest is a circle."""
    walker, _ = stood(flat, noise=0.0)
    assert ARM is not None
    height, spec = 0.45, ROBOT.legs
    track = straight(np.array((0.0, 0.0, 0.0)), BEST, 2.0, RADIUS)
    feet = float(walker.heights.mean())
    point = np.array((0.3, 1.0, feet + spec.nominal + ARM.up + height))
    raised = (walker.pose[2] - feet if served == "arm" else spec.longest - ROOM) - spec.nominal
    hold = ToolHold(walker, track, point, 0.9, served)
    along = math.sqrt((ARM.out + math.sqrt(sum(ARM.links) ** 2 - (height - raised) ** 2)) ** 2 - 0.3**2)
    np.testing.assert_allclose(hold.reach, [(1.0 - along, 1.0 + along)], atol=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("uphill", first_fast([BEST, None, -BEST, 0.0]))
def test_the_rooms_that_are_rehearsed_are_those_of_the_walk(uphill: float | None) -> None:
    ground = flat if uphill is None else slope(math.radians(6.0), uphill)
    walker, _ = stood(ground, noise=0.0)
    rooms: list[tuple[float, float]] = []

    class Look:
        """An arm that stays; keeps each step's room."""

        def aims(self, walker: Walker) -> Floats:
            room = (walker.room.lowest, walker.room.highest)
            if walker.room.weights[2] > 0.0 and (not rooms or rooms[-1] != room):
                rooms.append(room)
            return walker.arm

        def ahead(self, walker: Walker) -> list[Floats]:
            return []

        def raise_wished(self, walker: Walker) -> float:
            return 0.0

    told: list[Floats] = []

    def lay(pose: Floats) -> TrackCourse:
        track = straight(pose, BEST, 0.3, RADIUS)
        told.append(predict_heights(walker, track, walker.arm).rooms)
        walker.arm_task = Look()
        return TrackCourse(track)

    report = Sequencer(Walking(walker, lay)).run()
    assert report.done, report.reason
    assert len(told[0]) == len(report.steps) == len(rooms)
    np.testing.assert_allclose(told[0][:, [0, 2]], rooms, atol=2.5e-3)  # feet sink in, the plate is never quite level


def test_an_arm_that_would_tip_the_robot_on_its_way_to_the_point_is_refused_before_it_moves() -> None:
    """30 kg are borne at rest, 0.59 m out; stretched to 0.78 m the centre of mass leaves less than is kept, by the closed form."""
    assert ARM is not None
    payload, out = 30.0, 0.78
    walker, _ = stood(flat, noise=0.0, payload=payload)
    normal = np.array(
        (math.cos(math.radians(60.0)), math.sin(math.radians(60.0)), 0.0)
    )  # across an edge of the six feet
    point = out * normal + (0.0, 0.0, walker.pose[2] + ARM.up)
    hold = ToolHold(walker, straight(np.zeros(3), math.radians(150.0), 0.3, RADIUS), point, 0.02)
    before, time = walker.arm.copy(), walker.time
    with pytest.raises(RefusedError, match="swung to the point to hold, brings the centre of mass") as refused:
        hold.start(walker)
    assert walker.time == time
    np.testing.assert_array_equal(walker.arm, before)
    centre = mass_centre(ROBOT, walker.pose, walker.place, hold._joints, payload)
    a, b = walker.soles[3, :2], walker.soles[0, :2]  # the ends of that edge
    margin = float(np.linalg.det([b - a, centre[:2] - a]) / np.linalg.norm(b - a))
    assert refused.value.margin == pytest.approx(margin - walker.settings.limits.balance, abs=1e-9)
