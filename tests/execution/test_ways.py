"""Ways of free limbs: where one waits while the body moves, where one leaves its hold, and who carries meanwhile."""

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from clamber.families.climber.control.limb_chain import legs_of
from clamber.families.climber.control.swing_path import BESIDE, FAR, clearances
from clamber.families.climber.execution.approach import (
    HOOK,
    LEAST_CLEARANCE,
    Approaches,
    Wish,
    discs_near,
    discs_of,
)
from clamber.families.climber.execution.limb_task import LimbTask
from clamber.families.climber.execution.parking import SPARE, TIGHT, park, passes, poses_between
from clamber.families.climber.execution.postures import postures
from clamber.families.climber.execution.whole_body import WholeBody
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.families.climber.world.library import load_board
from clamber.tasks.robots import load_robot
from clamber.types import Floats

PEG = 0.006
NONE = np.empty((0, 3))
RIGHT, LEFT, BOTTOM = 0, 1, 2


def libra() -> LimbedRobot:
    robot = load_robot("libra")
    assert isinstance(robot, LimbedRobot)
    return robot


def approaches() -> Approaches:
    robot = libra()
    return Approaches(robot, legs_of(robot))


def places_of(board: str) -> dict[int, Floats]:
    return {hold.number: np.array((hold.x, hold.y)) for hold in load_board(board).holds}


def least_room(robot: LimbedRobot, i: int, q: Floats, pose: Floats, holds: Mapping[int, Floats]) -> float:
    """Of a limb from all pegs [m]: its links and its hook as points a millimetre apart, in the world."""
    limb = robot.limbs[i]

    def turned(angle: float, x: float, y: float) -> Floats:
        c, s = np.cos(angle), np.sin(angle)
        return np.array((c * x - s * y, s * x + c * y))

    port = pose[:2] + turned(pose[2], limb.port_x, limb.port_y)
    first = pose[2] + limb.port_angle + q[0]
    elbow = port + turned(first, limb.l1, 0.0)
    second = first + q[1]
    tip = elbow + turned(second + limb.hook_beta, limb.l2_effective, 0.0)
    hook = tip + turned(second + limb.end.angle, HOOK[1], 0.0)
    along = np.linspace(0.0, 1.0, 250)[:, None]
    links = np.concatenate((port + along * (elbow - port), elbow + along * (tip - elbow)))
    pegs = np.array(list(holds.values()))
    to_links = np.hypot(*(links[:, None] - pegs[None]).transpose(2, 0, 1)).min() - robot.link_radius
    return float(min(to_links, np.hypot(*(pegs - hook).T).min() - HOOK[0]) - PEG)


def blocked(board: str, seed: int) -> tuple[int, Floats, list[Floats]]:
    """A limb in whose way a peg comes as the body moves, the body's ports clear of all: limb, joint angles, poses."""
    robot, holds, rng = libra(), places_of(board), np.random.default_rng(seed)
    centre = np.mean(list(holds.values()), axis=0)
    while True:
        start = np.array((*(centre + rng.uniform(-0.2, 0.2, 2)), rng.uniform(-0.5, 0.5)))
        poses = poses_between(start, start + rng.uniform(-1.0, 1.0, 3) * (0.05, 0.1, 0.3))
        i, angles = int(rng.integers(3)), rng.uniform(-1.5, 1.5, 2)
        body_room = min(float(np.hypot(*(place - pose[:2]))) for place in holds.values() for pose in poses)
        room = [least_room(robot, i, angles, pose, holds) for pose in poses]
        if body_room > 0.15 and min(room) < 0.005 < room[0]:
            return i, angles, poses


@pytest.mark.parametrize("board", ["modified-ladder", "circle"])
@pytest.mark.parametrize("seed", range(6))
def test_a_parked_limb_meets_no_peg_along_the_way_of_the_body(board: str, seed: int) -> None:
    ways, holds = approaches(), places_of(board)
    i, angles, poses = blocked(board, seed)
    way = park(ways, i, angles, poses, discs_of(holds.values(), PEG))
    assert way is not None
    np.testing.assert_allclose(way[0], angles)
    assert min(least_room(ways.robot, i, way[-1], pose, holds) for pose in poses) > SPARE - 0.001
    for a, b in pairwise(way):
        for u in np.linspace(0.0, 1.0, 20):
            assert least_room(ways.robot, i, a + u * (b - a), poses[0], holds) > LEAST_CLEARANCE - 0.003


@pytest.mark.parametrize("board", ["modified-ladder", "circle"])
@pytest.mark.parametrize("seed", range(6))
def test_the_body_may_pass_where_its_free_limb_can_first_go_elsewhere_and_not_where_it_cannot(
    board: str, seed: int
) -> None:
    ways, holds = approaches(), places_of(board)
    i, angles, poses = blocked(board, seed)
    assert passes(ways, i, angles, poses, discs_of(holds.values(), PEG))
    around = poses[-1][:2] + 0.2 * np.array([(np.cos(a), np.sin(a)) for a in np.linspace(0.0, 2.0 * np.pi, 80)])
    ring = discs_of(around, PEG)  # no limb reaches out of it, nor has it room inside
    assert not passes(ways, i, angles, [poses[0], poses[-1]], ring)


@pytest.mark.parametrize(("angles", "off"), [
    ((136.0, -77.0), (0.0, -0.005)), ((135.0, -77.0), (-0.004, -0.011)), ((133.0, -78.0), (-0.005, -0.010)),
])  # fmt: skip
def test_a_limb_squeezes_past_a_peg_where_the_body_goes_whatever_comes_of_it(
    angles: tuple[float, float], off: tuple[float, float]
) -> None:
    """The right limb behind peg 5 of the modified ladder, of which it let go; the body is to go up by 18 cm."""
    ways, holds, q = approaches(), places_of("modified-ladder"), np.radians(angles)
    discs = discs_of(holds.values(), PEG + 0.003)
    start = np.array((0.221 + off[0], 0.202 + off[1], 1.31))
    poses = poses_between(start, np.array((0.229, 0.381, 1.309)))
    assert park(ways, RIGHT, q, poses, discs) is None
    way = park(ways, RIGHT, q, poses, discs, margins=TIGHT)
    assert way is not None
    assert min(least_room(ways.robot, RIGHT, way[-1], pose, holds) for pose in poses) > SPARE
    for a, b in pairwise(way):
        for u in np.linspace(0.0, 1.0, 20):  # it may touch where the peg might be, not where it is believed
            assert least_room(ways.robot, RIGHT, a + u * (b - a), poses[0], holds) > 0.0


@pytest.mark.parametrize("seed", range(8))
def test_the_clearance_of_a_limb_is_its_distance_from_the_nearest_peg_and_side_of_the_body(seed: int) -> None:
    """Against points a millimetre apart; what the kernel leaves out as too far away must never be the nearest."""
    ways, rng = approaches(), np.random.default_rng(seed)
    leg, robot, pose = ways.legs[RIGHT], ways.robot, np.zeros(3)
    holds = {k: place for k, place in enumerate(rng.uniform(-0.35, 0.35, (int(rng.integers(0, 12)), 2)))}
    angles = rng.uniform(-np.pi, np.pi, (60, 2))
    discs, rooms = discs_near(discs_of(holds.values(), PEG), pose), np.empty(len(angles))
    clearances(leg, angles, (discs, np.empty((0, 5)), robot.link_radius, HOOK), rooms)
    expected = [least_room(robot, RIGHT, q, pose, holds) if holds else FAR for q in angles]
    np.testing.assert_allclose(rooms, expected, atol=4e-4)
    walls = np.column_stack((rng.uniform(-0.5, 0.5, (3, 4)), np.full(3, PEG)))
    clearances(leg, angles, (np.empty((0, 3)), walls, robot.link_radius, np.zeros(2)), rooms)
    along = np.linspace(0.0, 1.0, 300)[:, None]
    for q, room in zip(angles, rooms, strict=True):
        first, second = leg["port_angle"] + q[0], leg["port_angle"] + q.sum() + leg["beta"]
        elbow = np.array((leg["port_x"] + leg["l1"] * np.cos(first), leg["port_y"] + leg["l1"] * np.sin(first)))
        link = elbow + leg["l2"] * along * np.array((np.cos(second), np.sin(second)))
        sides = np.concatenate([side[:2] + along * (side[2:4] - side[:2]) for side in walls])
        apart = np.hypot(*(link[:, None] - sides[None]).transpose(2, 0, 1)).min()
        assert room == pytest.approx(apart - robot.link_radius - PEG, abs=2e-3)


def test_a_limb_with_room_stays_where_it_is() -> None:
    ways, pose = approaches(), np.zeros(3)
    assert park(ways, RIGHT, np.array((0.2, 0.5)), [pose], discs_of([(-0.5, 0.5)], PEG)) is None


def on_a_hold(bend: float) -> tuple[Floats, Floats, Floats]:
    """Tip and grab direction of the right limb with that much bend in its elbow, and the pose of the body."""
    ways, pose = approaches(), np.array((0.0, 0.0, 0.0))
    limb, q = ways.robot.limbs[RIGHT], np.radians((-20.0, bend))
    reach = np.array(
        (
            limb.l1 * np.cos(q[0]) + limb.l2_effective * np.cos(q.sum() + limb.hook_beta),
            limb.l1 * np.sin(q[0]) + limb.l2_effective * np.sin(q.sum() + limb.hook_beta),
        )
    )
    c, s = np.cos(limb.port_angle), np.sin(limb.port_angle)
    tip = np.array((limb.port_x + c * reach[0] - s * reach[1], limb.port_y + s * reach[0] + c * reach[1]))
    angle = limb.port_angle + q.sum() + limb.end.angle
    return tip, np.array((np.cos(angle), np.sin(angle))), pose


def test_a_bent_limb_leaves_without_a_move_of_the_body() -> None:
    tip, grab, pose = on_a_hold(60.0)
    shift = approaches().leave(RIGHT, 1.0, pose, tip, -0.03 * grab, NONE)
    assert shift is not None
    assert not shift.any()


@pytest.mark.parametrize("away", [(0.03, 0.0), (0.0, 0.03), (0.02, 0.02)])
def test_a_stretched_limb_leaves_where_the_body_has_made_it_bend(away: tuple[float, float]) -> None:
    ways = approaches()
    tip, _, pose = on_a_hold(8.0)
    back = np.array(away)
    shift = ways.leave(RIGHT, 1.0, pose, tip, back, NONE)
    assert shift is not None
    assert shift.any()
    moved = pose + np.array((*shift, 0.0))
    for place in (tip, tip + back):
        bends = [one.angles[1] for one in postures(ways.robot.limbs[RIGHT], moved, place) if one.inside]
        assert any(bend > np.radians(20.0) for bend in bends)


@pytest.mark.parametrize("bend", [12.0, 30.0, 60.0])
def test_a_hook_sets_out_to_its_hold_from_where_its_elbow_is_well_bent_if_the_body_may_move(bend: float) -> None:
    """Stretched before its hold a limb would be pushed nowhere: its joints have no lever."""
    ways, near = approaches(), 0.03
    limb, start = ways.robot.limbs[RIGHT], np.radians((0.0, 80.0))
    tip, _, pose = on_a_hold(bend)

    def bends(shift: Floats) -> float:
        moved = pose + np.array((*shift, 0.0))
        final = max((one for one in postures(limb, moved, tip) if one.inside), key=lambda one: one.angles[1])
        before = [one.angles[1] for one in postures(limb, moved, tip - near * final.grab) if one.inside]
        return float(np.degrees(max(before, default=0.0)))

    wish = Wish(elbow=1, stand_off=0.04, near=near)
    found = ways.find(RIGHT, start, pose, tip, NONE, wish)
    assert found is not None
    assert bends(found.shift) > 20.0
    kept = ways.find(RIGHT, start, pose, tip, NONE, wish, stands=lambda pose: False)
    well = bends(np.zeros(2)) > 20.0
    assert kept is None or not kept.shift.any()
    strict = ways.find(RIGHT, start, pose, tip, NONE, replace(wish, straight=False), stands=lambda pose: False)
    assert (strict is not None) == well


def test_no_move_of_the_body_is_made_that_the_others_cannot_bear() -> None:
    tip, grab, pose = on_a_hold(8.0)
    assert approaches().leave(RIGHT, 1.0, pose, tip, -0.03 * grab, NONE, stands=lambda pose: False) is None


@pytest.mark.parametrize("bend", [24.0, 60.0, 105.0])
@pytest.mark.parametrize("move", [(0.0, 0.035), (0.035, 0.0), (0.0, -0.05), (-0.05, 0.0)])
def test_a_hook_is_drawn_back_in_step_with_the_body_only_within_the_joints_limits(
    bend: float, move: tuple[float, float]
) -> None:
    ways = approaches()
    limb = ways.robot.limbs[RIGHT]
    tip, grab, pose = on_a_hold(bend)
    back, shift = -0.048 * grab, np.array(move)
    elbows = []
    for part in np.linspace(0.0, 1.0, 201):
        x, y = tip + part * (back - shift)  # as the body sees it that has moved
        # joint angles by the law of cosines, the elbow to the positive side; the right limb's port does not turn it
        x, y = x - limb.port_x, y - limb.port_y
        cosine = (x * x + y * y - limb.l1**2 - limb.l2_effective**2) / (2.0 * limb.l1 * limb.l2_effective)
        inner = np.arccos(np.clip(cosine, -1.0, 1.0))
        shoulder = np.arctan2(y, x) - np.arctan2(
            limb.l2_effective * np.sin(inner), limb.l1 + limb.l2_effective * np.cos(inner)
        )
        elbow = inner - limb.hook_beta
        inside = limb.shoulder.lower <= shoulder <= limb.shoulder.upper and elbow <= limb.elbow.upper
        elbows.append(elbow if inside and abs(cosine) < 1.0 else -np.inf)
    expected = min(elbows) > np.radians(20.0)
    assert ways.bends(RIGHT, 1.0, pose, tip, back, shift) == expected


def on_three_holds() -> WholeBody:
    """A body whose limbs all carry."""
    body = WholeBody(libra(), period=0.005)
    for i in range(3):
        body.assign(i, LimbTask("stance", i + 1, np.zeros(2)))
    body.see(np.full((3, 2), 0.5), np.zeros((3, 2)), 0.0, 0.0)
    return body


def pass_time(body: WholeBody, seconds: float) -> None:
    for _ in range(round(seconds / body.period)):
        body.see(body.q.copy(), body.qd.copy(), 0.0, 0.0)


def test_a_hand_over_leaves_the_others_clinging() -> None:
    body = on_three_holds()
    body.hand_over([LEFT, BOTTOM])
    pass_time(body, 1.0)
    assert [task.mode for task in body.tasks] == ["unloaded_contact", "stance", "stance"]


def test_a_hand_over_that_is_started_again_begins_anew() -> None:
    body = on_three_holds()
    body.hand_over([LEFT, BOTTOM])
    pass_time(body, 0.3)
    body.hand_over([RIGHT, BOTTOM])
    pass_time(body, 0.3)
    assert body.handing_over
    pass_time(body, 0.7)
    assert [task.mode for task in body.tasks] == ["stance", "unloaded_contact", "stance"]


def test_a_hand_over_to_all_that_hold_ends_the_one_before() -> None:
    body = on_three_holds()
    body.hand_over([LEFT, BOTTOM])
    pass_time(body, 0.3)
    body.hand_over([RIGHT, LEFT, BOTTOM])
    assert not body.handing_over
    pass_time(body, 1.0)
    assert [task.mode for task in body.tasks] == ["stance", "stance", "stance"]


@pytest.mark.parametrize(("pose", "start"), [
    ((0.1935, 1.1597, -0.2622), (6.1, -62.0)), ((0.2124, 1.1851, -0.2425), (25.5, -65.1)),
    ((0.1973, 1.1291, -0.3246), (9.3, -66.4)), ((0.2150, 1.1539, -0.2876), (18.5, -63.6)),
])  # fmt: skip
def test_a_limb_beside_a_hold_leaves_it_first_and_does_not_sweep_over_it(
    pose: tuple[float, float, float], start: tuple[float, float]
) -> None:
    ways, holds, q = approaches(), places_of("modified-ladder"), np.radians(start)
    robot, obstacles = ways.robot, ways.obstacles(discs_near(discs_of(holds.values(), PEG), np.array(pose)))
    way = ways.way(LEFT, q, np.radians((-51.6, 28.8)), obstacles)
    tight = least_room(robot, LEFT, q, np.array(pose), holds)
    assert way is not None and tight < -0.01
    for a, b in pairwise(way):
        for u in np.linspace(0.0, 1.0, 20):
            share = min(1.0, float(np.abs(a + u * (b - a) - q).max()) / BESIDE)
            room = least_room(robot, LEFT, a + u * (b - a), np.array(pose), holds)
            # steadily more on its way out, but for TIGHTER and the pitch of the grid
            assert room > tight + share * (LEAST_CLEARANCE - tight) - 0.004
