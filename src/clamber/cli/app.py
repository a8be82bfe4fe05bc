"""The application: its commands, what all of them share, and how it leaves.

Exit codes: 0 found, holds, or done; 1 no plan, or a violation; 2 bad input; 70 an unexpected error; 130 interrupted.
"""

import io
import math
import os
import sys
from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Final, TypeAlias, cast

import typer
from rich.markup import escape
from typer.core import TyperCommand, TyperGroup

from .. import __version__
from ..errors import ClamberError, printable
from ..interrupts import unanswered
from ..terminal import loaded
from ..terminal.command_end import until_command_ends
from ..terminal.options import UnitsChoice
from ..terminal.output import announce_compilation, fall_silent
from .commands import add_commands, under_new_name

SECONDS: Final = 600.0
"""Of a bench's run [s]: 120 000 samples of every signal at 200 Hz."""
LARGEST: Final[dict[str, tuple[float, str]]] = {
    "seed": (2**62, "random numbers take seeds of 63 bits"),
    "replay": (2**62, "random numbers take seeds of 63 bits"),
    "n": (10**6, "a million climbs take a month of a hundred cores"),
    "trials": (10**6, "each is kept in memory"),
    "seeds": (10**6, "each is kept in memory"),
    "lessons": (10**6, "each is kept in memory"),
    "keep": (10**6, "each is kept in memory"),
    "laps": (1000, "every sample is kept in memory"),
    "length": (1000, "the number of plans has more digits than anybody reads"),
    "workers": (1024, "each is a process"),
    "threads": (1024, "no machine has more cores"),
    "islands": (1024, "each is a process and a population"),
    "width": (10**6, "every stance of a breadth is kept in memory"),
    "stances": (10**9, "each is kept in memory"),
}
"""Parameter -> its largest value and why."""
BENCHES: Final = ("limb", "body", "hold-force")
"""Commands that keep every sample of a run."""
RUNS: Final = ("seconds", "lap", "to", "from_")
"""Their parameters that are times of the run [s]."""


NO_GL: Final = "off"
"""For MuJoCo: no windows."""


def limit_numbers(command: Any, path: tuple[str, ...]) -> None:
    """Have a command refuse numbers that are none, not finite, or too large, by the option's name and with the reason.

    Args:
        command: What Typer made.
        path: Its words after `clamber`.
    """
    for option in command.params:
        most, why = LARGEST.get(option.name, (2**62, "whole numbers have 63 bits"))
        if path[:1] and path[0] in BENCHES and option.name in RUNS:
            most, why = SECONDS, "every sample is kept in memory"
        option.callback = _checked(option.callback, most, why)


def _checked(before: Any, most: float, why: str) -> Any:
    """The callback of an option that looks at its numbers first."""

    def check(context: Any, option: Any, value: Any) -> Any:
        for number in value if isinstance(value, list | tuple) else (value,):
            if isinstance(number, float) and not math.isfinite(number):
                raise typer.BadParameter(f"{number} is not a finite number", ctx=context, param=option)
            if isinstance(number, int | float) and number > most:
                raise typer.BadParameter(f"{number} is more than {most:g}: {why}", ctx=context, param=option)
        return value if before is None else before(context, option, value)

    return check


def _whole_names(format_help: Any) -> Any:
    """A command's help whose names of options break over lines where they are too long for their column, and are not cut."""

    def format_whole(*args: Any) -> None:
        loaded()
        from rich.table import Table
        from typer import rich_utils

        class Whole(Table):
            def add_row(self, *cells: Any, **style: Any) -> None:
                super().add_row(*cells, **style)
                for column in self.columns:
                    column.overflow = "fold"

        library = cast(Any, rich_utils)
        before, library.Table = library.Table, Whole
        try:
            format_help(*args)
        finally:
            library.Table = before

    return format_whole


SHOWS_UNITS: Final = ("check", "plan", "reach", "run", "shorten", "show", "sweep", "trials", "validate", "view")
"""Commands that print or draw quantities of a task."""


def _choose_units(system: UnitsChoice | None) -> None:
    from ..shown_units import choose

    choose(None if system is None else system.value)


def _units_option() -> Any:
    """`--units`, which no command has to know of, as Typer makes it of a command that has nothing else."""
    help_text = "Units of what is shown; those of the files unless given."
    made = Annotated[
        UnitsChoice | None, typer.Option("--units", callback=_choose_units, expose_value=False, help=help_text)
    ]

    def nothing(units: made = None) -> None:
        """Carries the option."""

    carrier = typer.Typer(add_completion=False)
    carrier.command()(nothing)
    return typer.main.get_command(carrier).params[0]


Command: TypeAlias = TyperCommand | TyperGroup


def command_of(app: typer.Typer) -> Command:
    """The command of an application: its texts and those of all commands below it as they are written, its numbers within limits."""
    top = typer.main.get_command(app)
    assert isinstance(top, Command)
    for path, command in commands_below(top):
        if path[:1] and path[0] in SHOWS_UNITS:
            command.params.append(_units_option())
        limit_numbers(command, path)
        command.format_help = _whole_names(command.format_help)  # type: ignore[method-assign]
        if command.rich_markup_mode == "rich":  # a plain terminal prints no markup, so none is to be escaped
            for told in (command, *command.params):
                text = getattr(told, "help", None)
                if text is not None:
                    setattr(told, "help", escape(text))  # noqa: B010  # a bare click parameter has none
    return top


def commands_below(command: Command, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Command]]:
    """A command and all below it, each with its words after `clamber`."""
    yield path, command
    if isinstance(command, TyperGroup):
        for name, below in command.commands.items():
            assert isinstance(below, Command)
            yield from commands_below(below, (*path, name))


def application(only: str | None = None) -> typer.Typer:
    """The application.

    Args:
        only: The command that is called: the others are there by name alone, and their files are not read. None: all, whole.
    """
    app = typer.Typer(
        name="clamber",
        help="Plan and control robots that climb and walk on several limbs.",
        no_args_is_help=True,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(_options)
    add_commands(app, only)
    return app


def _print_version(wanted: bool) -> None:
    if wanted:
        print(f"clamber {__version__}")
        raise typer.Exit


def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    pass


def run(arguments: Sequence[str] | None = None) -> int | str | None:
    """Run a command; the user's mistakes come out as one message on stderr.

    Args:
        arguments: Words after `clamber`; None takes those of the process.

    Returns:
        The exit code.

    Raises:
        KeyboardInterrupt: After Ctrl-C, where the command does not end with what there is.
    """
    words, renamed = under_new_name(sys.argv[1:] if arguments is None else arguments)
    if renamed is not None:
        print(renamed, file=sys.stderr)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper) and not stream.encoding.lower().startswith("utf"):
            stream.reconfigure(errors="replace")  # a letter that the terminal has not is a "?", and no traceback
    called = next((word for word in words if not word.startswith("-")), "")
    completes = "_CLAMBER_COMPLETE" in os.environ  # the words come another way
    os.environ.setdefault(
        "MUJOCO_GL", NO_GL
    )  # MuJoCo simulates and draws nothing; its windows begin a process that Ctrl-C would end loudly
    try:
        command = command_of(application(None if completes else called))
        if not {"-q", "--quiet"} & set(words):
            announce_compilation()
        return _called(command, words)
    except SystemExit as end:
        return end.code
    except ClamberError as error:
        print(printable(f"clamber: {error}"), file=sys.stderr)
        return 2
    except typer.TyperException as error:  # words that are no options, or not what options take
        from typer.rich_utils import rich_format_error

        error.message = printable(error.message)
        rich_format_error(cast(Any, error))
        return error.exit_code
    except typer.Abort as error:  # Typer's word for a file that ended too early
        return _told_unexpected(error.__cause__ or error, words)
    except MemoryError:
        print("clamber: needs more memory than there is; ask for less", file=sys.stderr)
        return 2
    except Exception as error:
        return _told_unexpected(error, words)
    finally:
        fall_silent()
        until_command_ends.close()


def _called(command: Command, words: Sequence[str]) -> int | None:
    """The exit code of a command; what goes wrong in it after Ctrl-C that nobody has answered is taken for what came of that."""
    try:
        code: int | None = command(args=words, prog_name="clamber", standalone_mode=False)
    except Exception as error:
        if unanswered():
            raise KeyboardInterrupt from error
        raise
    finally:
        loaded()  # what was wrong is told next
    return code


def _told_unexpected(error: BaseException, words: Sequence[str]) -> int:
    from .unexpected import UNEXPECTED, unexpected

    print(unexpected(error, words), file=sys.stderr)
    return UNEXPECTED
