"""Holders and the ways of their hooks past other holds, and how much room the simulated hooks really take."""

import math

import numpy as np
import pytest

from clamber.families.climber.planning.problem import LimbedProblem
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.robot.robot import HOOK_AHEAD, HOOK_WIDTH
from clamber.families.climber.sim.climber_model import HookShape
from clamber.families.climber.statics.checks import LIMBED_CHECKS
from clamber.families.climber.statics.interference import hook_gap
from clamber.planning.problem.arrays import ActionTable
from clamber.planning.problem.codes import pack
from clamber.tasks import load_task
from clamber.types import Floats

HOLDER_PEG = [check.name for check in LIMBED_CHECKS].index("holder_peg")


def margin(*rules: str) -> float:
    task = load_task("circle", rules)
    assert isinstance(task, LimbedTask)
    problem = LimbedProblem(task, ActionTable.build([("stay", [pack(0)], True)]), every_check=True)
    return float(problem.replay(np.array([pack(0)], np.int32), go_on=True).margins[0, HOLDER_PEG])


def test_the_room_of_a_hook_holds_the_simulated_one() -> None:
    shape = HookShape()
    peg = load_task("circle").world.holds[0].radius
    side = peg + shape.wire + shape.side_play / 2 + math.sin(shape.flare_angle) * shape.flare + shape.wire
    ahead = shape.depth + math.cos(shape.flare_angle) * shape.flare + shape.wire
    assert side == pytest.approx(HOOK_WIDTH / 2, abs=1e-4)
    assert ahead == pytest.approx(HOOK_AHEAD, abs=1e-4)


def test_nothing_is_asked_of_hooks_without_a_width() -> None:
    assert margin() == 1e9


def test_a_longer_way_or_a_wider_hook_leaves_no_more_room() -> None:
    gaps = [
        margin(f"rules.hook_width={width} mm", f"rules.hook_way={way} mm")
        for width in (1, 30, 200)
        for way in (0, 40, 200)
    ]
    table = np.array(gaps).reshape(3, 3)
    assert np.all(np.diff(table, axis=0) <= 1e-12)
    assert np.all(np.diff(table, axis=1) <= 1e-12)
    assert table[-1, -1] < table[0, 0]


@pytest.mark.parametrize("degrees", (0.0, 20.0, 42.0, 75.0, 90.0, 120.0, 180.0))
def test_another_hold_is_as_far_from_a_hook_as_from_the_walls_of_the_simulated_one(degrees: float) -> None:
    """Against the walls of the simulated hook itself, drawn with its way behind it."""
    radius, way = load_task("circle").world.holds[0].radius, 0.042
    shape = HookShape()
    for apart in (0.018, 0.0254, 0.04):
        at = apart * np.array((math.cos(math.radians(degrees)), math.sin(math.radians(degrees))))
        side, edge = radius + shape.wire + shape.side_play / 2, shape.depth
        out, lip = math.sin(shape.flare_angle) * shape.flare, math.cos(shape.flare_angle) * shape.flare
        wide = side + out
        walls = [((-way, s * wide), (edge + lip, s * wide)) for s in (-1, 1)]
        walls += [((edge, s * side), (edge + lip, s * wide)) for s in (-1, 1)]
        walls += [((0.0, s * side), (edge, s * side)) for s in (-1, 1)] + [((-way, -wide), (-way, wide))]
        true = min(_from_segment(at, *wall) for wall in walls) - shape.wire
        swept = float(hook_gap(HOOK_WIDTH, HOOK_AHEAD, way, *at))
        if swept > 0.0:
            assert swept == pytest.approx(true, abs=1.2e-3)  # lips that meet, in place of a slot
        else:
            assert -way <= at[0] <= edge + lip + shape.wire and abs(at[1]) <= wide + shape.wire


def _from_segment(at: Floats, start: tuple[float, float], end: tuple[float, float]) -> float:
    a, d = np.array(start), np.array(end) - np.array(start)
    along = np.clip((at - a) @ d / (d @ d), 0.0, 1.0)
    return float(np.hypot(*(at - a - along * d)))
