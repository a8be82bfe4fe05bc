"""`clamber list` reads names and titles without loading what they name; here both are held against each other."""

import os
import subprocess
import sys
from pathlib import Path

import clamber
from clamber.families.climber.world.library import board_names
from clamber.families.walker.planning.walks import walk_names
from clamber.families.walker.world.ground import ground_names
from clamber.planning.planners import PLANNERS, find_planner
from clamber.planning.problem.plan_source import plan_names
from clamber.sim.plants import PLANTS
from clamber.tasks import task_names
from clamber.tasks.robots import robot_names
from clamber.terminal.catalogue import ENTRIES, PLANT_TITLES


def first_line(thing: object) -> str:
    return (thing.__doc__ or "").strip().partition("\n")[0]


def names(kind: str) -> tuple[str, ...]:
    return tuple(name for name, _ in ENTRIES[kind]())


def test_data_are_listed_as_their_libraries_know_them() -> None:
    assert names("robots") == robot_names()
    assert names("boards") == board_names()
    assert names("grounds") == ground_names()
    assert names("tasks") == task_names()
    assert names("walks") == walk_names()
    assert names("plans") == plan_names()


def test_titles_are_the_first_lines_of_what_they_tell_of() -> None:
    for name, planner in PLANNERS.items():
        assert first_line(find_planner(name)) == planner.title
    assert {name: first_line(plant) for name, plant in PLANTS.items()} == PLANT_TITLES


def test_listing_loads_nothing_that_is_slow_to_load() -> None:
    code = (
        "import sys\nfrom clamber.cli import main\ntry:\n    main(['list'])\nfinally:\n"
        "    print('heavy:', sorted({'numba', 'scipy', 'mujoco', 'matplotlib'} & set(sys.modules)))"
    )
    environment = os.environ | {"PYTHONPATH": str(Path(clamber.__file__).parents[1])}
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment, check=True)
    assert told.stdout.endswith("heavy: []\n")
