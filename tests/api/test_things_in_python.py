"""Robots and worlds alone, sweeps, reach, trials, validation and the viewer from Python: named, short to look at, drawn."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any
from urllib.request import urlopen

import pytest
from PIL import Image

import clamber

TASKS = ("ladder", "patch-walk", "wall-gripper", "stones-quadruped")
WORK = """
import clamber
walk = clamber.load_walk("level-walk", ["way.0.distance=0.1m"])
trials = clamber.trials(walk, 2, seed=5, workers=2)
print(trials.done, len(trials.ended), sorted(trial.seed for trial in trials.ended))
print(trials.again(5).done == trials.ended[0].done, clamber.trials is type(clamber).__getattribute__(clamber, "trials"))
"""


@pytest.mark.slow
@pytest.mark.parametrize("name", TASKS)
def test_robots_and_worlds_alone_are_inspected_and_drawn(name: str, tmp_path: Path) -> None:
    task = clamber.load_task(name)
    for thing in (task, task.robot, task.world):
        finding = clamber.inspect(thing)
        assert finding.ok and finding.name == thing.name
        assert len(repr(thing)) < 200 and thing.name in repr(thing) and len(repr(finding)) < 200
        with Image.open(clamber.draw(thing, tmp_path / "thing.png")) as picture:
            assert min(picture.size) > 200
        assert "data:image/png;base64," in thing._repr_html_()


@pytest.mark.parametrize(
    ("name", "kind"), [("h", "board"), ("patches", "ground"), ("rubble", "world"), ("ladder", "board")]
)
def test_worlds_of_any_family_are_loaded_by_name(name: str, kind: str) -> None:
    world = clamber.load_world(name)
    assert world.name == name and clamber.inspect(world).kind == kind


@pytest.mark.slow
def test_a_sweep_and_a_reach_have_pictures(tmp_path: Path) -> None:
    sweep = clamber.sweep("ladder", vary="motor.torque_limit=3Nm..21Nm:2", workers=1)
    assert sweep.found == 1 and "1 of 2 points of 'ladder'" in repr(sweep)
    reach = clamber.reach("ladder", stances=5000)
    assert reach.status == "incomplete" and len(repr(reach)) < 200
    for answer in (sweep, reach):
        assert "data:image/png;base64," in answer._repr_html_()
    assert clamber.draw(reach, tmp_path / "steps.png", layer="steps").stat().st_size > 1000


@pytest.mark.parametrize(
    ("call", "named"),
    [
        (lambda: clamber.trials("ladder", n="x"), "n: 'x' is not what it takes; it takes int"),  # type: ignore[arg-type]
        (lambda: clamber.trials("ladder", -1), "n: -1 is below 0"),
        (lambda: clamber.trials("ladder", wrkers=2), "wrkers: is no option here"),  # type: ignore[call-arg]
        (lambda: clamber.trials("ladder", resume=True), "resume: there is nothing to go on with"),
        (lambda: clamber.trials("ladder", noise=3), "noise: 3 is no text"),  # type: ignore[arg-type]
        (lambda: clamber.trials(3), "what: 3 is no task, plan or walk"),
        (lambda: clamber.run(3), "what: 3 is no task, plan or walk"),
        (lambda: clamber.run("level-walk", noise="wind=3"), "wind"),
        (
            lambda: clamber.run("ladder", law="whole-body"),
            "law: 'ladder' is a climb, whose law cannot be chosen; leave it out",
        ),
        (
            lambda: clamber.trials("level-walk", law="whole-body"),
            "law: 'level-walk' is a walk, whose law cannot be chosen",
        ),
        (
            lambda: clamber.run("wall-gripper", law="wholebody"),
            "no law of a whole body is called 'wholebody'; there are",
        ),
        (
            lambda: clamber.trials("wall-gripper", law="pid"),
            "there are whole-body, operational-space, jacobian-transpose",
        ),
        (lambda: clamber.run("wall-gripper", law=3), "law: 3 is not what it takes; it takes str"),  # type: ignore[arg-type]
        (lambda: clamber.trials("wall-gripper", law=3), "law: 3 is not what it takes; it takes str"),  # type: ignore[arg-type]
        (lambda: clamber.sweep("ladder"), "0 keys are to vary"),
        (lambda: clamber.sweep(3, "a=1..2"), "task: 3 is not what it takes"),  # type: ignore[arg-type]
        (lambda: clamber.reach("ladder", stances=0.5), "stances: 0.5 is not what it takes"),  # type: ignore[arg-type]
        (lambda: clamber.validate("ladder"), "there is none; `clamber plan` makes one"),
        (lambda: clamber.check("libra"), "'libra' is a robot; give a plan; `clamber.inspect` looks at the rest"),
        (lambda: clamber.inspect(3), "what: 3 is no robot, world or task"),
        (lambda: clamber.load_world("libra"), "'libra' is a robot"),
        (lambda: clamber.view(3), "what: 3 cannot be shown"),
        (lambda: clamber.view("ladder", "h", "libra"), "one can be shown at a time"),
        (lambda: clamber.view(3, 4), "2 things are given"),
    ],
)
def test_a_wrong_argument_is_named(call: Any, named: str) -> None:
    with pytest.raises(clamber.ClamberError) as raised:
        call()
    assert named in str(raised.value)


@pytest.mark.parametrize("name", TASKS)
def test_whatever_there_is_opens_in_the_viewer(name: str) -> None:
    pytest.importorskip("viser")
    task = clamber.load_task(name)
    for thing in (task, task.robot, task.world, clamber.plan(task, "greedy") if name == "ladder" else name):
        with clamber.view(thing, browser=False) as viewer:
            assert viewer.url in repr(viewer) and "open the viewer" in viewer._repr_html_()
            with urlopen(viewer.url) as page:
                assert page.status == 200


@pytest.mark.long
def test_trials_start_from_a_script_that_works_at_its_top_level(tmp_path: Path) -> None:
    (tmp_path / "work.py").write_text(WORK)
    environment = os.environ | {"PYTHONPATH": str(Path(clamber.__file__).parents[1])}
    done = subprocess.run(
        [sys.executable, "work.py"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        timeout=900,
        check=False,
    )
    assert done.stdout.splitlines() == ["2 2 [5, 6]", "True True"], done.stderr


@pytest.mark.slow
def test_a_plan_is_validated() -> None:
    plan = clamber.load_plan("ladder-hand")
    learned = clamber.validate(plan, 1, lessons=0, noise="none", workers=1)
    assert len(learned.first.trials) == 1 and learned.plan.actions and not learned.lessons
    assert "climbs before" in repr(learned) and "data:image/png;base64," in learned._repr_html_()
