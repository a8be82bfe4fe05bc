"""`clamber study`: a paper's published results, ours beside the printed ones."""

from pathlib import Path
from typing import Annotated

import typer

from .crew import EndsLine, check_resume, executor_of
from .options import AsJson, Resume, Store, Workers
from .output import announce_compilation, print_json, stderr, stdout


def study(
    paper: Annotated[str, typer.Argument(help="A paper or subject (`clamber list studies`).")],
    result: Annotated[str | None, typer.Argument(help="One of its results; all unless given.")] = None,
    as_json: AsJson = False,
    report: Annotated[Path | None, typer.Option(metavar="DIR", help="Write tables and pictures there.")] = None,
    seeds: Annotated[int | None, typer.Option(min=1, help="Trials of a result of seeds, such as table-4-2.")] = None,
    workers: Workers = None,
    store: Store = None,
    resume: Resume = False,
) -> None:
    """Repeat what a paper reports, and say for each result whether it holds."""
    from ..errors import UnknownNameError
    from ..studies.library import SEEDED, STUDIES, first_loop
    from .study_text import print_results

    if paper not in STUDIES:
        raise UnknownNameError("study", paper, tuple(STUDIES))
    if result is not None and result not in STUDIES[paper]:
        raise UnknownNameError(f"result of '{paper}'", result, tuple(STUDIES[paper]))
    if (seeds is not None or store is not None or workers is not None) and result not in SEEDED:
        raise typer.BadParameter(f"is for {', '.join(SEEDED)}", param_hint="--seeds, --workers, --store")
    check_resume(resume, store)
    results = []
    for chosen in STUDIES[paper] if result is None else (result,):
        announce_compilation(first_loop(STUDIES[paper][chosen]))
        stderr().print(f"working on {chosen}")
        if chosen in SEEDED and result is not None:
            results.append(
                SEEDED[chosen](
                    **({} if seeds is None else {"seeds": seeds}), executor=executor_of(None, workers), store=store,
                    resume=resume, progress=EndsLine(stderr(), "trials", quiet=False).update,
                )
            )  # fmt: skip
        else:
            results.append(STUDIES[paper][chosen]())
    if report is not None:
        from ..studies.report import write_report

        write_report(results, report)
    if as_json:
        told = [one.to_json() for one in results]
        print_json(told if result is None else told[0])
    else:
        print_results(stdout(), results)
