"""Manipulability and its gradient against roboticstoolbox's answers, linear algebra and central differences."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from walkers import ROBOTS, differences, random_q, with_links

from clamber.families.walker.control.cooperative.limits import chain_of
from clamber.families.walker.control.cooperative.scratch import Scratch, make_scratch, see_measure, see_tool
from clamber.families.walker.robot import WalkerRobot
from clamber.types import Floats

ANSWERS = json.loads(Path(__file__).with_name("roboticstoolbox.json").read_text(encoding="utf-8"))


def seen(robot: WalkerRobot, q: Floats) -> Scratch:
    assert robot.arm is not None
    w = make_scratch(robot.arm.n_joints)
    see_tool(chain_of(robot, balance=0.0), q, w)
    return w


@pytest.mark.parametrize("case", ANSWERS["cases"], ids=lambda case: f"{len(case['links'])} links, {case['freedoms']}")
def test_measure_and_gradient_are_roboticstoolboxs(case: dict[str, Any]) -> None:
    robot = with_links(tuple(case["links"]))
    assert robot.arm is not None
    robot = replace(robot, arm=replace(robot.arm, out=ANSWERS["out"], up=ANSWERS["up"]))
    q = np.array(case["q"])
    speeds = np.zeros(q.size)
    speeds[case["freedoms"]] = 1.0
    w = seen(robot, q)
    assert see_measure(speeds, np.ones(3), w) == pytest.approx(case["manipulability"], abs=1e-12, rel=1e-12)
    np.testing.assert_allclose(w.gradient[case["freedoms"]], case["gradient"], atol=1e-12, rtol=1e-12)
    off = np.setdiff1d(np.arange(q.size), case["freedoms"])
    assert not w.gradient[off].any()


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("name", ["hoshino", "two links", "six links"])
def test_the_normalised_measure_has_its_gradient(name: str, seed: int) -> None:
    robot = ROBOTS[name]
    q = random_q(robot, seed)
    rng = np.random.default_rng(seed)
    speeds, tool_speeds = rng.uniform(0.0, 0.5, q.size), rng.uniform(0.1, 0.3, 3)
    speeds[rng.integers(0, 6)] = 0.0

    def measure(p: Floats) -> float:
        return float(see_measure(speeds, tool_speeds, seen(robot, p)))

    w = seen(robot, q)
    value = see_measure(speeds, tool_speeds, w)
    singular = np.linalg.svd(w.jacobian * speeds / tool_speeds[:, None], compute_uv=False)
    assert value == pytest.approx(np.prod(singular), rel=1e-11)
    np.testing.assert_allclose(w.gradient, speeds * differences(measure, q), atol=1e-7, rtol=1e-7)


def test_more_freedoms_never_have_less_manipulability() -> None:
    """det(J J' + c c') >= det(J J'): a freedom that is added cannot make V smaller in the same posture."""
    robot = ROBOTS["hoshino"]
    rng = np.random.default_rng(3)
    for seed in range(20):
        q = random_q(robot, seed)
        speeds = np.zeros(q.size)
        speeds[6:] = 0.35
        last = see_measure(speeds, np.ones(3), seen(robot, q))
        for k in rng.permutation(6):
            speeds[k] = rng.uniform(0.01, 0.2)
            now = see_measure(speeds, np.ones(3), seen(robot, q))
            assert now >= last * (1.0 - 1e-12)
            last = now


def test_a_stretched_arm_alone_has_none() -> None:
    robot = ROBOTS["hoshino"]
    q = np.array([0, 0, 0.4, 0, 0, 0, 0.3, 0.4, 0.0, 0.0])
    speeds = np.array([0.0] * 6 + [0.35] * 4)
    w = seen(robot, q)
    assert see_measure(speeds, np.ones(3), w) < 1e-9
    assert np.isfinite(w.gradient).all()
