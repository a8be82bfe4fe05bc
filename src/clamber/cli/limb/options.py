"""Options that the commands of `clamber limb` share, and how they become a limb, a plant and laws."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, Protocol, TypeAlias

import typer
from rich.console import Console

from ..crew import EndsLine
from ..name_completion import names_of
from ..options import ROBOT, AsJson, Output, Quiet
from ..output import announce_compilation, check_writable, print_json, stderr, stdout

if TYPE_CHECKING:
    from ...control.law_settings import LawSettings
    from ...execution.log import Log as RunLog
    from ...limb_bench.bench_limb import BenchLimb
    from ...limb_bench.contest import Entry
    from ...limb_bench.scenario import Scenario
    from ...sim.limb_flaws import LimbFlaws
    from ...types import Floats, Json


LEAST_TRIALS: Final = 4
"""A worker process is worth its start for so many trials."""


class MatchChoice(StrEnum):
    """Which stiffness at the tip is made equal."""

    yy = "yy"
    mean = "mean"
    diagonal = "diagonal"
    none = "none"


class FlawsChoice(StrEnum):
    """Sets of a plant's properties."""

    ideal = "ideal"
    nominal = "nominal"


Controllers: TypeAlias = Annotated[
    list[str] | None,
    typer.Option(
        "--controller", "-c", metavar="NAME[:KEY=VALUE,...]",
        help="A law, such as scct or jacobian-transpose:kp=1000,kd=100; repeat it. A usual set unless given.",
        autocompletion=names_of("controllers"),
    ),
]  # fmt: skip
Kp: TypeAlias = Annotated[float | None, typer.Option(help="Stiffness of the reference law, in its unit.")]
Kd: TypeAlias = Annotated[float | None, typer.Option(help="Damping of the reference law, in its unit.")]
Matched: TypeAlias = Annotated[
    MatchChoice,
    typer.Option("--match", help="Which tip stiffness laws without gains of their own share with the reference."),
]
Reference: TypeAlias = Annotated[
    str,
    typer.Option(
        metavar="NAME[:KEY=VALUE,...]", help="Law that is matched to.", autocompletion=names_of("controllers")
    ),
]
Robot: TypeAlias = Annotated[
    str,
    typer.Option(help="A climber's name or file.", autocompletion=names_of("robots")),
]
LimbName: TypeAlias = Annotated[str | None, typer.Option("--limb", help="Its limb, by name or from 1.")]
Start: TypeAlias = Annotated[
    str | None, typer.Option(metavar="X,Y", help="Where the tip starts in the limb's port frame, such as 22cm,0.")
]
Elbow: TypeAlias = Annotated[str | None, typer.Option(metavar="+|-", help="Sign of the elbow's angle.")]
Plant: TypeAlias = Annotated[
    str,
    typer.Option(help="What simulates the limb.", autocompletion=names_of("plants")),
]
Flaws: TypeAlias = Annotated[
    FlawsChoice,
    typer.Option("--flaws", help="nominal: backlash, rate and encoders of the robot's file, one sample of delay."),
]
Settings: TypeAlias = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Change the plant, such as backlash=2deg or payload=0.3kg."),
]
Seed: TypeAlias = Annotated[
    int | None, typer.Option(min=0, help="Draw play, encoder phase, noise and model error (0 where they need one).")
]
Log: TypeAlias = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="Keep every tick of the first trial: .mcap, a channel a law; .csv, a file a law. `limb identify` reads both.",
    ),
]


@dataclass(frozen=True, slots=True)
class BenchWords:
    """Options of every command that compares laws by one motion of the limb, as they came."""

    controllers: Controllers = None
    kp: Kp = None
    kd: Kd = None
    match: Matched = MatchChoice.yy
    reference: Reference = "scct"
    robot: Robot = ROBOT
    limb: LimbName = None
    start: Start = None
    elbow: Elbow = None
    plant: Plant = "mujoco"
    flaws: Flaws = FlawsChoice.ideal
    settings: Settings = None
    seed: Seed = None
    trials: Annotated[int, typer.Option(min=1, help="Plants that are drawn, from the seed on.")] = 1
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes for the trials; one a core unless given, where there are many.")
    ] = None
    everything: Annotated[bool, typer.Option("--all", help="Print every measure, and the gains.")] = False
    log: Log = None
    output: Output = None
    as_json: AsJson = False
    quiet: Quiet = False

    def check(self) -> None:
        """Make sure that the files can be written before anything runs."""
        self.telling.check(".json", ".csv")

    @property
    def telling(self) -> "Telling":
        """How the comparison is to be told."""
        return Telling(self.output, self.log, self.as_json, self.quiet, self.everything)

    @property
    def crew(self) -> int:
        """Worker processes: as many as asked for, else one a core, but none for so few trials that its start takes longer."""
        return self.workers or max(1, min(os.cpu_count() or 1, self.trials // LEAST_TRIALS))

    def build_plant(self) -> "LimbFlaws":
        """The plant's properties; checked before anything else is looked at."""
        from ...limb_bench.bench_limb import limbed_robot
        from ...sim.flaw_texts import named_flaws, read_flaws

        base = named_flaws(self.flaws.value, limbed_robot(self.robot))
        return read_flaws(base, self.settings or (), self.seed, drawn=self.trials > 1)

    def build_limb(self, flaws: "LimbFlaws", start: tuple[float, float] = (0.22, 0.0)) -> "BenchLimb":
        """The limb at its start, or at `start` where none is said."""
        from ...limb_bench.bench_limb import bench_limb
        from ...limb_bench.points import read_elbow, read_point

        at = start if self.start is None else read_point("start", self.start)
        return bench_limb(self.robot, self.limb, at, elbow=read_elbow(self.elbow), upright=flaws.upright)

    def build_laws(self, limb: "BenchLimb", at: "Floats") -> "tuple[list[Entry], LawSettings]":
        """The entries, and the law that they were matched to at the joint angles `at`."""
        from ...limb_bench.entries import make_entries, reference_law

        reference = reference_law(self.reference, self.kp, self.kd)
        return make_entries(limb, self.controllers or (), reference, self.match.value, at), reference


class Told(Protocol):
    """A result that can be told."""

    def to_json(self) -> "Json":
        """As plain data."""

    def logs(self) -> "dict[str, RunLog]":
        """Label -> what happened, tick by tick."""


@dataclass(frozen=True, slots=True)
class Telling:
    """How a result is to be told."""

    output: Path | None
    log: Path | None
    as_json: bool
    quiet: bool
    everything: bool = False

    def check(self, *suffixes: str) -> None:
        """Make sure that the files can be written before anything runs; `suffixes` are allowed of the output beside those of pictures."""
        for path in (self.output, self.log):
            check_writable(path)
        if self.output is not None:
            from ...viewing.output import CANVASES, check_suffix

            check_suffix(self.output, (*suffixes, *CANVASES))
        if self.log is not None:
            from ...execution.log_files import check_log_suffix

            check_log_suffix(self.log)
            if self.output is not None and self.output.absolute() == self.log.absolute():
                raise typer.BadParameter("must be two files", param_hint="--output, --log")

    def tell(self, result: Told, write: Callable[[Path], None], show: Callable[[Console], None]) -> None:
        """Write the files that are asked for, then print the result: as JSON, or by `show` and with the files' names."""
        if self.output is not None:
            write(self.output)
        logged: tuple[Path, ...] = ()
        if self.log is not None:
            from ...execution.log_files import write_logs

            logged = write_logs(result.logs(), self.log)
        if self.as_json:
            print_json(result.to_json())
            return
        console = stdout()
        show(console)
        for path in (*(() if self.output is None else (self.output,)), *logged):
            console.print(f"written to {path}", soft_wrap=True)


def run_bench(words: BenchWords, limb: "BenchLimb", scenario: "Scenario", flaws: "LimbFlaws") -> None:
    """Run the laws, write and print what came out, and leave with the exit code."""
    from ...limb_bench.entries import match_pose
    from ...limb_bench.result import compare_laws
    from .text import print_limb_result, write_limb_result

    announce_compilation(quiet=words.quiet)  # gains are matched by the laws themselves
    at = match_pose(limb, scenario)
    entries, reference = words.build_laws(limb, at)
    line = EndsLine(stderr(), "trials", quiet=words.quiet or words.trials == 1)
    result = compare_laws(
        limb, scenario, entries, flaws, plant=words.plant, trials=words.trials, workers=words.crew,
        match=words.match.value, reference=reference, match_at=at, progress=line.update,
    )  # fmt: skip
    words.telling.tell(
        result,
        lambda path: write_limb_result(result, path),
        lambda console: print_limb_result(console, result, everything=words.everything),
    )
    raise typer.Exit(0 if result.stable else 1)
