"""`clamber view`: robots, plans and runs in the browser, in three dimensions."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..interrupts import answer
from ..json_form import Count, Key
from ..terminal.live_line import LiveLine
from ..terminal.name_completion import names_of
from ..terminal.options import AsJson, Overrides, Quiet, takes_options
from ..terminal.output import check_writable, print_json, stderr, stdout, tell_written

if TYPE_CHECKING:
    from ..viewing.browser.app import App
    from ..viewing.browser.viewer_content import ViewerContent


@dataclass(frozen=True, slots=True)
class ViewOptions:
    """Options of `clamber view`, as they came."""

    task: Annotated[
        str | None,
        typer.Option(help="Show a plan in this task, in place of its own.", autocompletion=names_of("tasks")),
    ] = None
    overrides: Overrides = None
    port: Annotated[int, typer.Option(min=0, max=65535, help="Where to listen; 0: any port that is free.")] = 0
    expose: Annotated[
        str | None,
        typer.Option(
            metavar="HOST",
            help="Listen on this address, so that other machines can open the page by its whole address.",
        ),
    ] = None
    browser: Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page in the browser.")] = True
    seconds: Annotated[float | None, typer.Option(min=0.0, help="Close after so long; without it, Ctrl-C does.")] = None
    save: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", "--save", metavar="FILE", help="Write one page (.html) that needs no server, and end."
        ),
    ] = None
    as_json: AsJson = False
    quiet: Quiet = False


@dataclass(frozen=True, slots=True)
class Opened:
    """Printed once the viewer listens."""

    url: str
    title: str


@dataclass(frozen=True, slots=True)
class Saved:
    """`--output`: a page that was written."""

    written: Annotated[Path, Key(kind=str)]
    title: str
    bytes: Count


@takes_options
def view(
    things: Annotated[
        list[str],
        typer.Argument(
            metavar="TASK|PLAN|WALK|LOG|ROBOT|BOARD...",
            help="A task, plan, walk, robot, board, ground or log (.mcap, .csv), by name or file; or a log and what it was made with.",
            autocompletion=names_of("tasks", "plans", "walks", "robots", "boards", "grounds"),
        ),
    ],
    *,
    words: ViewOptions,
) -> None:
    """Look at a robot in the browser: play plans and runs, edit a board or a ground, plan, and run.

    The page is served from this machine to this machine alone, unless --expose says otherwise.
    """
    check_writable(words.save)
    if words.save is not None:
        _save(things, words, words.save)
        return
    exhibit = _opened(things, words)
    from ..viewing.browser.app import LOOPBACK, App

    host = LOOPBACK if words.expose is None else words.expose
    if words.expose is not None:
        stderr().print(
            f"--expose: whoever reaches {host} and has the address below, with its token, can open this page, and plan and run with it; "
            "nothing is encrypted",
            soft_wrap=True,
        )
    app = App(exhibit, host, words.port)
    try:
        _serve(app, words)
    except KeyboardInterrupt:
        answer()  # the usual end
    finally:
        app.close()


def _opened(things: list[str], words: ViewOptions) -> "ViewerContent":
    from ..viewing.browser.app import check_viser

    check_viser()
    from ..viewing.browser.viewer_content import open_exhibit

    return open_exhibit(things, words.task, words.overrides or ())


def _save(things: list[str], words: ViewOptions, path: Path) -> None:
    with LiveLine(stderr(), quiet=words.quiet, doing=f"preparing {path.name}") as line:
        exhibit = _opened(things, words)
        from ..viewing.browser.page import write_page

        size = write_page(exhibit, path, line.counting("picture"))
    if words.as_json:
        print_json(Saved(path, exhibit.title, size))
    else:
        tell_written(stdout(), path)


def _serve(app: "App", words: ViewOptions) -> None:
    """Tell where the page is, and wait for its end."""
    title = app.exhibit.title
    if words.as_json:
        print_json(Opened(app.url, title))
    else:
        stdout().print(f"{title}\n{app.url}  (Ctrl-C ends it)", soft_wrap=True)
    if words.browser:
        import webbrowser

        webbrowser.open(app.url)
    app.wait(words.seconds)
