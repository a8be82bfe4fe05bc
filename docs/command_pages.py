"""The page of all commands, `commands.md`: generated from the commands themselves. `python docs/command_pages.py` renews it."""

import re
from pathlib import Path
from typing import Any, Final

import typer

from clamber.cli.app import application, commands_below

GROUPS: Final = {
    "Plan": ("plan", "shorten", "validate", "learn", "inventory", "sweep", "reach", "ditch"),
    "Check and look": ("check", "show", "view", "export", "schema", "list", "doctor"),
    "Simulate": ("run", "trials", "max-setting", "hold-force", "follow", "plant"),
    "Compare controllers": ("limb", "body"),
    "Files to start from": ("new", "calibrate"),
    "Benchmarks and papers": ("bench", "study"),
}
"""Heading -> commands below it, in this order; a command without a group comes last, under `OTHERS`."""
OTHERS: Final = "Others"
VALUES: Final = {"str": "TEXT", "int": "N", "float": "X", "Path": "FILE"}
"""Type of an option without a metavar -> what stands for its value."""
PAGE: Final = re.compile(r"\bdocs/([\w-]+)\.md\b")


def write_command_page(docs: Path) -> None:
    """Write `commands.md`; untouched where it is as it should be."""
    page, text = docs / "commands.md", command_page()
    if not page.is_file() or page.read_text(encoding="utf-8") != text:
        page.write_text(text, encoding="utf-8")


def command_page() -> str:
    """The page: every command that is not hidden, with its help, arguments and options."""
    top = typer.main.get_command(application())
    below: dict[str, list[tuple[str, Any]]] = {}
    for path, command in commands_below(top):  # type: ignore[arg-type]
        if path and not command.hidden and not getattr(command, "commands", None):
            below.setdefault(path[0], []).append((" ".join(path), command))
    grouped = {name for names in GROUPS.values() for name in names}
    groups = GROUPS | {OTHERS: tuple(name for name in below if name not in grouped)}
    parts = [
        "# Commands",
        "Every command with its arguments and options. Generated from the commands themselves: change their help, then run "
        "`python docs/command_pages.py`.",
        "A task, plan, robot or board is named (`clamber list`) or given as the path of its file. `--set` changes any key, with a "
        "unit. `--help` prints what stands here; [exit codes and JSON](json.md).",
    ]
    for title, names in groups.items():
        shown = [each for name in names for each in below.get(name, [])]
        if shown:
            parts.append(f"## {title}")
            rows = [
                f"| [`{words}`](#{_anchor(words)}) | {_cell(_paragraphs(command)[0])} |" for words, command in shown
            ]
            parts.append("\n".join(["| command | what it does |", "|---|---|", *rows]))
            parts += [_section(words, command) for words, command in shown]
    return "\n\n".join(parts) + "\n"


def _section(words: str, command: Any) -> str:
    """One command: its help, and a table of its arguments and options."""
    parts = [f"### clamber {words}", *(_linked(text) for text in _paragraphs(command))]
    rows = [_row(each) for each in command.params if not getattr(each, "hidden", False) and each.name != "help"]
    if rows:
        parts.append("\n".join(["| argument, option | meaning | default |", "|---|---|---|", *rows]))
    return "\n\n".join(parts)


def _row(parameter: Any) -> str:
    """One argument or option."""
    if parameter.param_type_name == "argument":
        name = parameter.metavar or parameter.name.upper()
        return (
            f"| `{_cell(name)}` | {_cell(_linked(parameter.help or ''))} | {'required' if parameter.required else ''} |"
        )
    names = ", ".join(f"`{name}`" for name in (*parameter.opts, *parameter.secondary_opts))
    value = "" if parameter.is_flag else f" {_cell(parameter.metavar or _value(parameter))}"
    return f"| {names}{value} | {_cell(_linked(parameter.help or ''))} | {_default(parameter)} |"


def _value(parameter: Any) -> str:
    """What stands for the value of an option without a metavar."""
    annotation = getattr(getattr(parameter, "type_descriptor", None), "annotation", str)
    kind = re.sub(r".*?\b(str|int|float|Path)\b.*", r"\1", getattr(annotation, "__name__", str(annotation)))
    return VALUES.get(kind, "TEXT")


def _default(parameter: Any) -> str:
    """The default of an option as its help shows it; nothing where it shows none."""
    value = parameter.default
    if parameter.required:
        return "required"
    if isinstance(parameter.show_default, str):
        return _cell(parameter.show_default)
    if value is None or value == [] or value == () or callable(value) or not parameter.show_default:
        return ""
    if isinstance(value, bool):
        off = parameter.secondary_opts
        return f"`{parameter.opts[0] if value else off[0]}`" if off else ""
    values = value if isinstance(value, list | tuple) else (value,)
    return ", ".join(f"`{each:g}`" if isinstance(each, float) else f"`{_cell(str(each))}`" for each in values)


def _paragraphs(command: Any) -> list[str]:
    """The help of a command, each paragraph on one line."""
    return [" ".join(text.split()) for text in (command.help or "").replace("\b", "").split("\n\n") if text.strip()]


def _linked(text: str) -> str:
    """A text whose pages of the documentation are links."""
    return PAGE.sub(r"[\1](\1.md)", text)


def _anchor(words: str) -> str:
    """Of the heading of a command."""
    return f"clamber-{words.replace(' ', '-')}"


def _cell(text: str) -> str:
    """A text in a cell of a table."""
    return text.replace("|", "\\|").replace("<", "&lt;")


if __name__ == "__main__":
    write_command_page(Path(__file__).parent)
