"""`clamber limb`: laws compared on one geared limb."""

import typer

from .limb_circle import circle
from .limb_push import push
from .limb_step import step
from .limb_sweep import sweep
from .limb_tune import tune

limb = typer.Typer(help="Compare Cartesian controllers on one geared limb.", no_args_is_help=True)
limb.command("step")(step)
limb.command("circle")(circle)
limb.command("push")(push)
limb.command("sweep")(sweep)
limb.command("tune")(tune)
