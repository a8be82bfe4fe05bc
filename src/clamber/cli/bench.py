"""`clamber bench`: measure speed and success, beside peers."""

import shlex
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from .crew import EndsLine, check_resume, executor_of
from .options import AsJson, Output, Ray, Resume, Store, Workers
from .output import announce_compilation, check_writable, print_json, stderr, stdout


def bench(
    names: Annotated[list[str] | None, typer.Argument(help="Benchmarks, in this order; all unless given.")] = None,
    workers: Workers = None,
    ray: Ray = None,
    store: Store = None,
    resume: Resume = False,
    output: Output = None,
    as_json: AsJson = False,
) -> None:
    """Measure speed and success, ours beside those of peers; seeds, ablation and boards are batches, with workers and a store.

    Leaves with 1 where a plant in real time stopped because the machine was too busy: that benchmark is left out.
    """
    check_resume(resume, store)
    from ..experiments.benches import BATCHED, BENCHES, run_bench
    from ..experiments.trials import Crew
    from .study_text import print_rows

    chosen = tuple(names or BENCHES)
    only = chosen[0] if len(chosen) == 1 else None
    _check_asked(chosen, only, batch=bool(workers or ray or store), own_crew=bool(workers or store), output=output)
    line = EndsLine(stderr(), "items", quiet=False)
    crew = Crew(executor=executor_of(ray, workers), store=store, resume=resume, progress=line.update)
    if ray is not None:
        crew.executor.check()
    if ray is None and only != "start":
        announce_compilation()
    if only == "boards":
        from .bench_boards import bench_boards

        bench_boards(crew, output=output, as_json=as_json)
        return
    from ..execution.plant import PlantStoppedError

    measured = {}
    for name in chosen:
        stderr().print(f"measuring {name}")
        try:
            measured[name] = run_bench(name, partial(stderr().print, style="dim"), crew if name in BATCHED else None)
        except PlantStoppedError as stop:
            stderr().print(f"{name} is left out: {stop}; is the machine too busy for a plant in real time?")
    rows = [row for each in measured.values() for row in each]
    if output is not None:
        from ..experiments.performance_page import performance_page
        from ..files import write_atomically

        write_atomically(
            output, performance_page(measured, shlex.join(("clamber", "bench", *chosen, "-o", str(output))))
        )
    if as_json:
        print_json(rows)
    else:
        print_rows(stdout(), rows)
    raise typer.Exit(0 if len(measured) == len(chosen) else 1)


def _check_asked(
    chosen: tuple[str, ...], only: str | None, *, batch: bool, own_crew: bool, output: Path | None
) -> None:
    from ..errors import UnknownNameError
    from ..experiments.benches import BATCHED, BENCHES

    for name in chosen:
        if name not in BENCHES:
            raise UnknownNameError("benchmark", name, tuple(BENCHES))
    if batch and only not in BATCHED:
        raise typer.BadParameter(f"are for one of {', '.join(BATCHED)}", param_hint="--workers, --ray, --store")
    if only == "jobs" and own_crew:
        raise typer.BadParameter(
            "measures workers and stores of its own; it takes --ray", param_hint="--workers, --store"
        )
    if output is not None and only != "boards":
        check_writable(output)
        if output.suffix.lower() != ".md":
            raise typer.BadParameter(
                f"{output}: a page is Markdown (.md); pictures are of `boards` alone", param_hint="--output"
            )
