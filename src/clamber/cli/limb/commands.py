"""`clamber limb`: laws compared on one geared limb."""

import typer

from .compare import circle, push, step
from .force import force
from .identify import identify
from .open_loop import open_loop
from .portrait import portrait
from .record import record
from .sweep import sweep
from .tune import tune

limb = typer.Typer(help="Compare Cartesian controllers on one geared limb.", no_args_is_help=True)
for _command in (step, circle, push, open_loop, identify, record, force, portrait, sweep, tune):
    limb.command(_command.__name__.replace("_", "-"))(_command)
