"""What the commands of `clamber limb` share: options, how they become a limb and its plant, and how a result is kept and printed."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer
from rich.console import Console

from ...terminal.name_completion import names_of
from ...terminal.options import ROBOT, AsJson, Flaws, FlawsChoice, Output, Quiet, Settings
from ...terminal.output import check_output, check_writable, print_json, stdout, tell_written
from ...terminal.worker_options import Batch, WorkerOptions
from ...viewing.text_table import plain_table

if TYPE_CHECKING:
    from ...limb_bench.result import BenchResult, Comparison
    from ...limb_bench.runner import Crew
    from ...sim.bench_limb import BenchLimb
    from ...sim.limb_flaws import LimbFlaws


class MatchChoice(StrEnum):
    """Which stiffness at the tip is made equal."""

    yy = "yy"
    mean = "mean"
    diagonal = "diagonal"
    none = "none"


Matched: TypeAlias = Annotated[
    MatchChoice,
    typer.Option("--match", help="Which tip stiffness laws without gains of their own share with the reference."),
]
Robot: TypeAlias = Annotated[str, typer.Option(help="A climber's name or file.", autocompletion=names_of("robots"))]
LimbName: TypeAlias = Annotated[str | None, typer.Option("--limb", help="Its limb, by name or from 1.")]
Plant: TypeAlias = Annotated[str, typer.Option(help="What simulates the limb.", autocompletion=names_of("plants"))]
Seed: TypeAlias = Annotated[
    int | None, typer.Option(min=0, help="Draw play, encoder phase, noise and model error (0 where they need one).")
]


@dataclass(frozen=True)
class LawWords:
    """Options that name laws and how they come by their gains, as they came."""

    controllers: Annotated[
        list[str] | None,
        typer.Option(
            "--controller",
            "-c",
            metavar="NAME[:KEY=VALUE,...]",
            help="A law, such as scct or jacobian-transpose:kp=1000,kd=100; repeat it. A usual set unless given.",
            autocompletion=names_of("controllers"),
        ),
    ] = None
    kp: Annotated[float | None, typer.Option(help="Stiffness of the reference law, in its unit.")] = None
    kd: Annotated[float | None, typer.Option(help="Damping of the reference law, in its unit.")] = None
    match: Matched = MatchChoice.yy
    reference: Annotated[
        str,
        typer.Option(
            metavar="NAME[:KEY=VALUE,...]", help="Law that is matched to.", autocompletion=names_of("controllers")
        ),
    ] = "scct"


@dataclass(frozen=True)
class LimbWords:
    """Options that name a limb and its plant, as they came."""

    robot: Robot = ROBOT
    limb: LimbName = None
    start: Annotated[
        str | None, typer.Option(metavar="X,Y", help="Where the tip starts in the limb's port frame, such as 22cm,0.")
    ] = None
    elbow: Annotated[str | None, typer.Option(metavar="+|-", help="Sign of the elbow's angle.")] = None
    flaws: Flaws = FlawsChoice.ideal
    settings: Settings = None

    def build_plant(self, seed: int | None = None, *, drawn: bool = False) -> "LimbFlaws":
        """The plant's properties; checked before anything else is looked at."""
        from ...limb_bench.bench_limb import load_geared
        from ...sim.flaw_texts import named_flaws, read_flaws

        base = named_flaws(self.flaws.value, load_geared(self.robot)[0])
        return read_flaws(base, self.settings or (), seed, drawn=drawn)

    def build_limb(self, flaws: "LimbFlaws", start: tuple[float, float] = (0.22, 0.0)) -> "BenchLimb":
        """The limb at its start, or at `start` where none is said."""
        from ...limb_bench.bench_limb import bench_limb, read_elbow
        from ...units import read_point

        at = start if self.start is None else read_point("start", self.start)
        return bench_limb(self.robot, self.limb, at, elbow=read_elbow(self.elbow), upright=flaws.upright)


@dataclass(frozen=True)
class NominalLimbWords(LimbWords):
    """The same, of a plant with the flaws of the robot's file unless others are said."""

    flaws: Flaws = FlawsChoice.nominal


@dataclass(frozen=True)
class FileWords:
    """How a comparison is kept and printed, as it came."""

    log: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Keep every tick of the first trial: .mcap, a channel a law; .csv, a file a law. `limb identify` reads both.",
        ),
    ] = None
    output: Output = None
    as_json: AsJson = False
    quiet: Quiet = False

    def check(self, *suffixes: str) -> None:
        """Make sure that the files can be written before anything runs; `suffixes` are allowed of the output beside those of pictures."""
        check_output(self.output, *suffixes)
        check_writable(self.log)
        if self.log is not None:
            from ...execution.log_files import check_log_suffix

            check_log_suffix(self.log)
            if self.output is not None and self.output.absolute() == self.log.absolute():
                raise typer.BadParameter("must be two files", param_hint="--output, --log")

    def tell(self, result: "Comparison", show: Callable[[Console], None]) -> None:
        """Write the files that are asked for, then print the result: as JSON, or by `show` and with the files' names."""
        if self.output is not None:
            result.write(self.output)
        logged: tuple[Path, ...] = ()
        if self.log is not None:
            from ...execution.log_files import write_logs

            logged = write_logs(result.logs(), self.log)
        if self.as_json:
            print_json(result.to_json())
            return
        show(stdout())
        tell_written(stdout(), self.output, *logged)


def crew_of(words: WorkerOptions, batch: Batch) -> "Crew":
    """Who works through the items of a batch."""
    from ...limb_bench.runner import Crew

    told, then = batch.line.update, batch.line.follow
    return Crew(executor=words.executor, store=batch.store, resume=words.resume, progress=told, then=then)


def tell_batch(
    result: "BenchResult", words: WorkerOptions, show: Callable[[Console], None], *also: Path | None
) -> None:
    """Write the output, then print the result: as JSON, or by `show` and with the names of the files, `also` first."""
    if words.output is not None:
        result.write(words.output)
    if words.as_json:
        print_json(result.to_json())
        return
    show(stdout())
    tell_written(stdout(), *also, words.output)


def show_table(
    console: Console, titles: Sequence[str], rows: Iterable[Sequence[str]], left: Sequence[str] | None = None
) -> None:
    """Print rows under titles; the columns in `left` hold words, the first one unless others are named, all others numbers."""
    words = titles[:1] if left is None else left
    table = plain_table(*titles, right=tuple(title for title in titles if title not in words))
    for row in rows:
        table.add_row(*row)
    console.print(table)


def shown(value: float | None, scale: float = 1.0, digits: int = 2) -> str:
    """A number of a table; a dash where there is none."""
    return "-" if value is None else f"{round(value * scale, digits) + 0.0:.{digits}f}"


def shown_place(place: Sequence[float]) -> str:
    """A place in mm."""
    return ", ".join(f"{round(1e3 * value, 3) + 0.0:g}" for value in place)
