"""The options of `clamber plan`, and which of them the chosen planner takes."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from ...planning.planners import USUAL_PLANNER as USUAL
from ...terminal.name_completion import names_of
from ...terminal.options import AsJson, Output, Overrides, Quiet, Ray, Workers
from ...terminal.output import check_writable

if TYPE_CHECKING:
    from ...tasks import Task

PROFILE: Final = "default"
"""Settings of the genetic planner, unless a profile is named."""
EVALUATIONS: Final = 50_000
"""Whole plans that it tries, unless told."""


@dataclass(frozen=True, slots=True)
class PlanOptions:
    """Options of `clamber plan`, as they came."""

    planner: Annotated[
        str | None,
        typer.Option(
            help="How to search (`clamber list planners`); auto, unless an option asks for another.",
            autocompletion=names_of("planners"),
        ),
    ] = None
    to_run: Annotated[
        bool, typer.Option("--to-run", help="Plan as `clamber run` does: with room for what happens on the way.")
    ] = False
    profile: Annotated[str, typer.Option(help="The planner's settings: default, or thesis.")] = PROFILE
    overrides: Overrides = None
    seed: Annotated[int, typer.Option(min=0, help="Same seed, same plan, on any number of threads.")] = 0
    threads: Annotated[int | None, typer.Option(min=1, help="Threads; one a core unless given.")] = None
    evaluations: Annotated[int, typer.Option(min=1, help="Most whole plans to try.")] = EVALUATIONS
    checks: Annotated[
        int | None, typer.Option(min=1, help="Most single actions to judge, for planners that count them.")
    ] = None
    seconds: Annotated[float | None, typer.Option(min=0.0, help="Most time to take.")] = None
    checkpoint: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the state of the search here, and go on from it.")
    ] = None
    macros: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Learned modules to add (`clamber learn -o`).")
    ] = None
    minimize: Annotated[
        str | None,
        typer.Option(
            metavar="COSTS",
            help="Of the exact planner, the first one first: length; energy, torque of climbers; time, strain of walkers.",
        ),
    ] = None
    pareto: Annotated[
        str | None, typer.Option(metavar="COST,COST", help="Every plan that no other beats in both of two costs.")
    ] = None
    stances: Annotated[
        int | None, typer.Option(min=1, help="Most stances that exact searches keep (8 million: 2 GB).")
    ] = None
    width: Annotated[int | None, typer.Option(min=1, help="Stances that a beam keeps of each layer.")] = None
    islands: Annotated[
        int | None, typer.Option(min=1, help="Genetic populations at once, each in a worker; the shortest plan wins.")
    ] = None
    workers: Workers = None
    ray: Ray = None
    history: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw how the fitness grew (png, svg, pdf).")] = (
        None
    )
    openings: Annotated[
        bool, typer.Option(help="Where no plan is proved: look for the smallest changes of the task that open it.")
    ] = True
    openings_seconds: Annotated[float, typer.Option(min=0.0, help="Most time for that.")] = 60.0
    codes: Annotated[
        bool, typer.Option("--codes", help="Print all of the plan, in the thesis's numbers where it has some.")
    ] = False
    output: Output = None
    as_json: AsJson = False
    quiet: Quiet = False

    def check(self) -> None:
        """Make sure that files can be written before anything runs."""
        for file in (self.output, self.checkpoint, self.history):
            check_writable(file)
        if self.pareto is not None and self.chosen != "exact":
            raise typer.BadParameter(f"only the exact planner finds fronts, not {self.chosen}", param_hint="--pareto")

    @property
    def chosen(self) -> str:
        """The planner: the one that is named, else the one that the options are for, else the usual one."""
        if self.planner is not None:
            return self.planner
        if self.pareto or self.minimize or self.stances:
            return "exact"
        stated = self.profile != PROFILE or self.evaluations != EVALUATIONS
        genetic = (self.islands, self.history, self.checkpoint, self.macros, stated)
        return "genetic" if any(genetic) else "beam" if self.width else USUAL

    def planner_options(self, task: "Task") -> dict[str, Any]:
        """What the planner is told: what is usual as far as it takes it, and what was asked for.

        Raises:
            BadParameter: If the planner does not take what was asked for.
        """
        from ...planning.exact.costs import read_costs
        from ...planning.learning import load_macros
        from ...planning.planners import accepts

        usual = {
            "seed": self.seed,
            "seconds": self.seconds,
            "threads": self.threads,
            "profile": self.profile,
            "max_evaluations": self.evaluations,
        }
        stated = {
            "--checks": ("max_checks", self.checks),
            "--checkpoint": ("checkpoint", self.checkpoint),
            "--macros": ("macros", None if self.macros is None else load_macros(self.macros, task)),
            "--minimize": ("minimize", None if self.minimize is None else read_costs("--minimize", self.minimize)),
            "--stances": ("max_stances", self.stances),
            "--width": ("width", self.width),
        }
        options: dict[str, Any] = {name: value for name, value in usual.items() if accepts(self.chosen, name)}
        for flag, (name, value) in stated.items():
            if value is None:
                continue
            if not accepts(self.chosen, name):
                raise typer.BadParameter(f"the {self.chosen} planner does not take it", param_hint=flag)
            options[name] = value
        if self.history is not None and self.chosen != "genetic":
            raise typer.BadParameter("only the genetic planner has one", param_hint="--history")
        if self.islands is None and (self.workers or self.ray):
            raise typer.BadParameter("are for --islands", param_hint="--workers, --ray")
        return options
