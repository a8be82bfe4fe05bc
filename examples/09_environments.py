"""Environments for reinforcement learning, and what a learner is to be held against: no torque at all, and our own controller.

`python examples/09_environments.py out 10` takes ten seeds of each environment under noise; the table of docs/environments.md is that.
A third number is how many control periods of 2.5 ms an action lasts, two without it.
"""

import sys
from pathlib import Path
from statistics import mean

import gymnasium
import numpy as np

from clamber.families.spatial.environment_baseline import carry_out

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
out.mkdir(exist_ok=True)
seeds = range(1, 1 + int(sys.argv[2] if len(sys.argv) > 2 else 1))
ticks = int(sys.argv[3] if len(sys.argv) > 3 else 2)
rows = ["environment,noise,who,seed,return,progress,seconds,done"]


def idle(env: gymnasium.Env, seed: int) -> tuple[float, float, float, bool]:
    """An episode without a torque."""
    env.reset(seed=seed)
    total, over = 0.0, False
    while not over:
        _, reward, ended, late, told = env.step(np.zeros(env.action_space.shape, np.float32))
        total, over = total + float(reward), ended or late
    return total, told["progress"], env.unwrapped.plant.time, told["done"]


def ours(env: gymnasium.Env, seed: int) -> tuple[float, float, float, bool]:
    """An episode of our controller."""
    episode = carry_out(env.unwrapped, seed)
    return episode.total, episode.progress, episode.seconds, episode.done


MODULE = "clamber.families.spatial.environment"  # that Gymnasium imports, for it knows the names
for name in ("clamber/Climb-v0", "clamber/Walk-v0"):
    for noise in ("none", "usual"):
        env = gymnasium.make(f"{MODULE}:{name}", noise=[noise], ticks=ticks, disable_env_checker=True)
        for act in (idle, ours):
            told = [act(env, seed) for seed in (seeds if noise == "usual" else seeds[:1])]
            totals, parts, times, done = zip(*told, strict=True)
            print(
                f"{name}, noise {noise}, {act.__name__}: {sum(done)} of {len(done)} done, return {mean(totals):.2f} on average "
                f"({min(totals):.2f} to {max(totals):.2f}), {100 * mean(parts):.0f} % of the plan, {mean(times):.1f} s"
            )
            for seed, row in zip(seeds, told, strict=False):
                rows.append(
                    f"{name},{noise},{act.__name__},{seed},{row[0]:.4f},{row[1]:.4f},{row[2]:.2f},{int(row[3])}"
                )

(out / "environments.csv").write_text("\n".join(rows) + "\n")
