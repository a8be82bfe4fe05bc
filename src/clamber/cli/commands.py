"""The commands of `clamber`, each with its place. A command's module is imported only where the command is called."""

import ast
from collections.abc import Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

import typer

from ..family import BUILT_IN, families, family_named

COMMANDS: Final = {
    "list": "list:list_names",
    "plan": "plan.command:plan",
    "shorten": "shorten:shorten",
    "learn": "learn:learn",
    "inventory": "inventory:inventory",
    "check": "check:check",
    "run": "run.command:run",
    "trials": "trials.command:trials",
    "show": "show:show",
    "view": "view:view",
    "export": "export:export",
    "bench": "bench:bench",
    "sweep": "sweep:sweep",
    "reach": "reach:reach",
    "study": "study:study",
    "schema": "schema:schema",
    "doctor": "doctor:doctor",
}
"""Command -> module in this folder and function in it, in the order in which they are listed."""
RENAMED: Final = {"polish": "shorten", "rehearse": "validate", "press": "hold-force", "most": "max-setting"}
"""Old name of a command, read for one release -> its name."""
GROUPS: Final = {
    "limb": "limb.commands:limb",
    "body": "body:body",
    "new": "new:new",
}
"""Commands of commands: name -> module and application in it."""


def _of_families(kind: str, only: str | None) -> dict[str, str]:
    """Name -> place of the commands, or groups of commands, that families add; ours come first, and none takes a name that there is.

    Args:
        kind: `commands` or `groups`.
        only: The one that is called; where it is one of ours, other packages are not looked for. None: all.
    """
    found: dict[str, str] = {}
    for name in BUILT_IN:
        found |= getattr(family_named(name), kind)
    if only is None or only not in {*COMMANDS, *GROUPS, *found}:
        for family in families():
            found = dict(getattr(family, kind)) | found
    return {name: place for name, place in found.items() if name not in COMMANDS and name not in GROUPS}


def commands(only: str | None = None) -> dict[str, str]:
    """Command -> module and function in it: those of any robot, then those of one family."""
    return {name: f"{__package__}.{place}" for name, place in COMMANDS.items()} | _of_families("commands", only)


def groups(only: str | None = None) -> dict[str, str]:
    """The same for commands of commands."""
    return {name: f"{__package__}.{place}" for name, place in GROUPS.items()} | _of_families("groups", only)


def under_new_name(words: Sequence[str]) -> tuple[list[str], str | None]:
    """The words after `clamber` with the name that their command has now, and a line about it where it was called by an old one."""
    at = next((at for at, word in enumerate(words) if not word.startswith("-")), None)
    if at is None or words[at] not in RENAMED:
        return list(words), None
    name = RENAMED[words[at]]
    line = f"clamber: the command '{words[at]}' is called '{name}' now; the old name will go with the next release"
    return [*words[:at], name, *words[at + 1 :]], line


def read_place(place: str) -> Any:
    """The function or the group at a place."""
    module, name = place.split(":")
    return getattr(import_module(module), name)


def first_paragraph(place: str) -> str:
    """What a command or a group does: the first paragraph of its help, from its source alone."""
    module, name = place.split(":")
    package, _, last = module.rpartition(".")
    spec = find_spec(package)
    assert spec is not None and spec.submodule_search_locations
    file = Path(spec.submodule_search_locations[0], f"{last}.py")
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
    single, grouped = commands(only), groups(only)
    listed = only not in single | grouped  # else nobody sees the lines of the others
    for name, place in single.items():
        if only in (None, name):
            app.command(name)(read_place(place))
        else:
            app.command(name, help=first_paragraph(place) if listed else None)(_nothing)
    for name, place in grouped.items():
        if only in (None, name):
            app.add_typer(read_place(place), name=name)
        else:
            help_line = first_paragraph(place) if listed else None
            app.add_typer(typer.Typer(help=help_line, callback=_nothing), name=name)


def _nothing() -> None:
    pass
