"""Viewers, and visits to them in a real browser."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from page_visits import Visit

from clamber.tasks import load_task
from clamber.viewing.browser.app import LOOPBACK, App
from clamber.viewing.browser.viewer_content import ViewerContent
from clamber.viewing.browser.work_panel import carry_out, make_plan


@pytest.fixture(scope="session")
def compiled() -> None:
    """Everything that plans and runs is compiled, so that no test waits for that while it waits for something else."""
    task = load_task("ladder", ["goal={ y_min = '9 in' }"])
    answer = make_plan(task, "auto", 600.0, lambda words, share=None: None, reserves=True)
    assert answer.plan is not None, answer.words
    carry_out(task, answer.plan, lambda words, share=None: None)


@pytest.fixture
def visit(chromium: Any) -> Iterator[Callable[[str], Visit]]:
    """Opens a page; a page on the disk is opened offline."""
    contexts = []

    def open_page(address: str) -> Visit:
        context = chromium.new_context(viewport={"width": 1000, "height": 700}, offline=address.startswith("file:"))
        contexts.append(context)
        visit = Visit(context.new_page())
        visit.page.goto(address)
        if not visit.draws(
            45.0
        ):  # a browser that draws by software has once in some thousand pages not begun to: as a user would
            visit.page.reload()
        assert visit.draws(75.0), (
            f"no canvas on {address}: the page says {visit.page.inner_text('body')!r}, its console {visit.wrong}"
        )
        return visit

    yield open_page
    for context in contexts:
        context.close()


@pytest.fixture
def serve() -> Iterator[Callable[..., App]]:
    """Opens a viewer."""
    apps = []

    def open_app(exhibit: ViewerContent, host: str = LOOPBACK, *, folder: Path = Path()) -> App:
        apps.append(App(exhibit, host, folder=folder))
        return apps[-1]

    yield open_app
    for app in apps:
        app.close()
