"""Environments of robots in space keep to Gymnasium's rules, and an episode of our own controller carries the plan out."""

import re
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from clamber.errors import ClamberError

gymnasium = pytest.importorskip("gymnasium")


MODULE = "clamber.families.spatial.environment"


def made(name: str, **more: object) -> object:
    return gymnasium.make(f"{MODULE}:{name}", **more)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["clamber/Climb-v0", "clamber/Walk-v0"])
def test_an_environment_keeps_to_the_rules(name: str) -> None:
    from gymnasium.utils.env_checker import check_env

    check_env(made(name, settings=("goal.along_min=0.06 m",)).unwrapped, skip_render_check=True)  # type: ignore[attr-defined]


@pytest.mark.slow
def test_a_robot_that_does_nothing_falls_and_pays_for_it() -> None:
    env = made("clamber/Climb-v0", settings=("goal.along_min=0.06 m",))
    env.reset(seed=1)  # type: ignore[attr-defined]
    total = 0.0
    for _ in range(400):
        _, reward, ended, late, told = env.step(np.zeros(env.action_space.shape))  # type: ignore[attr-defined]
        total += reward
        if ended or late:
            break
    assert told["fell"] and total < 0.0


@pytest.mark.slow
@pytest.mark.parametrize("noise", ["none", "usual"])
@pytest.mark.parametrize("name", ["clamber/Climb-v0", "clamber/Walk-v0"])
def test_our_own_controller_carries_the_plan_out_by_the_same_actions(name: str, noise: str) -> None:
    from clamber.families.spatial.environment_baseline import carry_out

    env = made(name, noise=[noise]).unwrapped  # type: ignore[attr-defined]
    episode = carry_out(env, seed=1)
    assert episode.done and episode.progress == 1.0 and episode.reason == ""
    # 10 for the plan, 1 for each length of the longest limb that the body came nearer to its stances, hardly anything for torques
    places = [env.start.pose.position, *(goal.end.pose.position for goal in env.goals)]
    way = sum(float(np.linalg.norm(after - before)) for before, after in pairwise(places))
    assert 10.0 < episode.total < 10.0 + way / env.size
    assert carry_out(env, seed=1) == episode, "the same seed, the same episode"


@pytest.mark.slow
def test_a_body_that_is_on_its_way_has_not_fallen_however_long_the_way_is() -> None:
    env = made("clamber/Climb-v0").unwrapped  # type: ignore[attr-defined]
    places = [env.start.pose.position, *(goal.end.pose.position for goal in env.goals)]
    assert max(np.linalg.norm(after - before) for before, after in pairwise(places)) > 0.3 * env.size
    env.reset(seed=1)
    assert not env.step(np.zeros(env.action_space.shape))[4]["fell"]


@pytest.mark.parametrize("task", ["patch-walk", "ladder"])
def test_tasks_of_other_families_are_refused_by_name(task: str) -> None:
    from clamber.errors import ClamberError
    from clamber.families.spatial.environment import SpatialEnv

    with pytest.raises(ClamberError, match=f"'{task}': environments are of robots in space, such as 'wall-gripper'"):
        SpatialEnv(task)


def test_the_snippet_of_the_documentation_makes_an_environment_in_a_new_process(tmp_path: Path) -> None:
    page = (Path(__file__).parents[2] / "docs" / "environments.md").read_text()
    snippet = page.split("```python\n", 1)[1].split("```", 1)[0]
    line = next(line for line in snippet.splitlines() if "gymnasium.make" in line)
    name = line.split('"')[1]
    code = f"import gymnasium; gymnasium.make({name!r}, ticks=0)"  # refused by the environment, so that it was found
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=tmp_path)
    assert (
        done.stderr.splitlines()[-1]
        == "clamber.errors.OptionError: ticks: 0 control periods; an action lasts 1 or more"
    )


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"ticks": 0}, "an action lasts 1 or more"),
        ({"seconds": -1.0}, "an episode lasts more than 0"),
        ({"task": "ladder"}, "environments are of robots in space"),
    ],
)
def test_what_no_environment_can_be_made_of_is_refused_with_a_reason(more: dict[str, object], said: str) -> None:
    with pytest.raises(ClamberError, match=re.escape(said)):
        made("clamber/Climb-v0", **more)
