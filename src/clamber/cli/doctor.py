"""`clamber doctor`: what is installed, what the machine has, and what is wrong."""

from typing import TYPE_CHECKING

import typer
from rich.console import Console

from ..errors import how_to_install
from ..terminal.options import AsJson
from ..terminal.output import print_json, stdout
from ..viewing.text_table import plain_table

if TYPE_CHECKING:
    from .doctor_facts import Health


def doctor(as_json: AsJson = False) -> None:
    """Tell what is installed, what the machine has, whether the kernels are compiled, and what is wrong."""
    from .doctor_facts import examine

    found = examine()
    if as_json:
        print_json(found)
    else:
        print_facts(stdout(), found)
    raise typer.Exit(1 if found.problems else 0)


def print_facts(console: Console, found: "Health") -> None:
    """The facts as people read them."""
    table = plain_table("", "")
    table.show_header = False
    machine, kernels = found.machine, found.kernels
    table.add_row("Clamber", f"{found.clamber.version} in {found.clamber.folder}")
    table.add_row("Python", f"{found.python.version}, {found.python.executable}")
    table.add_row("system", machine.system)
    table.add_row("cores", str(machine.cores))
    if machine.memory is not None:
        table.add_row("memory", f"{_size(machine.memory)}, {_size(machine.memory_free or 0)} free")
    table.add_row("needed", _versions(found.required) or "not known: run from its sources")
    for extra, packages in found.optional.items():
        table.add_row(f"[{extra}]", _versions(packages))
    for each in found.extensions:
        table.add_row("added", f"{each.kind}: {each.name}, of {each.package}")
    state = "compiled" if kernels.compiled else "not compiled yet: the first command does it, once"
    if kernels.problem is not None:
        state = f"compiled anew each time: the folder is {kernels.state}"
    checked = ", every index checked" if kernels.bounds_checked else ""
    table.add_row("kernels", f"{state}; {kernels.functions} functions, {_size(kernels.bytes)}{checked}")
    table.add_row("", kernels.folder)
    if kernels.older_folders:
        words = f"{_size(kernels.older_bytes)} in {kernels.older_folders} folders beside it"
        table.add_row("", f"{words}, of other versions: they can go")
    table.add_row("GL", found.gl or "none; pictures and the viewer do without")
    table.add_row("ffmpeg", found.ffmpeg or f"none; MP4 needs it: {how_to_install('video')}")
    table.add_row("browser", found.chromium or "no chromium; only tests need it")
    console.print(table)
    wrong = found.problems
    for line in wrong:
        console.print(f"wrong: {line}", style="bold red")
    if not wrong:
        console.print("nothing is wrong", style="bold green")


def _versions(packages: dict[str, str | None]) -> str:
    return ", ".join(f"{name} {version or '(missing)'}" for name, version in packages.items())


def _size(count: int) -> str:
    size, units = float(count), ["B", "kB", "MB", "GB", "TB"]
    while size >= 1000.0 and len(units) > 1:
        size, units = size / 1000.0, units[1:]
    return f"{size:.3g} {units[0]}"
