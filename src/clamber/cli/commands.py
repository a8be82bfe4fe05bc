"""The commands of `clamber`, each with its place. A command's module is imported only where the command is called."""

import ast
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import typer

COMMANDS: Final = {
    "list": "list:list_names",
    "plan": "plan.command:plan",
    "polish": "polish:polish",
    "rehearse": "rehearse:rehearse",
    "learn": "learn:learn",
    "inventory": "inventory:inventory",
    "check": "check:check",
    "run": "run.command:run",
    "press": "press:press",
    "follow": "follow:follow",
    "trials": "trials.command:trials",
    "most": "most:most",
    "show": "show:show",
    "view": "view:view",
    "export": "export:export",
    "bench": "bench:bench",
    "sweep": "sweep:sweep",
    "reach": "reach:reach",
    "calibrate": "calibrate:calibrate",
    "ditch": "ditch:ditch",
    "study": "study:study",
    "schema": "schema:schema",
    "doctor": "doctor:doctor",
}
"""Command -> module in this folder and function in it, in the order in which they are listed."""
GROUPS: Final = {
    "limb": "limb.commands:limb",
    "body": "body:body",
    "new": "new:new",
    "plant": "plant:plant",
}
"""Commands of commands: name -> module and application in it."""


def _read(place: str) -> Any:
    """The function or the group at a place."""
    module, name = place.split(":")
    return getattr(import_module(f".{module}", __package__), name)


def first_paragraph(place: str) -> str:
    """What a command or a group does: the first paragraph of its help, from its source alone."""
    module, name = place.split(":")
    file = Path(__file__).parent.joinpath(*module.split(".")).with_suffix(".py")
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef) and node.name == name:
            return " ".join((ast.get_docstring(node) or "").split("\n\n")[0].split())
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == name and isinstance(node.value, ast.Call):
            return next(str(ast.literal_eval(each.value)) for each in node.value.keywords if each.arg == "help")
    raise AssertionError(f"{place} is neither a command nor a group")


def add_commands(app: typer.Typer, only: str | None = None) -> None:
    """Give an application its commands.

    Args:
        app: The application.
        only: The one that is called; the others are there by name and line alone. None: all of them, whole.
    """
    listed = only not in COMMANDS | GROUPS  # else nobody sees the lines of the others
    for name, place in COMMANDS.items():
        if only in (None, name):
            app.command(name)(_read(place))
        else:
            app.command(name, help=first_paragraph(place) if listed else None)(_nothing)
    for name, place in GROUPS.items():
        if only in (None, name):
            app.add_typer(_read(place), name=name)
        else:
            help_line = first_paragraph(place) if listed else None
            app.add_typer(typer.Typer(help=help_line, callback=_nothing), name=name)


def _nothing() -> None:
    pass
