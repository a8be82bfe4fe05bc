"""`clamber view`: robots, plans and runs in the browser, in three dimensions."""

import time
from pathlib import Path
from typing import Annotated

import typer

from .name_completion import names_of
from .options import AsJson, Overrides
from .output import announce_compilation, check_writable, print_json, stderr, stdout


def view(
    things: Annotated[
        list[str],
        typer.Argument(
            metavar="TASK|PLAN|WALK|LOG...",
            help="A task, a plan or a log of a run (.mcap, .csv), by name or file; or a log and its plan.",
            autocompletion=names_of("tasks", "plans", "walks"),
        ),
    ],
    task: Annotated[
        str | None,
        typer.Option(help="Show a plan in this task, in place of its own.", autocompletion=names_of("tasks")),
    ] = None,
    overrides: Overrides = None,
    port: Annotated[int, typer.Option(min=0, max=65535, help="Where to listen; 0: any port that is free.")] = 0,
    expose: Annotated[
        str | None,
        typer.Option(
            metavar="HOST", help="Listen on this address, so that other machines can open the page; no password."
        ),
    ] = None,
    browser: Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page in the browser.")] = True,
    seconds: Annotated[
        float | None, typer.Option(min=0.0, help="Close after so long; without it, Ctrl-C does.")
    ] = None,
    save: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write one page (.html) that needs no server, and end.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Look at a robot in the browser: play plans and runs, edit a board, plan, and run.

    The page is served from this machine to this machine alone, unless --expose says otherwise.
    """
    check_writable(save)
    from ..viewing.browser.app import LOOPBACK, App, check_viser

    check_viser()
    announce_compilation()
    from ..viewing.browser.exhibit import open_exhibit

    exhibit = open_exhibit(things, task, overrides or ())
    if save is not None:
        from ..viewing.browser.page import write_page

        size = write_page(exhibit, save)
        if as_json:
            print_json({"written": str(save), "title": exhibit.title, "bytes": size})
        else:
            stdout().print(f"written to {save}", soft_wrap=True)
        return
    host = LOOPBACK if expose is None else expose
    if expose is not None:
        stderr().print(
            f"--expose: whoever reaches {host} can open this page, and plan and run with it; there is no password"
        )
    app = App(exhibit, host, port)
    try:
        if as_json:
            print_json({"url": app.url, "title": exhibit.title})
        else:
            stdout().print(f"{exhibit.title}\n{app.url}  (Ctrl-C ends it)")
        if browser:
            import webbrowser

            webbrowser.open(app.url)
        began = time.monotonic()
        while seconds is None or time.monotonic() - began < seconds:
            time.sleep(0.2 if seconds is None else min(0.2, max(seconds - (time.monotonic() - began), 0.001)))
    except KeyboardInterrupt:
        pass  # the usual end
    finally:
        app.close()
