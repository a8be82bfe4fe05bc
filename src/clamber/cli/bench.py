"""`clamber bench`: measure speed and success, beside peers."""

from functools import partial
from typing import Annotated

import typer

from .crew import check_resume
from .options import AsJson, Output, Ray, Resume, Store, Workers
from .output import announce_compilation, print_json, stderr, stdout


def bench(
    name: Annotated[str | None, typer.Argument(help="One benchmark; all unless given.")] = None,
    workers: Workers = None,
    ray: Ray = None,
    store: Store = None,
    resume: Resume = False,
    output: Output = None,
    as_json: AsJson = False,
) -> None:
    """Measure speed and success, ours beside those of peers.

    `boards` is every planner on the benchmark set; it alone takes --workers, --ray, --store, --resume and --output.
    """
    from ..errors import UnknownNameError
    from ..experiments.benches import BENCHES
    from .study_text import print_rows

    if name is not None and name not in BENCHES:
        raise UnknownNameError("benchmark", name, tuple(BENCHES))
    check_resume(resume, store)
    if name == "boards":
        from .bench_boards import bench_boards

        bench_boards(workers, ray, store=store, resume=resume, output=output, as_json=as_json)
        return
    if workers or ray or store or output:
        raise typer.BadParameter(
            "only `bench boards` takes --workers, --ray, --store and --output", param_hint=name or "bench"
        )
    announce_compilation("rollout")
    rows = []
    for chosen in BENCHES if name is None else (name,):
        stderr().print(f"measuring {chosen}")
        rows += BENCHES[chosen](say=partial(stderr().print, style="dim"))
    if as_json:
        print_json([row.to_json() for row in rows])
    else:
        print_rows(stdout(), rows)
