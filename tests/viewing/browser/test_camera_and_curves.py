"""Views, a camera that follows, curves over time, pictures and videos; and bodies that never part from their limbs."""

import io
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest
from page_visits import Visit, wait_for
from PIL import Image

import clamber
from clamber.families.climber.trials.run_plan import climbing_flaws, climbing_task, run_plan
from clamber.planning.problem.plan import Plan
from clamber.planning.problem.plan_source import open_plan
from clamber.viewing.animation import RATE
from clamber.viewing.browser.app import App
from clamber.viewing.browser.camera_panel import MOST, encode, file_name, preset
from clamber.viewing.browser.curves import Curves
from clamber.viewing.browser.solids import Camera
from clamber.viewing.browser.viewer_content import ViewerContent, exhibit_of, run_exhibit
from clamber.viewing.recording import StillFilm

Serve = Callable[..., App]
Open = Callable[[str], Visit]
SHORT = {
    "ladder": ["goal={ y_min = '9 in' }"],
    "patch-walk": ["goal={ x_min = '5 cm' }"],
    "wall-gripper": [],
    "stones-quadruped": [],
}


def exhibit(name: str) -> ViewerContent:
    task = clamber.load_task(name, SHORT[name])
    return exhibit_of(task, None if not SHORT[name] else clamber.plan(task, "greedy").plan)


def planned(name: str) -> ViewerContent:
    """With some actions, whether or not they come to the goal."""
    task = clamber.load_task(name, SHORT[name])
    found = clamber.plan(task, "greedy" if SHORT[name] else "exact", **({} if SHORT[name] else {"max_stances": 300}))
    return exhibit_of(task, found.plan)


def ran() -> ViewerContent:
    """A plan and its run, together."""
    task = climbing_task(clamber.load_task("ladder"))
    codes = open_plan("ladder-hand").plan.codes(task)[:3]
    return run_exhibit(run_plan(task, Plan.of_codes(task, codes, planner="hand"), climbing_flaws(task, ())))


@pytest.mark.parametrize("shown", [*(partial(planned, name) for name in SHORT), ran], ids=[*SHORT, "a run"])
def test_all_that_moves_is_told_in_one_way(
    shown: Callable[[], ViewerContent], serve: Serve, monkeypatch: pytest.MonkeyPatch
) -> None:
    # the page draws a node's own pose in its next picture, and a batch's once React has drawn it: mixed, limbs came off bodies
    app = serve(shown())
    assert set(app.stage.films) == ({"plan", "run"} if shown is ran else {"plan"})
    told: list[str] = []
    server: Any = app.server._websock_server
    queue = server.queue_message
    monkeypatch.setattr(server, "queue_message", lambda message: (told.append(type(message).__name__), queue(message)))
    film = app.stage.main
    for time in np.linspace(0.0, film.seconds, 7):
        app.playback.seek(float(time))
    assert film.seconds > 0.0 and "SceneNodeUpdateMessage" in told
    assert not {"SetPositionMessage", "SetOrientationMessage"} & set(told)


def test_views_are_along_axes_and_as_far_away() -> None:
    home = Camera(np.array((-1.0, -3.0, 2.0)), np.array((0.5, 0.0, 1.0)))
    away = np.linalg.norm(home.position - home.look_at)
    ways = {name: preset(name, home) for name in ("home", "front", "side", "top")}
    assert ways["home"] is home
    for name, way in (("front", (0.0, -1.0, 0.0)), ("side", (1.0, 0.0, 0.0)), ("top", (0.0, 0.0, 1.0))):
        at = ways[name]
        assert np.array_equal(at.look_at, home.look_at)
        assert at.position - at.look_at == pytest.approx(away * np.array(way), abs=2e-3 * away)
    east = preset("front", Camera(np.array((3.0, 1.0, 0.0)), np.zeros(3)))
    assert east.position / np.linalg.norm(east.position) == pytest.approx((1.0, 0.0, 0.0))


def test_curves_are_the_values_of_the_bars() -> None:
    film = exhibit("ladder").main
    curves = Curves(film, 0)
    for k in (0, 100, 239):
        assert curves.values[k] == pytest.approx(np.abs(film.values(film.at(float(curves.times[k])))[0]))
    page = curves.html()
    assert page.count("<polyline") == len(film.gauges[0].names) and "oz-in" in page and "limit" in page
    assert curves.mark_html(film.seconds) != curves.mark_html(0.0)


def test_a_video_shows_all_of_a_film_in_so_many_pictures_at_most() -> None:
    film = StillFilm(None, "still", (), "a film")
    assert len(film.times(RATE, MOST)) == 2
    film.seconds, film.speed = 10.0, 2.0
    times = film.times(RATE, MOST)
    assert (times[0], times[-1], len(times)) == (0.0, 10.0, 76)
    film.seconds, film.speed = 1e5, 1.0
    assert len(film.times(RATE, MOST)) == 301
    suffix, content = encode([np.full((720, 1280, 3), k, np.uint8) for k in (0, 128, 255)])
    assert (suffix, content[4:8]) == (".mp4", b"ftyp") or (suffix, content[:3]) == (".gif", b"GIF")
    assert file_name("LIBRA climbs: a / ladder!") == "libra-climbs-a-ladder"


@pytest.mark.long
@pytest.mark.parametrize("name", ["ladder", "stones-quadruped"])
def test_a_page_looks_from_where_it_is_asked_to_follows_and_saves(name: str, serve: Serve, visit: Open) -> None:
    app = serve(exhibit(name))
    page = visit(app.url)
    (client,) = app.server.get_clients().values()
    home = app.stage.scenery.camera()
    for view in ("front", "top", "side"):
        page.press(view)
        at = preset(view, home)
        wait_for(page, lambda at=at: np.allclose(client.camera.position, at.position, atol=1e-3))
        assert client.camera.look_at == pytest.approx(at.look_at, abs=1e-3)
    page.page.get_by_role("checkbox", name="follow").click()
    wait_for(page, lambda: app.camera._follow.value)
    app.playback.seek(app.stage.main.seconds)
    middle = app.stage.middle
    assert middle is not None
    wait_for(page, lambda: np.allclose(client.camera.look_at, middle, atol=1e-3))
    page.picture(f"follows-{name}")
    for button, first in (("picture", b"\x89PNG"), ("video", None)):
        with page.page.expect_download() as coming:
            page.press(button)
        content = coming.value.path().read_bytes()
        if first is not None:
            assert content.startswith(first)
            colours = np.asarray(Image.open(io.BytesIO(content)).convert("RGB"))
            assert colours.shape == (720, 1280, 3) and len(np.unique(colours.reshape(-1, 3), axis=0)) > 100
        else:
            assert content[:3] == b"GIF" or content[4:8] == b"ftyp"
    assert not page.errors() and not page.wrong
