"""The field's words: names that the source had of its own, and that shall not come back, each beside the standard term."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from clamber.cli.commands import RENAMED, commands

PACKAGE = Path(__file__).resolve().parent.parent / "src" / "clamber"
MODULES = {
    "moment": "law_state", "play": "backlash", "leg": "planar_limb", "here": "remaining_task", "bearing": "contact_capacity",
    "ways_on_paper": "swing_feasibility", "let_go": "release_to_hang", "hook_back": "hook_retract", "pushed_body": "swing_contact_monitor",
    "course": "executable_plan, footstep_plan", "sea": "reachability state", "flood": "exploration", "chances": "initial_conditions",
    "cautions": "planning_margins", "lessons": "plan_repair", "rehearsal": "plan_validation", "rehearse": "validate",
    "rehearsed_heights": "predicted_heights", "steadying": "stretch_repair", "lent_plate": "redundancy_allocation",
    "plate_room": "free_base_freedoms", "film": "recording", "exhibit": "viewer_content", "stage": "scene_view",
    "labour": "background_task",
    "undertakings": "actions", "crew": "worker_options", "press": "hold_force", "polish": "shorten", "most": "max_setting",
    "things": "named for what it holds", "utils": "named for what it holds",
}  # fmt: skip
"""Name of a file without its suffix, or of a folder -> what it is called."""
DEFINED = {
    "fill_moment": "fill_law_state", "drive_at": "drive_packed", "DESK": "CONTROLLER_BUFFERS", "desk": "buffers", "LEG": "PLANAR_LIMB",
    "JOB": "LIMB_TASK", "CLING": "UNLOADED_CONTACT", "doing": "mode", "share_wrench": "distribute_wrench",
    "command_tips": "command_contact_forces", "best_within": "max_min_solution", "spot": "body_pose", "burden": "stance_cost",
    "burdens": "stance_costs", "freer": "dominating", "toward": "heuristic_between", "wander": "without_goals", "sprout": "expand_scored",
    "sprouts": "scored_children", "Sprouts": "ScoredChildren", "WayFields": "CostToGoMap", "Way": "path, plan", "Course": "ExecutablePlan",
    "Sea": "ReachabilityState", "Flood": "Exploration", "Caution": "PlanningMargins", "caution": "margins", "mended": "repaired",
    "steadied": "with_stretch_repaired", "rehearse": "validate", "Rehearsal": "PlanValidation", "Opening": "FeasibleRelaxation",
    "Shut": "FailedRelaxation", "Openings": "InfeasibilityExplanation", "LentPlate": "RedundancyAllocation", "lent_plate":
    "redundancy_allocation", "PlateRoom": "FreeBaseFreedoms", "plate_room": "free_base_freedoms", "takes_words": "takes_options", "Telling":
    "callback", "labour": "background task", "undertakings": "actions", "Exhibit": "ViewerContent", "Film": "Recording", "Stage":
    "SceneView", "Hunt": "SearchBudget", "Yardsticks": "Normalisation", "yardsticks": "normalisation", "chances": "initial_conditions",
    "utils": "named for what it holds",
}  # fmt: skip
"""Name of a class, function, parameter, field or constant -> the field's word for it."""
ELSEWHERE = {
    "LEG": "families/walker/",
    "doing": "terminal/",
    "rehearse": ("__init__.py", "api/"),
    "find_openings": ("__init__.py", "api/"),
}
"""Name -> where it stands for something else, or is what people call: rows of a walker's six legs, what a line says, the Python API."""
PENDING = {"families/spatial"}
"""Folders that are being built."""


def files() -> Iterator[tuple[str, Path]]:
    """Every file of the source with its place below the package."""
    for path in sorted(PACKAGE.rglob("*.py")):
        place = path.relative_to(PACKAGE).as_posix()
        if not any(place.startswith(folder) for folder in PENDING):
            yield place, path


def defined(tree: ast.AST) -> Iterator[tuple[str, int]]:
    """Names that a file defines, in whatever way, with their lines: a name that is used is defined somewhere."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            yield node.name, node.lineno
        elif isinstance(node, ast.arg):
            yield node.arg, node.lineno
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id, node.lineno
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield node.attr, node.lineno
        elif isinstance(node, ast.alias):
            yield node.asname or node.name.rpartition(".")[2], node.lineno


def test_no_file_or_folder_has_a_name_of_our_own() -> None:
    names = {part for place, _ in files() for part in place.removesuffix(".py").split("/")}
    assert {name: MODULES[name] for name in names & set(MODULES)} == {}


def test_no_name_in_the_source_is_of_our_own() -> None:
    found = [
        f"{place}:{line}: {name}, which is {DEFINED[name.lstrip('_')]}"
        for place, path in files()
        for name, line in defined(ast.parse(path.read_text(encoding="utf-8")))
        if name.lstrip("_") in DEFINED and not place.startswith(ELSEWHERE.get(name.lstrip("_"), "/"))
    ]
    assert found == []


@pytest.mark.parametrize(("old", "new"), RENAMED.items())
def test_a_renamed_command_is_read_for_one_release_hidden_and_names_the_new_one(clamber, old: str, new: str) -> None:  # type: ignore[no-untyped-def]
    assert old not in commands() and new in commands()
    code, out, err = clamber(old, "--help")
    assert (
        code == 0
        and f"clamber {new} " in out
        and err
        == clamber(new, "--help")[2]
        + (f"clamber: the command '{old}' is called '{new}' now; the old name will go with the next release\n")
    )
