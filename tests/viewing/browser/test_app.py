"""The viewer behind its page: the clock, what is shown of a plan and its run, and work that fails without harm."""

import socket
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from clamber.errors import ClamberError, StartError
from clamber.families.climber.pictures.board_editor import BoardPanel
from clamber.families.climber.pictures.climb_run import ClimbFilm
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.walker.pictures.ground_editor import GroundPanel
from clamber.families.walker.planning import Walk
from clamber.families.walker.planning.task import WalkerTask
from clamber.planning.problem.plan import load_plan
from clamber.planning.problem.plan_source import open_plan
from clamber.planning.problem.verdict import check_plan
from clamber.tasks import Task, load_task
from clamber.viewing.browser import work_panel
from clamber.viewing.browser.app import App, PortError, check_port
from clamber.viewing.browser.viewer_content import Planned, open_exhibit
from clamber.viewing.recording import Recording

Serve = Callable[..., App]


def eventually(holds: Callable[[], Any], seconds: float = 120.0) -> None:
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end, "still not so"
        time.sleep(0.02)


def shown_figures(app: App) -> set[str]:
    return {name for name, figure in app.stage._figures.items() if figure.root.visible}  # type: ignore[attr-defined]


def test_clock_plays_pauses_and_ends(serve: Serve) -> None:
    playback = serve(open_exhibit(["ladder-hand"])).playback
    assert not playback.playing
    playback.play(True)
    eventually(lambda: playback.time > 0.2)
    playback.toggle()
    at = playback.time
    time.sleep(0.2)
    assert playback.time == at
    playback.seek(1e9)
    assert playback.time == playback.film.seconds
    playback.play(True)  # from the start again
    eventually(lambda: 0.0 < playback.time < 1.0)
    playback.seek(playback.film.seconds - 0.05)
    eventually(lambda: not playback.playing)
    assert playback.time == playback.film.seconds


def test_steps_are_jumped_to_within_the_plan(serve: Serve) -> None:
    playback = serve(open_exhibit(["ladder-hand"])).playback
    for asked, shown in ((5, 5), (-3, 0), (999, 63)):
        playback.jump(asked)
        assert playback.step == shown


def test_texts_follow_the_step(serve: Serve) -> None:
    app = serve(open_exhibit(["ladder-hand"]))
    app.playback.jump(7)
    texts = app.stage._texts
    assert "Step 7 of 63" in texts["head"].content
    assert texts["margins"].content.count("font-weight:700") == 1
    assert "right shoulder" in texts["bars"].content


def test_plan_and_run_are_made_and_shown_together(serve: Serve, compiled: None) -> None:
    app = serve(open_exhibit(["ladder"]))
    board, work = app.editor, app.work
    assert isinstance(board, BoardPanel) and work is not None
    board.draft.set_goal(9 * 0.0254, 12 * 0.0254)
    board.apply()
    assert app.exhibit.task is not None and app.exhibit.plan is None
    work._reserves.value = False
    work.plan()
    eventually(lambda: not work.background_task.busy)
    assert app.exhibit.plan is not None and set(app.stage.films) == {"plan"}
    work._reserves.value = True
    work.plan()
    eventually(lambda: not work.background_task.busy)
    work.run()
    eventually(lambda: not work.background_task.busy)
    film = app.exhibit.run_film
    assert isinstance(film, ClimbFilm) and app.playback.film is film
    assert app.stage.shown == "both" and set(app.stage.films) == {"plan", "run"}
    app.playback.jump(1)
    assert shown_figures(app) == {"run", "plan ghost"}
    app.choose("plan")
    plan: Recording[Any] = app.stage.films["plan"]
    assert app.playback.film is plan
    assert shown_figures(app) == {"plan"}
    board.apply()  # another board has no plan yet
    assert app.exhibit.plan is None and set(app.stage.films) == {"plan"}


def test_bad_board_is_drawn_and_told_of_and_nothing_else_changes(serve: Serve) -> None:
    app = serve(open_exhibit(["gap"]))
    board = app.editor
    assert isinstance(board, BoardPanel)
    before = app.exhibit
    peg = board.draft.pegs[1]
    board.draft.move(2, peg.x, peg.y)
    board.apply()
    assert (
        "the edited board: holds.2: holds 1 and 2 overlap" in board._peg_words.content
        and board._goal_words.content == ""
    )
    assert app.exhibit is before
    drawn = board._scene()._pegs
    assert drawn is not None
    np.testing.assert_allclose(drawn.node.batched_positions[1], drawn.node.batched_positions[0])
    for number in (1, 2, 3):
        board.draft.remove(number)
    board.apply()
    assert "no holds" in board._peg_words.content
    board._pressed("add")
    assert tuple(board.draft.pegs) == (1,)
    board._pressed("as it was")
    assert board._peg_words.content == "" and app.exhibit.task is not None
    assert app.exhibit.task.world.holds == board.draft.task.world.holds  # type: ignore[union-attr]


def test_start_that_does_not_hold_is_told_of(serve: Serve) -> None:
    app = serve(open_exhibit(["gap"]))
    board = app.editor
    assert isinstance(board, BoardPanel)
    peg = board.draft.pegs[1]
    board.draft.move(1, peg.x - 1.0, peg.y)  # out of the reach of the limb that is on it
    with pytest.raises(StartError):
        app.show_task(board.task())
    board.apply()
    assert "start" in board.start.body._words.content and board._peg_words.content == ""
    board._pressed("as it was")
    assert board.start.body._words.content == ""


def test_start_is_moved_and_its_limbs_put_on_other_pegs(serve: Serve) -> None:
    app = serve(open_exhibit(["ladder"]))
    board, task = app.editor, app.exhibit.task
    assert isinstance(board, BoardPanel) and isinstance(task, LimbedTask)
    begins = task.start
    board.start._moved(begins.x + 0.01, begins.y, 0.05)
    shown = app.exhibit.task
    assert isinstance(shown, LimbedTask) and (shown.start.x, shown.start.theta) == (begins.x + 0.01, 0.05)
    film = app.stage.films["plan"]
    at = film.at(0.0).posture
    assert (at.x, at.y, at.angle) == pytest.approx((begins.x + 0.01, begins.y, 0.05))
    np.testing.assert_allclose(
        at.chains[:, 3], [_place(shown, number) for number in shown.start.holds.values()], atol=1e-6
    )
    board.start._moved(begins.x + 3.0, begins.y, 0.0)  # off the wall
    assert "start" in board.start.body._words.content
    assert app.exhibit.task is shown and app.stage.films["plan"] is film  # what was there stays
    board._pressed("as it was")
    assert board.start.body._words.content == "" and app.exhibit.task.start == begins


def _place(task: LimbedTask, number: int) -> tuple[float, float]:
    hold = task.world.by_number(number)
    return hold.x, hold.y


def test_run_without_a_plan_is_told_of(serve: Serve) -> None:
    work = serve(open_exhibit(["gap"])).work
    assert work is not None
    work.run()
    assert "press Plan first" in work._run_words.content


def test_ports_are_checked() -> None:
    check_port("127.0.0.1", 0)
    with pytest.raises(PortError, match=r"cannot listen on 192\.0\.2\.1"):
        check_port("192.0.2.1", 0)  # of no machine
    assert issubclass(PortError, ClamberError)


def test_a_port_that_is_taken_between_the_check_and_the_start_is_told_of(monkeypatch: pytest.MonkeyPatch) -> None:
    """viser listens on the next one in silence, where the viewer's address does not lead."""
    monkeypatch.setattr("clamber.viewing.browser.app.check_port", lambda host, port: None)
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        with pytest.raises(PortError, match=f"port {port}: another program has just taken it"):
            App(open_exhibit(["gap"]), port=port)


def test_an_edited_board_is_saved_with_its_task_and_its_plan(tmp_path: Path, serve: Serve) -> None:
    app = serve(open_exhibit(["ladder-hand"]), folder=tmp_path)
    board, saving = app.editor, app.saving
    assert isinstance(board, BoardPanel) and saving is not None
    saving.save()
    plan = tmp_path / "ladder-edited-plan.json"
    assert check_plan(load_task(str(tmp_path / "ladder-edited.toml")), load_plan(plan)).ok
    board.draft.move(22, 0.5, 1.6)
    board.draft.set_goal(0.25, 1.0)
    board.apply()
    saving._name.value = "taller"
    saving.save()
    assert str(tmp_path) in saving._words.content and "taller-board.toml" in saving._words.content
    saved, shown = load_task(str(tmp_path / "taller.toml")), app.exhibit.task
    assert isinstance(saved, LimbedTask) and isinstance(shown, LimbedTask)
    places = [
        np.array([(hold.number, hold.x, hold.y, hold.radius) for hold in it.world.holds]) for it in (saved, shown)
    ]
    assert places[0] == pytest.approx(places[1], abs=1e-9), (
        "numbers are saved so that people can read them, to a nanometre"
    )
    assert saved.goals == shown.goals
    assert not (tmp_path / "taller-plan.json").exists()  # another board has no plan yet


@pytest.mark.parametrize("name", ["", "../out", "/tmp/out", "a.toml", "a b"])
def test_files_are_saved_in_one_folder_only(name: str, tmp_path: Path, serve: Serve) -> None:
    saving = serve(open_exhibit(["gap"]), folder=tmp_path).saving
    assert saving is not None
    saving._name.value = name
    saving.save()
    assert "no path" in saving._words.content
    assert list(tmp_path.iterdir()) == []


def test_files_of_others_are_not_written_over(tmp_path: Path, serve: Serve) -> None:
    saving = serve(open_exhibit(["gap"]), folder=tmp_path).saving
    assert saving is not None
    theirs = tmp_path / "gap-edited.toml"
    theirs.write_text("theirs")
    saving.save()
    assert "is there already" in saving._words.content
    assert [path.read_text() for path in tmp_path.iterdir()] == ["theirs"]
    theirs.unlink()
    saving.save()
    saving.save()  # its own it may
    assert "written to" in saving._words.content


def test_a_board_that_makes_no_task_is_not_saved(tmp_path: Path, serve: Serve) -> None:
    app = serve(open_exhibit(["gap"]), folder=tmp_path)
    assert isinstance(app.editor, BoardPanel) and app.saving is not None
    for number in tuple(app.editor.draft.pegs):
        app.editor.draft.remove(number)
    app.saving.save()
    assert "no holds" in app.saving._words.content and list(tmp_path.iterdir()) == []


def test_a_page_that_others_can_reach_saves_nothing(serve: Serve) -> None:
    app = serve(open_exhibit(["gap"]), "0.0.0.0")
    assert app.editor is not None and app.saving is None


def test_a_run_that_nothing_judges_shows_the_margins_of_its_plan(serve: Serve, compiled: None) -> None:
    app = serve(open_exhibit(["ladder"], overrides=["goal={ y_min = '9 in' }"]))
    work = app.work
    assert work is not None
    for act in (work.plan, work.run):
        act()
        eventually(lambda: not work.background_task.busy)
    app.playback.jump(1)
    assert "of the plan, at its step" in app.stage._texts["margins"].content
    app.choose("run")
    app.playback.jump(1)
    assert "checks judge the steps of a plan" in app.stage._texts["margins"].content


def test_what_is_found_for_a_board_that_was_changed_meanwhile_is_left_out(
    serve: Serve, monkeypatch: pytest.MonkeyPatch
) -> None:
    app = serve(open_exhibit(["ladder"]))
    board, work = app.editor, app.work
    assert isinstance(board, BoardPanel) and work is not None
    answer = Planned(open_plan("ladder-hand").plan, "found")

    def edited_meanwhile(task: Task, *rest: Any, **options: Any) -> Planned:
        board.draft.move(22, 0.5, 1.6)
        board.apply()
        return answer

    monkeypatch.setattr(work_panel, "make_plan", edited_meanwhile)
    work.plan()
    eventually(lambda: not work.background_task.busy)
    assert "changed meanwhile" in work._plan_words.content and app.exhibit.plan is None
    monkeypatch.setattr(work_panel, "make_plan", lambda *rest, **options: answer)
    work.plan()
    eventually(lambda: not work.background_task.busy)
    assert "found" in work._plan_words.content and app.exhibit.plan is answer.plan


def test_ground_start_and_goal_of_a_walk_are_edited(serve: Serve) -> None:
    app = serve(open_exhibit(["level-walk"]))
    ground, work = app.editor, app.work
    assert isinstance(ground, GroundPanel) and work is not None
    assert app.playback.film.seconds == 0.0 and not work._planner.visible and not work._plan_button.visible
    ground._add("step")
    ground._set_goal(0.1, 0.0, 0.0)
    walk = app.exhibit.task
    assert isinstance(walk, Walk) and len(walk.ground.blocks) == 1 and walk.way[0].to == (0.1, 0.0)
    ground._set_start(30.0, 0.0, 0.0)
    assert "no ground" in ground.start._words.content and ground.goal._words.content == ground._words.content == ""
    assert app.exhibit.task is walk  # what was there stays
    ground._set_start(0.0, 0.0, 0.0)
    assert ground.start._words.content == ""
    ground._pressed("as it was")
    assert not ground.draft.changed


def test_a_walkers_task_is_planned_on_the_ground_as_it_was_edited(serve: Serve) -> None:
    app = serve(open_exhibit(["patch-walk"]))
    ground, work = app.editor, app.work
    assert isinstance(ground, GroundPanel) and work is not None and work._plan_button.visible
    ground._set_goal(0.3, 0.0, 0.0)
    k = ground._picked
    ground._adds.value = "patch"
    ground._add("patch")
    assert ground._picked == len(ground.draft.pieces) - 1 != k
    ground._pressed("remove")
    work._reserves.value = False
    work.plan()
    eventually(lambda: not work.background_task.busy)
    task, plan = app.exhibit.task, app.exhibit.plan
    assert isinstance(task, WalkerTask) and plan is not None and check_plan(task, plan).ok
    last = app.stage.films["plan"]
    assert last.at(last.seconds).poses[0, :2] == pytest.approx((0.3, 0.0), abs=0.021)
