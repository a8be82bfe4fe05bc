"""`clamber new`: write files to start from."""

from pathlib import Path
from typing import Annotated, Any

import typer

from .options import AsJson
from .output import announce_compilation, check_writable, print_json, stdout

new = typer.Typer(help="Write a file to start from.", no_args_is_help=True)


@new.callback()
def _kinds() -> None:
    """Write a file to start from."""


@new.command("board")
def board(
    random: Annotated[
        bool, typer.Option("--random", help="Holds scattered at random, the same for the same seed.")
    ] = False,
    holds: Annotated[int, typer.Option(help="How many holds.")] = 100,
    density: Annotated[str, typer.Option(help="Holds per m^2, or with a unit, such as '2 holds/ft^2'.")] = "20",
    width: Annotated[str | None, typer.Option(help="Of the wall, such as 3m; as wide as high unless given.")] = None,
    least_gap: Annotated[
        str | None,
        typer.Option(help="Least distance of two holds, such as 8cm; half of the mean distance unless given."),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Same seed, same board, on any machine.")] = 0,
    listed: Annotated[
        bool, typer.Option("--listed", help="List every hold, to edit them, and not how they were scattered.")
    ] = False,
    task: Annotated[
        bool, typer.Option("--task", help="Write a task to FILE, to the top of the board, and the board beside it.")
    ] = False,
    overrides: Annotated[
        list[str] | None,
        typer.Option(
            "--set", metavar="KEY=VALUE", help="Change one key of that task, such as robot=gecko4 or rules.max_hangs=0."
        ),
    ] = None,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="File to write.")] = Path("wall.toml"),
    as_json: AsJson = False,
) -> None:
    """Write a board, and with --task a task on it that `clamber plan` takes at once."""
    if not random:
        raise typer.BadParameter("only random boards are written so far; add --random", param_hint="--random")
    if overrides and not task:
        raise typer.BadParameter("changes the task; it needs --task", param_hint="--set")
    if output.suffix != ".toml":
        raise typer.BadParameter(f"'{output}' must end in .toml", param_hint="--output")
    board_file = output.with_name(f"{output.stem}-board.toml") if task else output
    check_writable(output)
    check_writable(board_file)
    from ..files import write_atomically
    from ..toml_text import toml_text
    from .new_files import board_data, task_data, wall_facts

    data = board_data(holds, density, width, least_gap, seed, board_file, listed=listed)
    written = {"board": str(board_file)}
    facts: dict[str, Any] = wall_facts(data, board_file)
    if task:
        announce_compilation()
        climb = task_data(data, board_file, output, overrides or ())
        write_atomically(
            output, toml_text(climb, "From the lowest stance that the rules allow to the top of a random board.")
        )
        written["task"] = str(output)
    write_atomically(board_file, toml_text(data))
    if as_json:
        print_json({"written": written, **facts})
        return
    console = stdout()
    apart = f", at least {facts['gap_m']:.4g} m apart" if facts["gap_m"] is not None else ""
    console.print("{holds} holds on {width_m:.4g} x {height_m:.4g} m".format(**facts) + apart)
    for kind, path in written.items():
        console.print(f"{kind} written to {path}", soft_wrap=True)
    if task:
        console.print(f"next: clamber show {output}; clamber plan {output} --planner auto", soft_wrap=True)
