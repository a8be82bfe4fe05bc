"""The benchmark of robots in space: verdicts are those of HiGHS, rivals that are not there are named, worlds are planned one by one."""

import importlib.util

import numpy as np
import pytest

from clamber.families.spatial.statics.judging import rules_record
from clamber.families.spatial.trials import speed, stance_rivals, worlds

RIVALS = {"jet-leg": "jet_leg", "hpp-centroidal-dynamics": "hpp_centroidal_dynamics", "OMPL": "ompl"}


@pytest.mark.slow
def test_verdicts_are_those_of_highs_on_every_robot() -> None:
    rows = {row.name: row.value for row in speed.highs_rows(stances=250, rounds=1)}
    assert rows["stances whose verdict was compared with that of HiGHS"] > 200
    assert rows["of these with another verdict"] == 0
    assert rows["largest difference of the shares in reserve from those of HiGHS"] < 1e-6


def test_some_stances_of_the_compared_quadruped_stand_and_some_do_not() -> None:
    made = stance_rivals.jet_stances(400)
    judged, _ = made.statics.judge(made.bodies, made.contacts, rules_record(exact=1))
    assert np.isfinite(judged["s"]).mean() > 0.9
    assert 0.2 < (judged["s"] >= 0.0).mean() < 0.8
    assert {"LF", "RF", "LH", "RH"} == set(made.chains.limb_names)


def test_rivals_that_are_not_installed_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    found = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name in RIVALS.values() else found(name))
    rows = [*speed.peer_rows(stances=4, rounds=1), *speed.step_rows(steps=1)]
    for rival in RIVALS:
        told = next(row for row in rows if row.name.startswith(rival))
        assert 'pip install ".[rivals]"' in told.name and np.isnan(told.value)


@pytest.mark.skipif(importlib.util.find_spec("jet_leg") is None, reason="jet-leg is not installed")
def test_jet_leg_says_the_same_of_the_same_stances() -> None:
    made = stance_rivals.jet_stances(40)
    _, reasons = made.statics.judge(made.bodies, made.contacts, rules_record(exact=0))
    verdict = stance_rivals.jet_leg(made)
    assert [verdict(i) for i in range(40)] == (reasons < 0).tolist()


def test_a_task_that_is_no_task_is_told_of_its_world() -> None:
    told = worlds.plan_world({"task": "wall-gripper", "seed": -1})
    assert told["seconds"] is None and "seed" in told["reason"]


@pytest.mark.slow
@pytest.mark.parametrize("name", worlds.TASKS)
def test_plans_are_found_in_other_worlds_of_the_kind_and_hold(name: str) -> None:
    for seed in (1, 2):
        told = worlds.plan_world({"task": name, "seed": seed})
        assert told["seconds"] is not None, told["reason"]
