"""`clamber view`: it serves this machine alone unless told otherwise, ends by itself, and names what is wrong."""

import importlib.abc
import json
import re
import socket
import sys
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from unittest.mock import patch
from urllib.parse import urlsplit

import pytest
import viser
import websockets.asyncio.server
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect
from websockets.typing import Origin, Subprotocol

Clamber = Callable[..., tuple[int, str, str]]


def test_page_is_served_and_ends(clamber: Clamber, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    code, out, err = clamber("view", "ladder", "--seconds", "0")
    assert code == 0
    (url,) = opened
    assert re.fullmatch(r"http://127\.0\.0\.1:\d+/\?token=[\w-]{22}", url)
    assert out == f"LIBRA climbs a ladder of pegs\n{url}  (Ctrl-C ends it)\n"
    assert "expose" not in err


def test_json_says_where_the_page_is(clamber: Clamber) -> None:
    code, out, _ = clamber("view", "ladder", "--no-browser", "--seconds", "0", "--json")
    assert code == 0
    assert json.loads(out).keys() == {"url", "title"}


def test_page_answers_on_loopback(monkeypatch: pytest.MonkeyPatch) -> None:
    from clamber.viewing.browser.app import App
    from clamber.viewing.browser.viewer_content import open_exhibit

    app = App(open_exhibit(["gap"]))
    try:
        assert app.server.get_host() == "127.0.0.1"
        with urllib.request.urlopen(app.url, timeout=10.0) as page:
            assert b"<html" in page.read()
    finally:
        app.close()


@pytest.fixture(params=["127.0.0.1", "0.0.0.0"])
def opened(request: pytest.FixtureRequest) -> Iterator[tuple[str, str, str]]:
    """A viewer, for this machine and exposed: its host with port, its token, the cookie that its page sets."""
    from clamber.viewing.browser.app import App
    from clamber.viewing.browser.viewer_content import open_exhibit

    app = App(open_exhibit(["gap"]), host=request.param)
    try:
        parts = urlsplit(app.url)
        with urllib.request.urlopen(app.url, timeout=10.0) as page:
            yield parts.netloc, parts.query.removeprefix("token="), page.headers["Set-Cookie"].partition(";")[0]
    finally:
        app.close()


def test_a_page_with_the_token_gets_through_by_its_cookie_and_others_do_not(opened: tuple[str, str, str]) -> None:
    place, token, cookie = opened
    own, page = f"http://{place}", f"ws://{place}/"
    for uri, origin, headers in (
        (page, own, {"Cookie": cookie}),
        (f"{page}?token={token}", own, {}),
    ):
        with connect(uri, origin=Origin(origin), additional_headers=headers, subprotocols=[version()]) as line:
            assert line.recv(timeout=30.0), "the scene"
    for uri, origin, headers in (
        (page, own, {}),
        (page, own, {"Cookie": cookie[:-1] + "-"}),
        (f"{page}?token={token[:-1]}", own, {}),
        (f"{page}?token={token}", None, {}),
        (page, None, {"Cookie": cookie}),
        (page, "http://evil.example", {"Cookie": cookie}),
        (page, "null", {"Cookie": cookie}),
        (page, f"{own}0", {"Cookie": cookie}),
    ):
        with pytest.raises(InvalidStatus, match="403"):
            connect(uri, origin=None if origin is None else Origin(origin), additional_headers=headers)
    for path in ("/", "/?token=", f"/?token={token}x", "/assets/../index.html"):
        with pytest.raises(urllib.error.HTTPError, match="403"):
            urllib.request.urlopen(own + path, timeout=10.0)


def version() -> Subprotocol:
    """What viser's own page asks for."""
    return Subprotocol(f"viser-v{viser.__version__}")


def test_a_name_of_others_that_leads_to_this_machine_is_refused() -> None:
    from clamber.viewing.browser.app import App
    from clamber.viewing.browser.viewer_content import open_exhibit

    app = App(open_exhibit(["gap"]))
    try:
        with pytest.raises(urllib.error.HTTPError, match="403"):
            urllib.request.urlopen(urllib.request.Request(app.url, headers={"Host": "rebound.example"}), timeout=10.0)
    finally:
        app.close()


def test_where_the_library_takes_no_guard_nothing_is_served(clamber: Clamber, monkeypatch: pytest.MonkeyPatch) -> None:
    plain = websockets.asyncio.server.serve

    class Changed(viser.ViserServer):  # a release that gets its server elsewhere
        def __init__(self, **options: Any) -> None:
            with patch.object(websockets.asyncio.server, "serve", plain):
                super().__init__(**options)

    monkeypatch.setattr(viser, "ViserServer", Changed)
    code, out, err = clamber("view", "ladder", "--no-browser", "--seconds", "0")
    assert code == 2 and not out
    assert "the viewer is not started, for its page is answered without a token" in err
    assert websockets.asyncio.server.serve is plain, "all later viewers would be answered by the guard of this one"


def test_a_guard_that_refuses_its_own_page_is_told_before_it_is_opened() -> None:
    from clamber.viewing.browser.app import guarded_server
    from clamber.viewing.browser.own_pages import Guard, UnguardedError, guarded

    with guarded(Guard(0)), pytest.raises(UnguardedError, match="its page is not answered with its token"):
        guarded_server("127.0.0.1", Guard(0))  # what another one guards, too


def test_exposing_is_warned_of(clamber: Clamber) -> None:
    code, _, err = clamber("view", "ladder", "--no-browser", "--seconds", "0", "--expose", "127.0.0.1")
    assert code == 0
    assert "has the address below, with its token" in err


def test_port_in_use_is_bad_input(clamber: Clamber) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        code, _, err = clamber("view", "ladder", "--no-browser", "--seconds", "0", "--port", str(port))
    assert code == 2
    assert f"cannot listen on 127.0.0.1, port {port}" in err


def test_host_that_is_not_ours_is_bad_input(clamber: Clamber) -> None:
    code, _, err = clamber("view", "ladder", "--no-browser", "--seconds", "0", "--expose", "192.0.2.1")
    assert code == 2
    assert "cannot listen on 192.0.2.1" in err


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("nowhere.json",), "nowhere.json"),
        (("laddr",), "no plan, task, walk, robot, board, world or ground is called 'laddr'"),
        (("ladder", "h"), "one can be shown at a time"),
        (("nowhere.mcap",), "nowhere.mcap: does not exist"),
        (("ladder", "--save", "page.png"), "no picture can be written as '.png'"),
    ],
)
def test_bad_input_is_named(clamber: Clamber, words: tuple[str, ...], told: str) -> None:
    code, _, err = clamber("view", *words, "--no-browser", "--seconds", "0")
    assert code == 2
    assert told in err and "Traceback" not in err


def test_missing_package_is_named(clamber: Clamber, monkeypatch: pytest.MonkeyPatch) -> None:
    class Absent(importlib.abc.MetaPathFinder):
        def find_spec(self, name: str, path: object = None, target: object = None) -> None:
            if name == "viser":
                raise ModuleNotFoundError(name)

    for name in [name for name in sys.modules if name.split(".")[0] == "viser"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(sys, "meta_path", [Absent(), *sys.meta_path])
    code, _, err = clamber("view", "ladder")
    assert code == 2
    assert 'pip install ".[view]"' in err


def test_saved_page_is_whole_and_names_no_other(clamber: Clamber, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    code, out, _ = clamber("view", "gap", "--save", str(page))
    assert code == 0
    assert out == f"written to {page}\n"
    text = page.read_text(encoding="utf-8")
    assert "__VISER_EMBED_DATA__" in text
    assert not re.search(r"""(src|href)=["']https?:""", text)
