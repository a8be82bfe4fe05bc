"""The application: its commands, what all of them share, and how it leaves.

Exit codes: 0 found, holds, or done; 1 no plan, or a violation; 2 bad input; 130 interrupted.
"""

import sys
from collections.abc import Sequence
from typing import Annotated

import typer

from .. import __version__
from ..errors import ClamberError
from .bench import bench
from .body.commands import body
from .calibrate import calibrate
from .check import check
from .ditch import ditch
from .doctor import doctor
from .export import export
from .follow import follow
from .help_text import command_of
from .inventory import inventory
from .learn import learn
from .limb.commands import limb
from .list import list_names
from .most import most
from .new import new
from .output import fall_silent
from .plan.command import plan
from .plant import plant
from .polish import polish
from .press import press
from .reach import reach
from .run.command import run
from .schema import schema
from .show import show
from .study import study
from .sweep import sweep
from .trials.command import trials
from .view import view

app = typer.Typer(
    name="clamber",
    help="Plan and control robots that climb and walk on several limbs.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.command("list")(list_names)
app.command("plan")(plan)
app.command("polish")(polish)
app.command("learn")(learn)
app.command("inventory")(inventory)
app.command("check")(check)
app.command("run")(run)
app.command("press")(press)
app.command("follow")(follow)
app.command("trials")(trials)
app.command("most")(most)
app.command("show")(show)
app.command("view")(view)
app.command("export")(export)
app.command("bench")(bench)
app.command("sweep")(sweep)
app.add_typer(limb, name="limb")
app.add_typer(body, name="body")
app.add_typer(new, name="new")
app.add_typer(plant, name="plant")
app.command("reach")(reach)
app.command("calibrate")(calibrate)
app.command("ditch")(ditch)
app.command("study")(study)
app.command("schema")(schema)
app.command("doctor")(doctor)


def _print_version(wanted: bool) -> None:
    if wanted:
        print(f"clamber {__version__}")
        raise typer.Exit


@app.callback()
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
    try:
        command_of(app)(args=None if arguments is None else list(arguments), prog_name="clamber")
    except ClamberError as error:
        print(f"clamber: {error}", file=sys.stderr)
        sys.exit(2)
    finally:
        fall_silent()
