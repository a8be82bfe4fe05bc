"""Options and arguments that several commands share."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated, Final, TypeAlias

import typer

from .name_completion import names_of

ROBOT: Final = "libra"
"""The climber of commands that are told of none."""
BOARD: Final = "ladder"
"""Its board."""


class FlawsChoice(StrEnum):
    """Sets of a plant's properties."""

    ideal = "ideal"
    nominal = "nominal"


class UnitsChoice(StrEnum):
    """Systems of units that answers may be shown in."""

    si = "si"
    imperial = "imperial"


TaskName: TypeAlias = Annotated[
    str,
    typer.Argument(
        help="A task's name (`clamber list tasks`), or the path of its TOML file.", autocompletion=names_of("tasks")
    ),
]
PlannerName: TypeAlias = Annotated[
    str, typer.Option(help="How to search (`clamber list planners`).", autocompletion=names_of("planners"))
]
CarriedOutIn: TypeAlias = Annotated[
    str | None,
    typer.Option(help="Carry the plan out in this task, in place of its own.", autocompletion=names_of("tasks")),
]
Replan: TypeAlias = Annotated[bool, typer.Option(help="Plan again where a hold cannot be had.")]
Overrides: TypeAlias = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Change one key of task, board or robot, such as start.y=6.2in."),
]
NoiseTexts: TypeAlias = Annotated[
    list[str] | None,
    typer.Option(
        "--noise", metavar="KEY=WIDTH", help="How far a property may be off, such as friction=30%; or usual, or none."
    ),
]
Faults: TypeAlias = Annotated[
    list[str] | None,
    typer.Option("--fault", metavar="KIND", help="A fault that each run has one of, or any (docs/faults.md)."),
]
AsJson: TypeAlias = Annotated[bool, typer.Option("--json", help="Print one JSON value and nothing else.")]
Quiet: TypeAlias = Annotated[bool, typer.Option("--quiet", "-q", help="Tell nothing on the way.")]
Output: TypeAlias = Annotated[Path | None, typer.Option("--output", "-o", metavar="FILE", help="File to write.")]
Workers: TypeAlias = Annotated[
    int | None, typer.Option(min=1, help="Processes; one a core unless given. With --ray: most points at work at once.")
]
Ray: TypeAlias = Annotated[
    str | None, typer.Option(metavar="HOST:PORT", help="Work on this running Ray cluster (docs/scaling.md).")
]
Store: TypeAlias = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Keep each result as it ends (SQLite), to resume from.")
]
Resume: TypeAlias = Annotated[bool, typer.Option("--resume", help="Go on with --store: what is finished stays.")]
Flaws: TypeAlias = Annotated[
    FlawsChoice,
    typer.Option("--flaws", help="nominal: backlash, rate and encoders of the robot's file, one sample of delay."),
]
Settings: TypeAlias = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Change the plant, such as backlash=2deg or payload=0.3kg."),
]
PlanSeconds: TypeAlias = Annotated[
    float,
    typer.Option(min=0.0, help="Most time for each search; where it ends one, another machine may find another plan."),
]
PLAN_SECONDS = 600.0
"""So long that what planners may see ends their searches, however busy the machine."""
