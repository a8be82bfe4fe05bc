"""`clamber body`: controls compared on the body of a climber that two limbs hold."""

import typer

from .circle import circle
from .push import push
from .push_up import push_up

body = typer.Typer(help="Compare controls of a climber's body that two limbs hold.", no_args_is_help=True)
body.command("circle")(circle)
body.command("push-up")(push_up)
body.command("push")(push)
