"""Pictures: what is drawn is where the model says, motion starts and ends in its stances, files are what they say."""

import cmath
import itertools
import math
import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from clamber.errors import ClamberError, FileError
from clamber.families.climber.pictures.artists import arrow_ends
from clamber.families.climber.pictures.climb_view import ClimbView, Transition, describe_action, swung_foot
from clamber.families.climber.pictures.geometry import body_outline, joint_angles, limb_chain, stance_posture
from clamber.families.climber.planning.problem import LimbedProblem
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.robot.robot import Limb
from clamber.families.walker.pictures.walker_motion import settled_moment, walker_motion
from clamber.families.walker.pictures.walker_view import WalkerView, describe_walk
from clamber.families.walker.planning.problem import WalkerProblem, outline, walker_table
from clamber.families.walker.planning.task import WalkerTask
from clamber.planning.problem.arrays import ActionTable
from clamber.planning.problem.codes import pack
from clamber.planning.problem.problem import Replay
from clamber.planning.problem.problems import normalisation_of
from clamber.tasks import load_task
from clamber.viewing.animation import write_gif, write_mp4
from clamber.viewing.margins import all_limiting, grade
from clamber.viewing.output import MissingExtraError, StepError, SuffixError
from clamber.viewing.pictures import animate, draw_route, draw_stance
from clamber.viewing.plan_curves import draw_history, draw_torques
from clamber.viewing.recording import make_frames
from clamber.viewing.style import styled
from clamber.viewing.view import Picture

RIGHT, LEFT, BOTTOM = 0, 1, 2
UP = pack(1, 0, 2)


class Walk(NamedTuple):
    task: WalkerTask
    replay: Replay


class Climb(NamedTuple):
    task: LimbedTask
    replay: Replay


def climb(name: str, codes: list[int], *overrides: str) -> Climb:
    task = load_task(name, overrides)
    assert isinstance(task, LimbedTask)
    table = ActionTable.build([("none", [pack(0)], False)])
    problem = LimbedProblem(task, table, every_check=True, threads=1)
    return Climb(task, problem.replay(np.array(codes, np.int32), go_on=True))


@pytest.fixture(scope="module")
def ladder() -> Climb:
    """Moves, releases and grabs from the foot of the ladder, all of which hold (holds by index: number less one)."""

    def grab(limb: int, number: int) -> int:
        return pack(4, limb, number - 1)

    return climb(
        "ladder",
        [0, grab(RIGHT, 6), grab(BOTTOM, 1), grab(LEFT, 5), pack(2, BOTTOM), UP, UP, grab(BOTTOM, 3)],
    )  # fmt: skip


@pytest.fixture(scope="module")
def hanging() -> Climb:
    """The robot lets go until it hangs on one limb and swings, moves while it hangs, and takes hold again."""
    return climb(
        "h",
        [
            UP, UP, pack(3, LEFT, 3), pack(3, RIGHT, 1), UP, pack(2, BOTTOM), pack(2, RIGHT), UP, pack(3, RIGHT, 1),
            pack(3, BOTTOM, 1),
        ],
        "start.y=6.2in", "rules.clearance=0in",
    )  # fmt: skip


@pytest.fixture(scope="module")
def walk() -> Walk:
    """The Y-frame slides and turns, the frames swap, the Delta-frame follows; all of it holds."""
    task = load_task("patch-walk")
    assert isinstance(task, WalkerTask)
    move, swap = [pack(1, 0, axis) for axis in range(6)], pack(2)
    codes = [move[0], move[0], move[4], move[4], move[3], swap, move[0], move[0], move[0], swap, move[5], 0]
    replay = WalkerProblem(task, walker_table(), threads=1).replay(np.array(codes, np.int32), go_on=True)
    assert replay.ok
    return Walk(task, replay)


@pytest.fixture(scope="module", params=["ladder", "hanging"])
def any_climb(request: pytest.FixtureRequest) -> Climb:
    made: Climb = request.getfixturevalue(request.param)
    return made


def forward(limb: Limb, origin: complex, angle: float, t1: float, t2: float) -> tuple[complex, complex]:
    """Elbow and tip by the formula of the model's section 1."""
    port = origin + complex(limb.port_x, limb.port_y) * cmath.exp(1j * angle)
    first = limb.l1 * cmath.exp(1j * t1)
    tip = first + limb.l2_effective * cmath.exp(1j * (t1 + t2 + limb.hook_beta))
    turn = cmath.exp(1j * (angle + limb.port_angle))
    return port + first * turn, port + tip * turn


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("seed", range(5))
def test_a_drawn_limb_has_the_joints_and_the_tip_of_its_forward_kinematics(side: float, seed: int) -> None:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    rng = np.random.default_rng(seed)
    for limb in task.robot.limbs:
        origin, angle = complex(*rng.normal(size=2)), float(rng.uniform(-3, 3))
        t1, bend = float(rng.uniform(-3, 3)), float(rng.uniform(0.1, 3.0))
        t2 = side * bend - limb.hook_beta  # branch 0 bends by +acos, branch 1 by -acos
        elbow, tip = forward(limb, origin, angle, t1, t2)
        chain = limb_chain(limb, origin, angle, tip, side)
        assert abs(chain[1] - elbow) < 1e-9
        assert abs(chain[3] - tip) < 1e-9
        np.testing.assert_allclose(np.exp(1j * np.array(joint_angles(limb, angle, chain))), np.exp([1j * t1, 1j * t2]))
        assert abs(abs(chain[2] - chain[1]) - limb.l2) < 1e-12


def test_a_limb_out_of_reach_is_drawn_stretched_and_short_of_its_tip() -> None:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    limb = task.robot.limbs[0]
    port, elbow, _, tip = limb_chain(limb, 0j, 0.0, 2.0 + 1.0j, 1.0)
    assert math.isclose(abs(tip - port), limb.length)
    assert abs(elbow - port) == pytest.approx(limb.l1)


def test_drawn_elbows_are_those_that_the_kernel_solved(any_climb: Climb) -> None:
    task, replay = any_climb
    for stance in replay.stances:
        posture = stance_posture(task.robot, task.world, stance)
        for i in range(3):
            if stance["hold"][i] >= 0:
                at = 1 + 5 * int(stance["branch"][i])
                np.testing.assert_allclose(posture.chains[i, 1], stance["solved"][i, at + 1 : at + 3], atol=1e-9)
                hold = task.world.holds[int(stance["hold"][i])]
                np.testing.assert_allclose(posture.chains[i, 3], (hold.x, hold.y), atol=1e-9)


def test_the_body_holds_its_ports_with_the_margin_round_them() -> None:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    corners = body_outline(task.robot)
    edges = np.roll(corners, -1) - corners
    for limb in task.robot.limbs:
        inside = ((complex(limb.port_x, limb.port_y) - corners) * (edges / abs(edges)).conj()).imag
        assert inside.min() == pytest.approx(task.robot.body_margin, rel=0.02)


def test_motion_begins_and_ends_exactly_in_its_stances(any_climb: Climb) -> None:
    task, replay = any_climb
    for before, after in zip(replay.stances[:-1], replay.stances[1:], strict=True):
        phases = Transition(task.robot, task.world, before, after).phases()
        for share, phase, stance in ((0.0, phases[0], before), (1.0, phases[-1], after)):
            drawn, meant = phase.at(share), stance_posture(task.robot, task.world, stance)
            assert (drawn.x, drawn.y, drawn.angle, drawn.held) == (meant.x, meant.y, meant.angle, meant.held)
            np.testing.assert_array_equal(drawn.chains, meant.chains)


def test_motion_has_no_jumps(any_climb: Climb) -> None:
    task, replay = any_climb
    for before, after in zip(replay.stances[:-1], replay.stances[1:], strict=True):
        phases = Transition(task.robot, task.world, before, after).phases()
        moving = [phase for phase in phases if phase.kind in {"move", "swing", "reach"}]
        ways = [phase.at(float(share)) for phase in moving for share in np.linspace(0, 1, 201)]
        for first, second in itertools.pairwise(ways):
            assert np.abs(second.chains - first.chains).max() < 0.02
            assert np.hypot(second.x - first.x, second.y - first.y) < 0.01


def test_tips_stay_on_held_holds_in_every_frame(any_climb: Climb) -> None:
    task, replay = any_climb
    with styled():
        frames = make_frames(ClimbView(task, replay), 10_000)
    places = task.world.positions()
    held = 0
    for frame in frames:
        for i, index in enumerate(frame.moment.posture.held):
            if index >= 0:
                held += 1
                assert np.abs(frame.moment.posture.chains[i, 3] - places[index]).max() < 1e-6
    assert held > len(frames)


def test_a_swing_keeps_the_distance_to_the_hold_and_ends_below_it(hanging: Climb) -> None:
    task, replay = hanging
    swings = 0
    for before, after in zip(replay.stances[:-1], replay.stances[1:], strict=True):
        transition = Transition(task.robot, task.world, before, after)
        for phase in transition.phases():
            if phase.kind == "swing" and transition.pivot is not None and abs(transition.turned) > 0.1:
                swings += 1
                ways = [phase.at(float(share)) for share in np.linspace(0, 1, 21)]
                distances = [abs(complex(at.x, at.y) - transition.pivot) for at in ways]
                np.testing.assert_allclose(distances, distances[0], atol=1e-6)
                assert ways[-1].x == pytest.approx(transition.pivot.real, abs=1e-6)
    assert swings >= 1


@pytest.mark.parametrize("seed", range(5))
def test_a_swung_foot_never_passes_behind_its_port(seed: int) -> None:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    limb = task.robot.limbs[0]
    port, ahead = complex(limb.port_x, limb.port_y), cmath.exp(1j * limb.port_angle)
    rng = np.random.default_rng(seed)
    ends = [port + ahead * cmath.rect(0.2, float(a)) for a in rng.uniform(-2.5, 2.5, 2)]
    feet = [swung_foot(limb, ends[0], ends[1], float(share)) for share in np.linspace(0, 1, 21)]
    assert abs(feet[0] - ends[0]) < 1e-12
    assert abs(feet[-1] - ends[1]) < 1e-12
    limit = max(abs(cmath.phase((end - port) / ahead)) for end in ends)
    assert all(abs(cmath.phase((foot - port) / ahead)) <= limit + 1e-9 for foot in feet)


def test_actions_are_told_from_what_they_change(ladder: Climb) -> None:
    task, replay = ladder
    stances, reasons = replay.stances, replay.reasons
    told = [
        describe_action(task, before, after, int(reason))
        for before, after, reason in zip(stances[:-1], stances[1:], reasons, strict=True)
    ]
    assert told[0] == "stays"
    assert told[1] == "right grabs 6"
    assert told[4:6] == ["bottom lets go of 1", "body up 3 in"]


def test_the_limiting_check_of_a_violated_step_is_its_reason() -> None:
    task, replay = climb("ladder", [UP, UP, UP, UP, UP])
    assert not replay.ok
    limits = all_limiting(normalisation_of(task), replay)
    for limit, reason in zip(limits, replay.reasons, strict=True):
        assert (grade(limit) == 0) == (reason >= 0)


@pytest.mark.parametrize(
    ("suffix", "start"), [(".png", b"\x89PNG"), (".svg", b"<?xml"), (".pdf", b"%PDF")], ids=["png", "svg", "pdf"]
)
def test_still_pictures_are_what_their_suffix_says(ladder: Climb, tmp_path: Path, suffix: str, start: bytes) -> None:
    draw_stance(ladder.task, ladder.replay, 3, tmp_path / f"stance{suffix}")
    draw_route(ladder.task, ladder.replay, tmp_path / f"route{suffix}")
    for name in ("stance", "route"):
        assert (tmp_path / f"{name}{suffix}").read_bytes().startswith(start)
    assert len(list(tmp_path.iterdir())) == 2  # nothing half-written is left


def test_a_stance_can_be_drawn_on_given_axes(ladder: Climb) -> None:
    axes = Figure().add_subplot()
    draw_stance(ladder.task, ladder.replay, 0, axes)
    discs = max(len(collection.get_paths()) for collection in axes.collections)
    assert discs == len(ladder.task.world.holds)


def test_a_gif_moves_and_keeps_to_its_frames(ladder: Climb, tmp_path: Path) -> None:
    with styled():
        write_gif(Picture(ClimbView(*ladder)), tmp_path / "climb.gif", most=12)
    with Image.open(tmp_path / "climb.gif") as image:
        assert image.format == "GIF"
        assert 2 <= getattr(image, "n_frames", 1) <= 12


@pytest.mark.parametrize("most", [1, 5, 30, 1000])
def test_the_number_of_frames_is_bounded(ladder: Climb, most: int) -> None:
    with styled():
        frames = make_frames(ClimbView(*ladder), most)
    assert 1 <= len(frames) <= most
    assert [frame.step for frame in frames] == sorted(frame.step for frame in frames)


def test_a_page_is_one_file_that_loads_nothing(ladder: Climb, tmp_path: Path) -> None:
    animate(ladder.task, ladder.replay, tmp_path / "climb.html")
    page = (tmp_path / "climb.html").read_text(encoding="utf-8")
    assert page.startswith("<!doctype html>")
    assert not re.search(r"""(src|href)=["']https?:|@(TITLE|DATA)@""", page)


def test_names_cannot_end_a_pages_script(ladder: Climb, tmp_path: Path) -> None:
    task, replay = climb("ladder", [0], "title=</script><script>alert(1)")
    animate(task, replay, tmp_path / "climb.html")
    page = (tmp_path / "climb.html").read_text(encoding="utf-8")
    assert "alert(1)" in page
    assert "<script>alert" not in page


@pytest.mark.parametrize("name", ["climb.bmp", "climb", "climb.png"])
def test_animations_name_the_suffixes_they_can_be(ladder: Climb, tmp_path: Path, name: str) -> None:
    with pytest.raises(SuffixError, match=r"\.gif, \.html, \.mp4") as caught:
        animate(ladder.task, ladder.replay, tmp_path / name)
    assert isinstance(caught.value, ClamberError)
    assert name in str(caught.value)


def test_still_pictures_name_the_suffixes_they_can_be(ladder: Climb, tmp_path: Path) -> None:
    for draw in (
        lambda path: draw_stance(ladder.task, ladder.replay, 0, path),
        lambda path: draw_route(ladder.task, ladder.replay, path),
        lambda path: draw_torques(ladder.task, {"plan": ladder.replay}, path),
        lambda path: draw_history([], path),
    ):
        with pytest.raises(SuffixError, match=r"\.png, \.svg, \.pdf"):
            draw(tmp_path / "picture.jpeg2")


def test_a_step_that_is_not_there_is_named(ladder: Climb, tmp_path: Path) -> None:
    with pytest.raises(StepError, match=r"step = 99: .*0 \(the start\) to 8"):
        draw_stance(ladder.task, ladder.replay, 99, tmp_path / "x.png")


def test_a_folder_that_is_not_there_is_named(ladder: Climb, tmp_path: Path) -> None:
    with pytest.raises(FileError, match="nowhere"):
        draw_stance(ladder.task, ladder.replay, 0, tmp_path / "nowhere" / "x.png")


def test_a_missing_extra_is_named(ladder: Climb, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "imageio_ffmpeg", None)
    with styled(), pytest.raises(MissingExtraError, match=r'pip install "\.\[video\]" in a clone of Clamber'):
        write_mp4(Picture(ClimbView(*ladder)), tmp_path / "climb.mp4")


def test_charts_are_written(ladder: Climb, tmp_path: Path) -> None:
    class Line(NamedTuple):
        generation: int
        best_fitness: float
        furthest: int
        stage: int

    history = [Line(k, 1.0 - 0.5**k, 3 * k, k // 4) for k in range(9)]
    draw_history(history, tmp_path / "history.png", goals=("first", "top"))
    draw_torques(ladder.task, {"one": ladder.replay, "two": ladder.replay}, tmp_path / "torques.png")
    for name in ("history.png", "torques.png"):
        with Image.open(tmp_path / name) as image:
            assert image.width > 500


def test_arrows_of_forces_stay_inside_the_wall(any_climb: Climb) -> None:
    with styled():
        view = ClimbView(*any_climb)
    x0, x1, y0, y1 = view.bounds
    ends = np.vstack([arrow_ends(any_climb.task, view.settled(k)) for k in range(len(any_climb.replay.stances))])
    assert x0 < ends[:, 0].min() < ends[:, 0].max() < x1
    assert y0 < ends[:, 1].min() < ends[:, 1].max() < y1


def test_a_walkers_motion_begins_and_ends_exactly_in_its_stances(walk: Walk) -> None:
    task, replay = walk
    for before, after in itertools.pairwise(replay.stances):
        parts = walker_motion(task, before, after)
        if len(parts) == 1 and parts[0].kind == "still":
            parts = [parts[0], parts[0]]
        for share, part, stance in ((0.0, parts[0], before), (1.0, parts[-1], after)):
            drawn, meant = part.at(share, share), settled_moment(task, stance)
            assert drawn.lifts == meant.lifts
            np.testing.assert_array_equal(drawn.poses, meant.poses)
            np.testing.assert_array_equal(drawn.outline.feet, outline(task, stance).feet)


def test_between_its_stances_a_walker_keeps_its_shape_and_its_standing_feet(walk: Walk) -> None:
    task, replay = walk
    for before, after in itertools.pairwise(replay.stances):
        start = settled_moment(task, before)
        stands = start.lifts.index(0.0)
        for part in walker_motion(task, before, after):
            shares = np.linspace(0.0, 1.0, 41).tolist()
            ways = [part.at(share, share) for share in shares]
            for at in ways:
                np.testing.assert_allclose(at.outline.feet[stands], start.outline.feet[stands], atol=1e-12)
                for f, feet in enumerate(at.outline.feet):
                    sides = np.hypot(*(feet - np.roll(feet, 1, axis=0)).T)
                    np.testing.assert_allclose(sides, math.sqrt(3) * np.hypot(*task.robot.feet()[f, 0]), atol=1e-12)
                assert 0.0 in at.lifts
            for first, second in itertools.pairwise(ways):
                assert np.abs(second.outline.feet - first.outline.feet).max() < 1e-3


def test_both_frames_stand_within_a_swap_alone(walk: Walk) -> None:
    task, replay = walk
    with styled():
        frames = make_frames(WalkerView(task, replay), 10_000)
    both = {frame.step for frame in frames if frame.moment.lifts == (0.0, 0.0)}
    assert both == {6, 10}
    at = next(frame.moment for frame in frames if frame.step == 6 and frame.moment.lifts == (0.0, 0.0))
    assert len(at.support) == 6


def test_the_support_holds_the_feet_on_the_ground_and_turns_left(walk: Walk) -> None:
    for moment in (settled_moment(walk.task, stance) for stance in walk.replay.stances):
        feet = np.vstack([moment.outline.feet[f] for f in (0, 1) if moment.lifts[f] == 0.0])
        for a, b in zip(moment.support, np.roll(moment.support, -1, axis=0), strict=True):
            assert np.min((b - a)[0] * (feet - a)[:, 1] - (b - a)[1] * (feet - a)[:, 0]) >= -1e-12


def test_drawn_actuators_are_as_long_as_the_kernel_says(walk: Walk) -> None:
    for stance in walk.replay.stances:
        np.testing.assert_allclose(settled_moment(walk.task, stance).lengths, stance["actuator"], atol=1e-12)


def test_a_walkers_actions_are_told_from_what_they_change(walk: Walk) -> None:
    task, replay = walk
    moments = [settled_moment(task, stance) for stance in replay.stances]
    told = [describe_walk(task, before, after, -1) for before, after in itertools.pairwise(moments)]
    assert told[0] == "Y-frame slides 2 cm along +x"
    assert told[2] == "Y-frame turns +6°"
    assert told[4:7] == [
        "Y-frame slides 2 cm along −y",
        "Y-frame lands, Delta-frame lifts",
        "Delta-frame slides 2 cm along +x",
    ]
    assert told[-1] == "stays"
    assert describe_walk(task, moments[0], moments[1], 1).endswith("violates singular")


def test_a_walkers_limiting_check_has_the_smallest_share(walk: Walk) -> None:
    task, replay = walk
    normalisation = normalisation_of(task)
    for limit, row in zip(all_limiting(normalisation, replay), replay.margins, strict=True):
        shares = [
            margin / normalisation.sizes[check.name] for check, margin in zip(normalisation.checks, row, strict=True)
        ]
        assert limit is not None
        assert limit.share == pytest.approx(min(1.0, *shares))


def test_walkers_are_drawn_in_every_format(walk: Walk, tmp_path: Path) -> None:
    draw_stance(walk.task, walk.replay, 6, tmp_path / "stance.png")
    draw_route(walk.task, walk.replay, tmp_path / "route.svg")
    animate(walk.task, walk.replay, tmp_path / "walk.html")
    with styled():
        write_gif(Picture(WalkerView(*walk)), tmp_path / "walk.gif", most=12)
    with Image.open(tmp_path / "walk.gif") as image:
        assert 2 <= getattr(image, "n_frames", 1) <= 12
    page = (tmp_path / "walk.html").read_text(encoding="utf-8")
    assert not re.search(r"""(src|href)=["']https?:|@(TITLE|DATA)@""", page)
    assert (tmp_path / "stance.png").read_bytes().startswith(b"\x89PNG")
    axes = Figure().add_subplot()
    draw_stance(walk.task, walk.replay, 0, axes)
    assert len(axes.patches) > len(walk.task.world.patches)


def test_a_walkers_task_alone_is_drawn(walk: Walk, tmp_path: Path) -> None:
    start = WalkerProblem(walk.task, walker_table(), threads=1).replay(np.zeros(0, np.int32))
    draw_stance(walk.task, start, 0, tmp_path / "start.png")
    assert (tmp_path / "start.png").stat().st_size > 10_000
