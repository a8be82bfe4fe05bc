"""The viewer in a real browser: it loads without a word of complaint, plays, edits a board, plans and runs, all by clicks."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from page_visits import Visit, pixel, wait_for

from clamber.families.climber.pictures.board_editor import BoardPanel
from clamber.families.climber.pictures.space import WallScene
from clamber.families.walker.pictures.ground_editor import GroundPanel
from clamber.families.walker.planning import load_walk
from clamber.planning.problem.plan import load_plan
from clamber.planning.problem.verdict import check_plan
from clamber.tasks import load_task
from clamber.viewing.browser.app import App
from clamber.viewing.browser.page import write_page
from clamber.viewing.browser.viewer_content import open_exhibit

Open = Callable[[str], Visit]
Serve = Callable[..., App]


def test_plan_plays_and_jumps(serve: Serve, visit: Open) -> None:
    app = serve(open_exhibit(["ladder-hand"]))
    shown = visit(app.url)
    shown.says("Start")
    before = shown.picture("plan-start")
    shown.press("Play")
    wait_for(shown, lambda: app.playback.time > 1.0)
    shown.press("Pause")
    assert shown.picture("plan-playing") != before
    shown.press("worst")
    worst = app.playback.film.worst
    assert worst is not None
    shown.says(f"Step {worst} of 63")
    shown.press("step ▶")
    shown.says(f"Step {worst + 1} of 63")
    assert shown.page.locator('[data-clamber="margins"] tr').count() > 5
    assert shown.wrong == []
    assert all(url.startswith((app.place, "blob:", "data:")) for url in shown.asked)


@pytest.mark.long
def test_board_is_edited_planned_saved_and_run_by_clicks(
    serve: Serve, visit: Open, compiled: None, tmp_path: Path
) -> None:
    app = serve(open_exhibit(["ladder"]), folder=tmp_path)
    shown, board = visit(app.url), app.editor
    assert isinstance(board, BoardPanel) and isinstance(app.stage.world, WallScene)
    page, depth = shown.page, app.stage.world.depth
    page.get_by_role("tab", name="Board").click()
    page.get_by_label("edit on the wall").check()

    peg = board.draft.pegs[13]
    page.mouse.click(*pixel(app, shown, np.array((peg.x, -depth, peg.y))))
    wait_for(shown, lambda: page.get_by_label("peg", exact=True).input_value() == "13")
    x, y = pixel(app, shown, np.array((peg.x + 0.05, -depth, peg.y)))  # the handle's arm to the right
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 8, y, steps=4)
    page.mouse.move(x + 16, y, steps=4)
    page.mouse.up()
    wait_for(shown, lambda: board.draft.pegs[13].x > peg.x + 0.005)
    assert board.draft.pegs[13].y == pytest.approx(peg.y, abs=1e-3)
    shown.picture("board-dragged")

    shown.press("add")
    wait_for(shown, lambda: len(board.draft.pegs) == 23)
    shown.press("remove")
    wait_for(shown, lambda: len(board.draft.pegs) == 22)
    goal = shown.vector("goal [in]").nth(1)
    goal.fill("15")
    goal.press("Enter")
    wait_for(shown, lambda: app.exhibit.task is not None and app.exhibit.task.goals[-1].box[3] < 0.5)
    assert app.exhibit.plan is None
    assert shown.errors() == []

    shown.press("Plan")
    shown.says("with reserves for a run")
    shown.picture("board-planned")
    plan = app.exhibit.plan
    assert plan is not None and check_plan(app.exhibit.task, plan).ok
    shown.press("Save")
    shown.says("written to")
    assert check_plan(
        load_task(str(tmp_path / "ladder-edited.toml")), load_plan(tmp_path / "ladder-edited-plan.json")
    ).ok
    shown.press("Run")
    shown.says("climbed:")
    run = app.exhibit.run_film
    assert run is not None
    wait_for(shown, lambda: app.playback.film is run and app.playback.time > 0.5 * run.seconds)  # it plays by itself
    shown.picture("board-run")
    assert shown.wrong == []


@pytest.mark.long
def test_clicks_on_the_wall_add_and_remove_pegs_and_set_the_goal(serve: Serve, visit: Open) -> None:
    app = serve(open_exhibit(["gap"]))
    shown, board = visit(app.url), app.editor
    assert isinstance(board, BoardPanel) and isinstance(app.stage.world, WallScene)
    page, depth = shown.page, app.stage.world.depth
    page.get_by_role("tab", name="Board").click()
    page.get_by_label("edit on the wall").check()

    def click(does: str, x: float, y: float, deep: float = 0.0) -> None:
        page.get_by_label("a click on the wall").click()
        page.get_by_role("option", name=does).click()
        page.mouse.click(*pixel(app, shown, np.array((x, -deep, y))))

    click("adds a peg", 0.4, 0.0)
    wait_for(shown, lambda: len(board.draft.pegs) == 4)
    assert (board.draft.pegs[4].x, board.draft.pegs[4].y) == pytest.approx((0.4, 0.0), abs=5e-3)
    click("removes a peg", 0.4, 0.0, 0.5 * depth)  # half-way along it
    wait_for(shown, lambda: set(board.draft.pegs) == {1, 2, 3})
    click("sets the goal", 0.3, 0.25)
    wait_for(shown, lambda: board.draft.goal is not None)
    assert board.draft.goal == pytest.approx((0.3, 0.25), abs=5e-3)
    assert shown.errors() == [] and shown.wrong == []


@pytest.mark.long
def test_start_is_dragged_on_the_wall_and_its_limbs_chosen(serve: Serve, visit: Open) -> None:
    app = serve(open_exhibit(["ladder"]))
    shown, board = visit(app.url), app.editor
    assert isinstance(board, BoardPanel) and isinstance(app.stage.world, WallScene)
    page, depth, begins = shown.page, app.stage.world.depth, board.draft.start
    page.get_by_role("tab", name="Board").click()
    before = shown.picture("start")
    page.get_by_label("edit on the wall").check()
    wait_for(shown, lambda: shown.picture("start-with-handles") != before)  # else there is nothing to take hold of yet
    x, y = pixel(app, shown, np.array((begins.x, -depth, begins.y + 0.08)))  # the handle's arm upwards
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x, y - 6, steps=4)
    page.mouse.move(x, y - 12, steps=4)
    page.mouse.up()
    wait_for(shown, lambda: board.draft.start.y > begins.y + 0.005)
    assert board.draft.start.x == pytest.approx(begins.x, abs=1e-3)
    wait_for(shown, lambda: app.exhibit.task is not None and app.exhibit.task.start.y == board.draft.start.y)
    assert shown.errors() == []
    shown.picture("start-dragged")

    page.get_by_label("left is on").click()
    page.get_by_role("option", name="free", exact=True).click()
    wait_for(shown, lambda: board.draft.start.holds["left"] == 0)
    body = shown.vector("body [in]")
    body.nth(0).fill("90")
    body.nth(0).press("Enter")
    shown.says("the start stance violates")
    assert len(shown.errors()) == 1
    shown.picture("start-off-the-wall")
    shown.press("as it was")
    wait_for(shown, lambda: not board.draft.changed)
    wait_for(shown, lambda: shown.errors() == [])
    assert shown.wrong == []


@pytest.mark.long
def test_ground_is_edited_and_walked_by_clicks(serve: Serve, visit: Open, tmp_path: Path) -> None:
    app = serve(open_exhibit(["slope-walk"]), folder=tmp_path)
    shown, ground = visit(app.url), app.editor
    assert isinstance(ground, GroundPanel)
    page = shown.page
    page.get_by_role("tab", name="Ground").click()
    page.get_by_label("edit on ground").check()
    shown.press("ditch")
    wait_for(shown, lambda: len(ground.draft.pieces) == 1)
    place = shown.vector("from [cm]")
    place.nth(0).fill("90")  # beyond its other end
    place.nth(0).press("Enter")
    shown.says("must be less than x_max")
    for field, value in ((0, "-10"), (1, "10")):  # under a foot of the Delta-frame
        place.nth(field).fill(value)
        place.nth(field).press("Enter")
    for field, value in ((0, "10"), (1, "40")):
        place = shown.vector("to [cm]").nth(field)
        place.fill(value)
        place.press("Enter")
    shown.says("mm lower than under")
    assert len(shown.errors()) == 1  # beside the start, and no more beside the ditch
    shown.picture("ground-foot-in-a-ditch")
    shown.press("remove")
    wait_for(shown, lambda: shown.errors() == [])

    goal = shown.vector("place [cm]")
    goal.nth(2).fill("9000")
    goal.nth(2).press("Enter")
    shown.says("no ground")
    goal.nth(2).fill("10")
    goal.nth(2).press("Enter")
    wait_for(shown, lambda: shown.errors() == [])
    shown.press("Save")
    shown.says("written to")
    assert load_walk(str(tmp_path / "slope-walk-edited.toml")).way[0].to == pytest.approx((0.1, 0.0), abs=1e-3)
    shown.press("Run")
    shown.says("walked:")
    run = app.exhibit.run_film
    assert run is not None
    wait_for(shown, lambda: app.playback.film is run and app.playback.time > 0.5 * run.seconds)
    page.get_by_role("tab", name="Play").click()
    for title in ("Force along each leg", "Grip in use", "Leg lengths", "Actuator forces", "Actuator lengths"):
        shown.says(title)
    shown.picture("ground-walked")
    assert shown.wrong == []


@pytest.mark.long
def test_bad_boards_are_told_of_and_the_page_stays(serve: Serve, visit: Open, compiled: None) -> None:
    app = serve(open_exhibit(["gap"]))
    shown, board = visit(app.url), app.editor
    assert isinstance(board, BoardPanel)
    shown.page.get_by_role("tab", name="Board").click()

    place = shown.vector("its place [in]")
    there = board.draft.pegs[2]
    for field, value in zip((0, 1), (there.x, there.y), strict=True):
        place.nth(field).fill(f"{value / 0.0254:.2f}")
        place.nth(field).press("Enter")
    shown.says("holds 1 and 2 overlap")
    shown.press("Plan")
    wait_for(shown, lambda: sum("overlap" in words for words in shown.errors()) == 2)  # beside the pegs and beside Plan
    shown.picture("board-overlaps")

    shown.press("as it was")
    wait_for(shown, lambda: not board.draft.changed)
    for _ in range(3):
        shown.press("remove")
    shown.says("the board has no holds; it needs at least one")

    shown.press("as it was")
    wait_for(shown, lambda: not board.draft.changed)
    goal = shown.vector("goal [in]").nth(0)
    was = goal.input_value()
    goal.fill("900")
    goal.press("Enter")
    shown.says("from the nearest hold")
    shown.press("Run")
    shown.says("there is no plan to run")

    shown.press("as it was")
    wait_for(shown, lambda: goal.input_value() == was)  # else the page puts it back over what is typed
    goal.fill("26")  # within a limb's reach of peg 3, but no peg leads there
    goal.press("Enter")
    wait_for(shown, lambda: board.draft.changed)
    shown.page.get_by_label("reserves").uncheck()
    shown.press("Plan")
    shown.says("no plan. ")
    shown.picture("board-no-plan")
    shown.press("as it was")
    wait_for(shown, lambda: not board.draft.changed)
    shown.page.get_by_role("tab", name="Play").click()
    shown.says("Start")
    assert shown.wrong == []


@pytest.mark.long
def test_work_is_stopped_by_a_click(serve: Serve, visit: Open, compiled: None) -> None:
    app = serve(open_exhibit(["h"]))
    shown = visit(app.url)
    shown.page.get_by_role("tab", name="Board").click()
    shown.press("Plan")
    shown.page.get_by_role("button", name="Stop", exact=True).click()
    shown.says("stopped")
    assert app.work is not None and not app.work.background_task.busy
    assert shown.wrong == []


@pytest.mark.long
def test_page_on_the_disk_needs_nothing_else(tmp_path: Path, visit: Open) -> None:
    page = tmp_path / "page.html"
    write_page(open_exhibit(["ladder-hand"]), page)
    shown = visit(page.as_uri())
    panel = shown.page.locator("#clamber")
    panel.locator("li").nth(12).click()
    wait_for(shown, lambda: panel.get_attribute("data-step") == "12")
    before = shown.picture("page-step-12")
    panel.locator("li").nth(40).click()
    wait_for(shown, lambda: panel.get_attribute("data-step") == "40")
    assert shown.picture("page-step-40") != before
    shown.press("Hide panel")
    assert not panel.is_visible()
    assert shown.wrong == []
    assert [url for url in shown.asked if not url.startswith(("blob:", "data:"))] == [page.as_uri()]
