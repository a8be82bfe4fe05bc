"""What a saved board says is readable, and the page is called by what it shows."""

import gzip
import urllib.request
from collections.abc import Iterator

import pytest

from clamber.tasks import load_task
from clamber.viewing.browser.app import App
from clamber.viewing.browser.viewer_content import exhibit_of, open_exhibit


@pytest.fixture(scope="module")
def app() -> Iterator[App]:
    app = App(exhibit_of(load_task("ladder", ["board.holds.7.x=3in"])))
    yield app
    app.close()


def test_a_saved_board_has_readable_places(app: App) -> None:
    board = app.files("mine")["mine-board.toml"]
    assert "0.0762 m" in board
    assert "99999" not in board and "00000" not in board


@pytest.mark.parametrize("packed", ["gzip", "identity"])
def test_the_page_is_called_by_what_it_shows(app: App, packed: str) -> None:
    request = urllib.request.Request(app.url, headers={"Accept-Encoding": packed})
    with urllib.request.urlopen(request) as answer:
        page = answer.read()
    text = (gzip.decompress(page) if packed == "gzip" else page).decode("utf-8")
    assert f"<title>{app.exhibit.title} - Clamber</title>" in text
    assert "<title>Viser</title>" not in text


def test_a_robot_alone_is_called_by_its_own_title() -> None:
    app = App(open_exhibit(["libra"]))
    try:
        assert app.work is None
        assert "LIBRA" in app.guard.title
    finally:
        app.close()
