"""The largest numbers that options take: what is beyond would fill memory or never end, and no number is not a number."""

import math
from typing import Any, Final

import typer

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
BENCHES: Final = ("limb", "body", "press")
"""Commands that keep every sample of a run."""
RUNS: Final = ("seconds", "lap", "to", "from_")
"""Their parameters that are times of the run [s]."""


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
