"""`clamber study`: a paper's published results, ours beside the printed ones."""

import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer
from rich.console import Console

from ..interrupts import answer, passed_on
from ..studies.library import study_titles
from ..terminal.live_line import LiveLine
from ..terminal.name_completion import names_of
from ..terminal.options import AsJson, Quiet, Resume, Store, Workers, takes_options
from ..terminal.output import print_indented, print_json, stderr, stdout
from ..terminal.worker_options import EndsLine, executor_of, keeping
from ..viewing.text_table import plain_table

if TYPE_CHECKING:
    from ..studies.result import StudyResult, Verdict
    from ..studies.site import StudySite

ALL = "all"


def results_of(context: typer.Context, incomplete: str) -> list[str]:
    """What completes the name of a result of the study that is named before it."""
    from ..studies.library import STUDIES

    return [name for name in STUDIES.get(context.params.get("paper", ""), ()) if name.startswith(incomplete)]


@dataclass(frozen=True, slots=True)
class StudyOptions:
    """Options of `clamber study`, as they came."""

    as_json: AsJson = False
    report: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write a site there: DIR/index.html and a page for each result.")
    ] = None
    markdown: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write Markdown pages and pictures there, as in docs/studies.")
    ] = None
    seeds: Annotated[int | None, typer.Option(min=1, help="Trials of a result of seeds, such as table-4-2.")] = None
    workers: Workers = None
    store: Store = None
    resume: Resume = False
    quiet: Quiet = False

    def check(self, paper: str, result: str | None) -> None:
        """Make sure that there is such a study and such a result, and that the options are for them."""
        from ..errors import UnknownNameError
        from ..studies.library import SEEDED, STUDIES

        if paper != ALL and paper not in STUDIES:
            raise UnknownNameError("study", paper, (*STUDIES, ALL))
        if paper == ALL and result is not None:
            raise typer.BadParameter(f"'{result}' is a result of one study: name it in place of 'all'")
        if result is not None and result not in STUDIES[paper]:
            raise UnknownNameError(f"result of '{paper}'", result, tuple(STUDIES[paper]))
        if (self.seeds is not None or self.store is not None or self.workers is not None) and result not in SEEDED:
            raise typer.BadParameter(f"is for {', '.join(SEEDED)}", param_hint="--seeds, --workers, --store")
        if self.resume and self.store is None and self.report is None:
            raise typer.BadParameter("needs --store or --report, what to go on with", param_hint="--resume")


@takes_options
def study(
    paper: Annotated[
        str,
        typer.Argument(
            help="A paper or subject (`clamber list studies`), or all.",
            autocompletion=names_of(besides={"all": "", **study_titles()}),
        ),
    ],
    result: Annotated[
        str | None, typer.Argument(help="One of its results; all unless given.", autocompletion=results_of)
    ] = None,
    *,
    words: StudyOptions,
) -> None:
    """Repeat what a paper reports, and say for each result whether it holds.

    A report of all takes hours: it is whole after every result, and --resume leaves out what it has from the same Clamber.
    """
    from ..studies.library import STUDIES

    words.check(paper, result)
    site = _open_site(words.report)
    wanted = [
        (name, one)
        for name in (STUDIES if paper == ALL else (paper,))
        for one in (STUDIES[name] if result is None else (result,))
        if not (words.resume and site is not None and site.has(name, one))
    ]
    results: list[StudyResult] = []
    with StudyLine(stderr(), quiet=words.quiet) as line:
        try:
            for name, chosen in wanted:
                line.begin(chosen, results, len(wanted))
                began = time.perf_counter()
                with passed_on():
                    results.append(_repeat(name, chosen, words, seeded=result is not None))
                if site is not None:
                    site.add(results[-1], began)
        except KeyboardInterrupt:
            answer()
            line.say(f"interrupted in {chosen}")
    if words.markdown is not None:
        from ..studies.markdown import write_markdown

        write_markdown(results, words.markdown)
    if words.as_json:
        print_json(results if result is None else results[0] if results else None)
        return
    _print_results(stdout(), results, len(wanted))
    if site is not None:
        stdout().print(f"report: {site.index}", soft_wrap=True)


class StudyLine(LiveLine):
    """Follows results as they are repeated."""

    def begin(self, chosen: str, results: "Sequence[StudyResult]", total: int) -> None:
        """Show the one that is begun, and what became of those before."""
        told = f"{len(results) + 1} of {total}: working on {chosen}"
        before = f"; so far: {verdicts(results)}" if results else ""
        self.show(told + before, len(results) / total, now=True)


def verdicts(results: "Sequence[StudyResult]") -> str:
    """How many hold, and so on."""
    counts = Counter(result.verdict for result in results)
    return ", ".join(f"{counts[word]} {VERDICTS[word][counts[word] > 1]}" for word in VERDICTS if counts[word])


def _repeat(paper: str, result: str, words: StudyOptions, *, seeded: bool) -> "StudyResult":
    """One result; with `seeded`, one of trials with as many seeds as the options say."""
    from ..studies.library import SEEDED, STUDIES

    if not (seeded and result in SEEDED):
        return STUDIES[paper][result]()
    with keeping(words.store, EndsLine(stderr(), "trials", quiet=words.quiet)) as batch:
        return SEEDED[result](
            **({} if words.seeds is None else {"seeds": words.seeds}),
            executor=executor_of(None, words.workers),
            store=batch.store,
            resume=words.resume and words.store is not None,
            progress=batch.line.update,
        )


def _open_site(report: Path | None) -> "StudySite | None":
    """The site to write to, made before hours are spent on what goes into it."""
    if report is None:
        return None
    from ..studies.site import StudySite

    return StudySite(report)


VERDICTS: "Final[dict[Verdict, tuple[str, str]]]" = {
    "holds": ("holds", "hold"),
    "consistent": ("is consistent", "are consistent"),
    "differs": ("differs", "differ"),
    "open": ("is open", "are open"),
}
"""Verdict -> what is said of one result and of several."""
STYLES = {"holds": "bold green", "consistent": "bold cyan", "differs": "bold red", "open": "bold yellow"}
"""Verdict -> colour."""


def _print_results(console: Console, results: "Sequence[StudyResult]", asked: int) -> None:
    """Print how many results hold and which do not, then each one: verdict, claim, numbers, deviations."""
    if asked > 1:
        of = "" if len(results) == asked else f" of {asked}"
        console.print(f"{len(results)}{of} results: {verdicts(results) or 'none yet'}", style="bold")
        for word in ("differs", "open"):
            names = ", ".join(each.result for each in results if each.verdict == word)
            if names:
                print_indented(console, f"{word}: {names}")
        console.print()
    for result in results:
        console.print(f"{result.result}: {result.verdict}", style=STYLES[result.verdict])
        print_indented(console, f"claim: {result.claim}")
        table = plain_table("  number", "value", right=("value",))
        for name, value in result.numbers.items():
            table.add_row(f"  {name}", f"{value:.6g}" if isinstance(value, float) else str(value))
        console.print(table)
        for deviation in result.deviations:
            print_indented(console, f"deviation: {deviation}")
