"""`clamber study`: a paper's published results, ours beside the printed ones."""

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .crew import EndsLine, executor_of
from .name_completion import names_of
from .options import AsJson, Quiet, Resume, Store, Workers
from .output import announce_compilation, print_json, stderr, stdout

if TYPE_CHECKING:
    from ..studies.result import StudyResult
    from ..studies.site import StudySite

ALL = "all"


def results_of(context: typer.Context, incomplete: str) -> list[str]:
    """What completes the name of a result of the study that is named before it."""
    from ..studies.titles import RESULTS

    return [name for name in RESULTS.get(context.params.get("paper", ""), ()) if name.startswith(incomplete)]


def study(
    paper: Annotated[
        str,
        typer.Argument(
            help="A paper or subject (`clamber list studies`), or all.",
            autocompletion=names_of("studies", besides=("all",)),
        ),
    ],
    result: Annotated[
        str | None, typer.Argument(help="One of its results; all unless given.", autocompletion=results_of)
    ] = None,
    as_json: AsJson = False,
    report: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write a site there: DIR/index.html and a page for each result.")
    ] = None,
    markdown: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write Markdown pages and pictures there, as in docs/studies.")
    ] = None,
    seeds: Annotated[int | None, typer.Option(min=1, help="Trials of a result of seeds, such as table-4-2.")] = None,
    workers: Workers = None,
    store: Store = None,
    resume: Resume = False,
    quiet: Quiet = False,
) -> None:
    """Repeat what a paper reports, and say for each result whether it holds.

    A report of all takes hours: it is whole after every result, and --resume leaves out what it has from the same Clamber.
    """
    from ..errors import UnknownNameError
    from ..studies.library import SEEDED, STUDIES
    from .study_text import print_results

    if paper != ALL and paper not in STUDIES:
        raise UnknownNameError("study", paper, (*STUDIES, ALL))
    if paper == ALL and result is not None:
        raise typer.BadParameter(f"'{result}' is a result of one study: name it in place of 'all'")
    if result is not None and result not in STUDIES[paper]:
        raise UnknownNameError(f"result of '{paper}'", result, tuple(STUDIES[paper]))
    if (seeds is not None or store is not None or workers is not None) and result not in SEEDED:
        raise typer.BadParameter(f"is for {', '.join(SEEDED)}", param_hint="--seeds, --workers, --store")
    if resume and store is None and report is None:
        raise typer.BadParameter("needs --store or --report, what to go on with", param_hint="--resume")
    site = _open_site(report)
    wanted = [
        (name, one)
        for name in (STUDIES if paper == ALL else (paper,))
        for one in (STUDIES[name] if result is None else (result,))
        if not (resume and site is not None and site.has(name, one))
    ]
    results: list[StudyResult] = []
    for number, (name, chosen) in enumerate(wanted, start=1):
        announce_compilation(quiet=quiet)
        if not quiet:
            stderr().print(f"{number} of {len(wanted)}: working on {chosen}")
        began = time.perf_counter()
        if chosen in SEEDED and result is not None:
            results.append(
                SEEDED[chosen](
                    **({} if seeds is None else {"seeds": seeds}), executor=executor_of(None, workers), store=store,
                    resume=resume and store is not None, progress=EndsLine(stderr(), "trials", quiet=quiet).update,
                )
            )  # fmt: skip
        else:
            results.append(STUDIES[name][chosen]())
        if site is not None:
            site.add(results[-1], began)
    if markdown is not None:
        from ..studies.markdown import write_markdown

        write_markdown(results, markdown)
    if as_json:
        told = [one.to_json() for one in results]
        print_json(told if result is None else told[0] if told else None)
    else:
        print_results(stdout(), results)
        if site is not None:
            stdout().print(f"report: {site.index}", soft_wrap=True)


def _open_site(report: Path | None) -> "StudySite | None":
    """The site to write to, made before hours are spent on what goes into it."""
    if report is None:
        return None
    from ..studies.site import StudySite

    return StudySite(report)
