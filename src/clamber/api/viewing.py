"""Open the viewer in the browser on whatever the other functions answer."""

import webbrowser
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..errors import OptionError
from ..planning.problem.plan import Plan
from ..planning.result import PlanResult
from ..trials.dynamics import CarriedOut
from ..viewing.alone import alone_of
from ..viewing.browser.app import LOOPBACK, App
from ..viewing.browser.viewer_content import ViewerContent, alone_exhibit, exhibit_of, open_exhibit, run_exhibit
from .options import check_kind


def view(*what: Any, task: str | None = None, port: int = 0, expose: str | None = None, browser: bool = True) -> App:
    """Look at a robot, a world, a task, a plan, a walk, a run or a log in the browser, until it is closed or Python ends.

    Args:
        what: What the other functions gave, or a name or file; or the file of a log, and what it was made with.
        task: In which a plan's file is shown, in place of its own.
        port: Where the page is served from; 0: any port that is free.
        expose: An address to listen on, so that other machines can open the page; None: this machine alone can.
        browser: Whether to open the page in the browser.

    Returns:
        The open viewer: `url`, `close()`, `wait()` until Ctrl-C; it closes itself as a context (`with clamber.view(...)`).

    Raises:
        MissingViserError: If the extra `view` is not installed.
        ClamberError: If it cannot be shown, or the port is taken.
    """
    check_kind("port", port, int)
    exhibit = exhibit_for(what, task)
    app = App(exhibit, LOOPBACK if expose is None else expose, port)
    if browser:
        webbrowser.open(app.url)
    return app


def exhibit_for(what: Sequence[Any], task: str | None = None) -> ViewerContent:
    """What the viewer shows of names, files and answers.

    Raises:
        OptionError: If it can't be shown.
        ClamberError: As `open_exhibit`.
    """
    if what and all(isinstance(each, str | Path) for each in what):
        return open_exhibit([str(each) for each in what], task)
    if len(what) != 1:
        raise OptionError(
            "what",
            f"{len(what)} things are given",
            "one can be shown at a time; the file of a log may be beside a name",
        )
    one = what[0]
    if isinstance(one, CarriedOut):
        return run_exhibit(one)
    if isinstance(one, PlanResult):
        return exhibit_of(one.task, one.plan)
    if isinstance(one, Plan):
        return exhibit_of(one.rebuild_task(), one)
    if hasattr(one, "document"):
        return exhibit_of(one)
    alone = alone_of(one)
    if alone is None:
        allowed = "give a robot, a world, a task, a plan, a walk or a run"
        raise OptionError.of_value("what", one, "cannot be shown", allowed)
    return alone_exhibit(alone)
