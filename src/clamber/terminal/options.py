"""Options and arguments that several commands share."""

import inspect
from collections.abc import Callable
from dataclasses import MISSING, dataclass, fields, is_dataclass
from enum import StrEnum
from functools import wraps
from pathlib import Path
from typing import Annotated, Any, Final, TypeAlias, get_type_hints

import typer

from .name_completion import names_of


def takes_options(command: Callable[..., None]) -> Callable[..., None]:
    """Make a command of a function: a parameter annotated with a dataclass stands for options, one for each of its fields.

    Args:
        command: Its other parameters, and the fields, are annotated as Typer options; each field has a default.
    """
    hints = get_type_hints(command, include_extras=True)
    holders = {name: hint for name, hint in hints.items() if isinstance(hint, type) and is_dataclass(hint)}
    options: list[inspect.Parameter] = []
    for one in inspect.signature(command).parameters.values():
        if one.name in holders:
            options += _options_of(holders[one.name])
        else:
            options.append(one.replace(kind=inspect.Parameter.KEYWORD_ONLY, annotation=hints[one.name]))

    @wraps(command)
    def run(**given: Any) -> None:
        words = {
            name: holder(**{field.name: given.pop(field.name) for field in fields(holder)})
            for name, holder in holders.items()
        }
        command(**given, **words)

    run.__signature__ = inspect.Signature(options)  # type: ignore[attr-defined]
    run.__annotations__ = {one.name: one.annotation for one in options}
    del run.__wrapped__  # else its signature counts
    return run


def _options_of(holder: type[Any]) -> list[inspect.Parameter]:
    hints = get_type_hints(holder, include_extras=True)
    assert all(field.default is not MISSING for field in fields(holder)), holder
    return [
        inspect.Parameter(
            field.name, inspect.Parameter.KEYWORD_ONLY, default=field.default, annotation=hints[field.name]
        )
        for field in fields(holder)
    ]


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
BodyLawName: TypeAlias = Annotated[
    str | None,
    typer.Option(
        metavar="NAME",
        help="Law of a robot in space: whole-body, operational-space, jacobian-transpose, joint-impedance.",
        show_default="whole-body",
    ),
]
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
Force: TypeAlias = Annotated[bool, typer.Option("--force", help="Write over a file that is there.")]
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


@dataclass(frozen=True, slots=True)
class Told:
    """Options of commands that answer once: where that is written, and how it is told."""

    output: Output = None
    as_json: AsJson = False
    quiet: Quiet = False


PlanSeconds: TypeAlias = Annotated[
    float,
    typer.Option(min=0.0, help="Most time for each search; where it ends one, another machine may find another plan."),
]
PLAN_SECONDS = 600.0
"""So long that what planners may see ends their searches, however busy the machine."""
