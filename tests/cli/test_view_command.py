"""`clamber view`: it serves this machine alone unless told otherwise, ends by itself, and names what is wrong."""

import importlib.abc
import json
import re
import socket
import sys
import urllib.request
from collections.abc import Callable
from pathlib import Path

import pytest

Clamber = Callable[..., tuple[int, str, str]]


def test_page_is_served_and_ends(clamber: Clamber, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    code, out, err = clamber("view", "ladder", "--seconds", "0")
    assert code == 0
    (url,) = opened
    assert re.fullmatch(r"http://127\.0\.0\.1:\d+", url)
    assert out == f"LIBRA climbs a ladder of pegs\n{url}  (Ctrl-C ends it)\n"
    assert "expose" not in err


def test_json_says_where_the_page_is(clamber: Clamber) -> None:
    code, out, _ = clamber("view", "ladder", "--no-browser", "--seconds", "0", "--json")
    assert code == 0
    assert json.loads(out).keys() == {"url", "title"}


def test_page_answers_on_loopback(monkeypatch: pytest.MonkeyPatch) -> None:
    from clamber.viewing.browser.app import App
    from clamber.viewing.browser.exhibit import open_exhibit

    app = App(open_exhibit(["gap"]))
    try:
        assert app.server.get_host() == "127.0.0.1"
        with urllib.request.urlopen(app.url, timeout=10.0) as page:
            assert b"<html" in page.read()
    finally:
        app.close()


@pytest.mark.parametrize(("origin", "answer"), [("http://evil.example", 403), (None, 101), ("own", 101)])
def test_pages_of_others_are_refused(origin: str | None, answer: int) -> None:
    from clamber.viewing.browser.app import App
    from clamber.viewing.browser.exhibit import open_exhibit

    app = App(open_exhibit(["gap"]))
    try:
        port = app.server.get_port()
        with socket.create_connection(("127.0.0.1", port), timeout=10.0) as line:
            head = ["GET / HTTP/1.1", f"Host: 127.0.0.1:{port}", "Upgrade: websocket", "Connection: Upgrade"]
            head += ["Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==", "Sec-WebSocket-Version: 13"]
            head += [] if origin is None else [f"Origin: {app.url if origin == 'own' else origin}"]
            line.sendall(("\r\n".join(head) + "\r\n\r\n").encode())
            assert int(line.recv(1000).split()[1]) == answer
    finally:
        app.close()


def test_exposing_is_warned_of(clamber: Clamber) -> None:
    code, _, err = clamber("view", "ladder", "--no-browser", "--seconds", "0", "--expose", "127.0.0.1")
    assert code == 0
    assert "there is no password" in err


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
        (("laddr",), "no task, plan or walk is called 'laddr'"),
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
    assert 'pip install "clamber[view]"' in err


def test_saved_page_is_whole_and_names_no_other(clamber: Clamber, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    code, out, _ = clamber("view", "gap", "--save", str(page))
    assert code == 0
    assert out == f"written to {page}\n"
    text = page.read_text(encoding="utf-8")
    assert "__VISER_EMBED_DATA__" in text
    assert not re.search(r"""(src|href)=["']https?:""", text)
