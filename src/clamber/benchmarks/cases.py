"""The benchmark set: the boards of the thesis, and 40 random ones of four sizes and four densities, all without hangs."""

from dataclasses import dataclass
from typing import Final

from ..families.climber.planning.random_task import random_task
from ..tasks import load_task
from ..types import Json

NO_HANGS: Final = ("rules.max_hangs=0",)
"""With any number of hangs the reachable space doesn't close, and nothing could be proved."""
THESIS: Final = ("ladder", "modified-ladder", "h", "across", "circle")
SIZES: Final = (10, 20, 40, 80)
"""Holds of a random board."""
DENSITIES: Final = (6.0, 8.0, 10.0, 16.0)
"""Holds per square metre. LIBRA climbs hardly anything at 6 and nearly everything at 16."""
PATTERN: Final = (0, 1, 1, 1, 2, 2, 2, 3, 3, 0)
"""Density of each seed's board, by index: more boards where it is open whether there is a way."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """One board, and what is to be done on it."""

    name: str
    size: str
    """"thesis", or the number of holds."""
    density: str
    """"thesis", or holds per square metre."""
    document: Json
    """The whole task."""


def thesis_case(name: str) -> Case:
    """A board of the thesis, by the name of its task; steps as in the task."""
    return Case(name=name, size="thesis", density="thesis", document=load_task(name, NO_HANGS).document)


def random_case(holds: int, seed: int) -> Case:
    """A random board: from the lowest stance that the rules allow to the top, in steps of 3 in and 15 deg."""
    density = DENSITIES[PATTERN[seed % len(PATTERN)]]
    name = f"random-{holds}-{density:g}-{seed}"
    task = random_task(holds, density, seed, name=name, overrides=NO_HANGS)
    return Case(name=name, size=str(holds), density=f"{density:g}", document=task.document)


def all_cases() -> tuple[Case, ...]:
    """The whole set, the same everywhere."""
    made = [random_case(holds, seed) for holds in SIZES for seed in range(len(PATTERN))]
    return (*(thesis_case(name) for name in THESIS), *made)
