"""`clamber limb`: laws compared on one geared limb."""

import typer

from .limb_circle import circle
from .limb_force import force
from .limb_identify import identify
from .limb_open_loop import open_loop
from .limb_portrait import portrait
from .limb_push import push
from .limb_record import record
from .limb_step import step
from .limb_sweep import sweep
from .limb_tune import tune

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
