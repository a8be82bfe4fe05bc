"""Holders and the ways of their hooks past other holds, and how much room the simulated hooks really take."""

import math

import numpy as np
import pytest

from clamber.actions.codes import pack
from clamber.actions.limbed_problem import LimbedProblem
from clamber.actions.table import ActionTable
from clamber.robots.hooks import HOOK_AHEAD, HOOK_WIDTH
from clamber.sim.climber_model import HookShape
from clamber.statics.checks import LIMBED_CHECKS
from clamber.tasks import load_task
from clamber.tasks.limbed import LimbedTask

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
