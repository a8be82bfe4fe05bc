"""`clamber limb`: laws compared on one geared limb."""

import typer

from .circle import circle
from .force import force
from .identify import identify
from .open_loop import open_loop
from .portrait import portrait
from .push import push
from .record import record
from .step import step
from .sweep import sweep
from .tune import tune

limb = typer.Typer(help="Compare Cartesian controllers on one geared limb.", no_args_is_help=True)
limb.command("step")(step)
limb.command("circle")(circle)
limb.command("push")(push)
limb.command("open-loop")(open_loop)
limb.command("identify")(identify)
limb.command("record")(record)
limb.command("force")(force)
limb.command("portrait")(portrait)
limb.command("sweep")(sweep)
limb.command("tune")(tune)
