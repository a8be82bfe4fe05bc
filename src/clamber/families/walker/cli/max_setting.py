"""`clamber max-setting`: the highest step, the heaviest payload, the most of anything that a walk bears."""

from itertools import count
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ....terminal.live_line import LiveLine
from ....terminal.name_completion import names_of
from ....terminal.options import AsJson, NoiseTexts, Overrides, Quiet
from ....terminal.output import print_json, stderr, stdout
from ....viewing.text_table import plain_table

if TYPE_CHECKING:
    from ..planning import Walk
    from ..sim.walker_flaws import WalkerFlaws
    from ..trials.max_setting import Most


def max_setting(
    walk: Annotated[
        str,
        typer.Argument(
            metavar="WALK",
            help="A walk's name (`clamber list walks`), or its TOML file.",
            autocompletion=names_of("walks"),
        ),
    ],
    vary: Annotated[
        str, typer.Option(metavar="KEY=LOW..HIGH:N", help="A setting and its range, such as payload=5kg..25kg:21.")
    ],
    overrides: Overrides = None,
    noise: NoiseTexts = None,
    seed: Annotated[int, typer.Option(min=0, help="Of the noise and of rough ground.")] = 0,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Find the largest of N values with which a walk comes to its end in balance, by bisection; without noise unless asked for."""
    from ....errors import SpecError
    from ....planning.axes import range_axis
    from ....trials.work import split_settings
    from ..planning import load_walk
    from ..trials.max_setting import MaxSetting, Tried, find_most, most_tries
    from ..trials.noise import WalkNoise
    from ..trials.run_walk import run_walk, step_told, walk_flaws

    axis = range_axis(vary)
    sizes = WalkNoise.of("none", noise or ())

    def opened(value: str) -> "tuple[Walk, WalkerFlaws]":
        for_walk, for_plant = split_settings([*(overrides or ()), f"{axis.key}={value}"])
        chosen = load_walk(walk, for_walk)
        return chosen, walk_flaws(chosen, for_plant)

    tries, most = count(1), most_tries(len(axis.values))

    def tried(value: str) -> Tried:
        number = next(tries)
        about = f"value {number} of at most {most}, {axis.key} = {value}"
        line.show(about, (number - 1) / most, now=True)

        def told(*step: Any) -> None:
            words, share = step_told(*step)
            line.show(f"{about}: {words}", (number - 1 + (share or 0.0)) / most)

        try:
            chosen, flaws = opened(value)
        except SpecError as cannot:  # the least can be: so this one is too much
            return Tried.refused(value, cannot.allowed)
        return Tried.of(value, run_walk(chosen, flaws, noise=sizes, seed=seed, progress=told))

    with LiveLine(stderr(), quiet=quiet, doing="preparing the walk") as line:
        opened(axis.values[0])  # what cannot be is told before anything walks
        found = find_most(axis.values, tried)
    if as_json:
        print_json(MaxSetting(walk, axis.key, found))
    else:
        _print_most(walk, axis.key, found)
    raise typer.Exit(1 if found.borne is None else 0)


def _print_most(walk: str, key: str, found: "Most") -> None:
    from ....units import DEGREE

    console = stdout()
    if found.borne is None:
        console.print(f"'{walk}' does not bear even {key} = {found.tried[0].value}", style="bold red")
    elif found.refused is None:
        console.print(f"'{walk}' bears {key} = {found.borne.value}, the most that was asked for", style="bold green")
    else:
        console.print(
            f"'{walk}' bears {key} = {found.borne.value}, not {found.refused.value}", style="bold green", soft_wrap=True
        )
    table = plain_table(key, "borne", "margin [mm]", "tilt [deg]", "why not", right=(key, "margin [mm]", "tilt [deg]"))
    for each in found.tried:
        margin = "" if each.margin is None else f"{1e3 * each.margin:.0f}"
        table.add_row(each.value, "yes" if each.borne else "no", margin, f"{each.tilt / DEGREE:.3f}", each.reason)
    console.print(table)
