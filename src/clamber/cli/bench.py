"""`clamber bench`: measure speed and success, beside peers."""

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from .options import AsJson, Output
from .output import announce_compilation, print_json, stderr, stdout


def bench(
    name: Annotated[str | None, typer.Argument(help="One benchmark; all unless given.")] = None,
    workers: Annotated[int | None, typer.Option(min=1, help="Processes for 'boards'; one a core unless given.")] = None,
    store: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Keep each trial of 'boards' as it ends (SQLite).")
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with --store: what is finished stays.")] = False,
    output: Output = None,
    as_json: AsJson = False,
) -> None:
    """Measure speed and success, ours beside those of peers; `boards` is every planner on the benchmark set."""
    from ..errors import UnknownNameError
    from ..experiments.benches import BENCHES
    from .study_text import print_rows

    if name is not None and name not in BENCHES:
        raise UnknownNameError("benchmark", name, tuple(BENCHES))
    if resume and store is None:
        raise typer.BadParameter("needs --store, the file to go on with", param_hint="--resume")
    announce_compilation("rollout")
    if name == "boards":
        from .bench_boards import bench_boards

        bench_boards(workers=workers, store=store, resume=resume, output=output, as_json=as_json)
        return
    if workers or store or output:
        raise typer.BadParameter(
            "only `bench boards` takes --workers, --store and --output", param_hint=name or "bench"
        )
    rows = []
    for chosen in BENCHES if name is None else (name,):
        stderr().print(f"measuring {chosen}")
        rows += BENCHES[chosen](say=partial(stderr().print, style="dim"))
    if as_json:
        print_json([row.to_json() for row in rows])
    else:
        print_rows(stdout(), rows)
