"""Visits to the pages of reports in a real browser."""

from collections.abc import Callable, Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from page_pictures import take_picture


class Links(HTMLParser):
    """What a page names in `href` and `src`, and its ids."""

    def __init__(self) -> None:
        super().__init__()
        self.links: list[str] = []
        self.ids: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name in ("href", "src") and value is not None:
                self.links.append(value)
            if name == "id" and value is not None:
                self.ids.add(value)


@pytest.fixture
def visit(chromium: Any) -> Iterator[Callable[..., Any]]:
    """Opens a page from the disk in a browser that is offline: no warning on its console, every picture loaded, every link there."""
    contexts = []

    def open_page(path: Path, picture: str, *, width: int = 1100, dark: bool = False) -> Any:
        messages: list[str] = []
        context = chromium.new_context(
            viewport={"width": width, "height": 900}, color_scheme="dark" if dark else "light", offline=True
        )
        contexts.append(context)
        page = context.new_page()
        page.on("console", lambda message: messages.append(message.text) if message.type != "log" else None)
        page.on("pageerror", lambda error: messages.append(str(error)))
        page.on("requestfailed", lambda request: messages.append(f"failed: {request.url}"))
        page.goto(path.as_uri())
        page.wait_for_load_state("load")
        assert messages == []
        widths = page.eval_on_selector_all("img", "all => all.map(one => one.naturalWidth)")
        assert all(width > 0 for width in widths)
        check_links(path)
        take_picture(page, picture)
        return page

    yield open_page
    for context in contexts:
        context.close()


def check_links(path: Path) -> None:
    page = Links()
    page.feed(path.read_text(encoding="utf-8"))
    for link in page.links:
        if link.startswith("data:"):
            continue
        file, _, place = link.partition("#")
        target = (path.parent / file).resolve() if file else path
        assert target.is_file(), f"{path.name} names {link}"
        if place:
            there = Links()
            there.feed(target.read_text(encoding="utf-8"))
            assert place in there.ids, f"{path.name} names {link}"
