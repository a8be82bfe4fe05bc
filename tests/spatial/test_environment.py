"""Environments of robots in space keep to Gymnasium's rules, and an episode of our own controller carries the plan out."""

from itertools import pairwise

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium")


def made(name: str, **more: object) -> object:
    from clamber.families.spatial.environment import register

    register()
    return gymnasium.make(name, **more)


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
