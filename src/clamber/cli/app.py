"""The application: its commands, what all of them share, and how it leaves.

Exit codes: 0 found, holds, or done; 1 no plan, or a violation; 2 bad input; 70 an unexpected error; 130 interrupted.
"""

import os
import sys
from collections.abc import Sequence
from typing import Annotated, Any, cast

import typer

from .. import __version__
from ..errors import ClamberError, printable
from .command_end import until_command_ends
from .commands import add_commands
from .help_text import command_of
from .output import fall_silent


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


def main(arguments: Sequence[str] | None = None) -> None:
    """Run a command and leave with its exit code; the user's mistakes come out as one message on stderr.

    Args:
        arguments: Words after `clamber`; None takes those of the process.
    """
    words = sys.argv[1:] if arguments is None else list(arguments)
    called = next((word for word in words if not word.startswith("-")), "")
    completes = "_CLAMBER_COMPLETE" in os.environ  # the words come another way
    try:
        command = command_of(application(None if completes else called))
        sys.exit(command(args=words, prog_name="clamber", standalone_mode=False))
    except ClamberError as error:
        print(printable(f"clamber: {error}"), file=sys.stderr)
        sys.exit(2)
    except typer.TyperException as error:  # words that are no options, or not what options take
        from typer.rich_utils import rich_format_error

        error.message = printable(error.message)
        rich_format_error(cast(Any, error))
        sys.exit(error.exit_code)
    except typer.Abort as error:  # Typer's word for a file that ended too early
        _leave_unexpectedly(error.__cause__ or error, words)
    except MemoryError:
        print("clamber: needs more memory than there is; ask for less", file=sys.stderr)
        sys.exit(2)
    except Exception as error:
        _leave_unexpectedly(error, words)
    finally:
        fall_silent()
        until_command_ends.close()


def _leave_unexpectedly(error: BaseException, words: Sequence[str]) -> None:
    from .unexpected import UNEXPECTED, unexpected

    print(unexpected(error, words), file=sys.stderr)
    sys.exit(UNEXPECTED)
