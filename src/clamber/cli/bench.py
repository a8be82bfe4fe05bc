"""`clamber bench`: measure speed and success, beside peers."""

from functools import partial
from typing import Annotated

import typer

from .crew import EndsLine, check_resume, executor_of
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
    """Measure speed and success, ours beside those of peers; seeds, ablation and boards are batches, with workers and a store."""
    check_resume(resume, store)
    from ..errors import UnknownNameError
    from ..experiments.benches import BATCHED, BENCHES, run_bench
    from ..experiments.trials import Crew
    from .study_text import print_rows

    if name is not None and name not in BENCHES:
        raise UnknownNameError("benchmark", name, tuple(BENCHES))
    if (workers or ray or store) and name not in BATCHED:
        raise typer.BadParameter(f"are for one of {', '.join(BATCHED)}", param_hint="--workers, --ray, --store")
    if output is not None and name != "boards":
        raise typer.BadParameter("is for boards: a picture or a table", param_hint="--output")
    if name == "jobs" and (workers or store):
        raise typer.BadParameter(
            "measures workers and stores of its own; it takes --ray", param_hint="--workers, --store"
        )
    line = EndsLine(stderr(), "items", quiet=False)
    crew = Crew(executor=executor_of(ray, workers), store=store, resume=resume, progress=line.update)
    if ray is not None:
        crew.executor.check()
    if ray is None and name != "start":
        announce_compilation(
            {"boards": "simulate", "control": "drive_at", "plant": "drive_at", "hexapod": "prepare"}.get(
                name or "", "rollout"
            )
        )
    if name == "boards":
        from .bench_boards import bench_boards

        bench_boards(crew, output=output, as_json=as_json)
        return
    rows = []
    for chosen in BENCHES if name is None else (name,):
        stderr().print(f"measuring {chosen}")
        rows += run_bench(chosen, partial(stderr().print, style="dim"), crew)
    if as_json:
        print_json([row.to_json() for row in rows])
    else:
        print_rows(stdout(), rows)
