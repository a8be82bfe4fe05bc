"""The commands of `clamber`: the file of each, and the line that lists it. A file is read only where its command is called."""

from importlib import import_module
from typing import Any, Final, NamedTuple

import typer


class Entry(NamedTuple):
    """A command, or a group of them, that nobody has read yet."""

    place: str
    """Module in this folder and name in it."""
    line: str
    """What it does: the first paragraph of its help."""

    def read(self) -> Any:
        """The function or the group."""
        module, name = self.place.split(":")
        return getattr(import_module(f".{module}", __package__), name)


COMMANDS: Final = {
    "list": Entry(
        "list:list_names",
        "List robots, boards, grounds, tasks, walks, plans, planners, checks, controllers, plants and studies by name.",
    ),
    "plan": Entry(
        "plan.command:plan",
        "Find a sequence of grabs and body moves that every check allows, from the start to the goal.",
    ),
    "polish": Entry(
        "polish:polish",
        "Make a plan that reaches its goal shorter, by search about it; every check of the task still holds.",
    ),
    "rehearse": Entry(
        "rehearse:rehearse",
        "Climb by a plan under noise, change what fails most, keep the change if more climbs succeed, and again.",
    ),
    "learn": Entry(
        "learn:learn",
        "Plan a task and learn the gait in the plan; `clamber plan --macros FILE` then uses it.",
    ),
    "inventory": Entry(
        "inventory:inventory",
        "List the modules that a plan can be made of, and by how much the filters shrink the search, D = N^m.",
    ),
    "check": Entry(
        "check:check",
        "Say what is wrong with a file; of a task whether its start holds, of a plan every step, every margin, the first violation.",
    ),
    "run": Entry(
        "run.command:run",
        "Carry a plan or a walk out on a simulated robot: every action or step, what became of it, and where it ended.",
    ),
    "press": Entry(
        "press:press",
        "Hold on with two limbs, press a wall with the third, and move the body: how well the force is held.",
    ),
    "follow": Entry(
        "follow:follow",
        "Follow a tool path with arm and body, within every limit of joints, rates, actuators, legs and balance.",
    ),
    "trials": Entry(
        "trials.command:trials",
        "Climb many times under noise: how often it succeeds, why it fails, how long it takes, what matters.",
    ),
    "most": Entry(
        "most:most",
        "Find the largest of N values with which a walk comes to its end in balance, by bisection; without noise unless asked for.",
    ),
    "show": Entry(
        "show:show",
        "Draw a task, a plan or one step of it (png, svg, pdf), or a plan in motion (gif, html, mp4).",
    ),
    "view": Entry(
        "view:view",
        "Look at a robot in the browser: play plans and runs, edit a board or a ground, plan, and run.",
    ),
    "export": Entry(
        "export:export", "Write a robot, a plan or a run for other programs; the file's suffix says as what."
    ),
    "bench": Entry(
        "bench:bench",
        "Measure speed and success, ours beside those of peers; seeds, ablation and boards are batches, with workers and a store.",
    ),
    "sweep": Entry(
        "sweep:sweep",
        "Plan at every point of a range: where a plan exists, how long the shortest is, how hard it loads the joints.",
    ),
    "reach": Entry(
        "reach:reach",
        "Map every pose and hold that the robot can get to, and what it costs to be there (picture, or .csv of the poses).",
    ),
    "calibrate": Entry(
        "calibrate:calibrate",
        "Fit a walker's unprinted sizes to what is printed of it, and list what else fits as well.",
    ),
    "ditch": Entry(
        "ditch:ditch",
        "Tell how wide a ditch a walker crosses, by the angle of its frames; with --width, plan a crossing, pivots first.",
    ),
    "study": Entry(
        "study:study",
        "Repeat what a paper reports, and say for each result whether it holds.",
    ),
    "schema": Entry(
        "schema:schema",
        "Tell what a command prints with --json: every field, what it holds and means. With --json: the JSON Schema.",
    ),
    "doctor": Entry(
        "doctor:doctor",
        "Tell what is installed, what the machine has, whether the kernels are compiled, and what is wrong.",
    ),
}
"""In the order in which they are listed."""
GROUPS: Final = {
    "limb": Entry("limb.commands:limb", "Compare Cartesian controllers on one geared limb."),
    "body": Entry("body.commands:body", "Compare controls of a climber's body that two limbs hold."),
    "new": Entry("new:new", "Write a file to start from: robot, board or task."),
    "plant": Entry("plant:plant", "A robot in its own process, driven over a local socket."),
}
"""Commands of commands."""


def add_commands(app: typer.Typer, only: str | None = None) -> None:
    """Give an application its commands.

    Args:
        app: The application.
        only: The one that is called; the others are there by name and line alone. None: all of them, whole.
    """
    for name, entry in COMMANDS.items():
        if only in (None, name):
            app.command(name)(entry.read())
        else:
            app.command(name, help=entry.line)(_nothing)
    for name, entry in GROUPS.items():
        if only in (None, name):
            app.add_typer(entry.read(), name=name)
        else:
            app.add_typer(typer.Typer(help=entry.line, callback=_nothing), name=name)


def _nothing() -> None:
    pass
