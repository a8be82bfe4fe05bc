"""Environments of robots in space keep to Gymnasium's rules, and an episode of our own controller carries the plan out."""

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
