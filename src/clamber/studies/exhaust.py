"""Every stance that can be reached, breadth first: proves that there is no plan where a task has finitely many stances."""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from ..actions.limbed_problem import LimbedProblem
from ..actions.problem import Records
from ..actions.table import ActionTable
from ..tasks.limbed import LimbedTask
from ..types import Ints


@dataclass(frozen=True, slots=True)
class Exhausted:
    """What a search through every stance came to."""

    codes: Ints | None
    """A shortest plan that reaches the goal; None: there is none, or the search was cut short."""
    closed: bool
    """Whether every stance that can be reached was looked at; then no plan means that there is none."""
    stances: int
    """Different stances looked at."""
    highest: float
    """Largest y of the body's origin in any of them [m]."""


def exhaust(task: LimbedTask, *, without: Collection[int] = (), most: int = 2_000_000) -> Exhausted:
    """Search all stances of a task breadth first, with every hold in reach open to every grab.

    Args:
        task: The task, with `branch = "free"` and without hangs (`max_hangs = 0`), so that poses stay on the lattice.
        without: Packed codes of actions that may not be used.
        most: Stances after which the search gives up.
    """
    assert task.rules.branch == "free" and task.rules.max_hangs == 0, "the key leaves branches and hangs out"
    problem = LimbedProblem(task, ActionTable.build([]), threads=1)
    layer = problem.start
    seen = set(stance_keys(task, layer))
    ways: list[tuple[Ints, Ints]] = []
    highest = float(layer["y"].max())
    while len(layer) and len(seen) < most:
        children = problem.expand(layer)
        keys = stance_keys(task, children.stance)
        fresh = []
        for i in np.flatnonzero(~np.isin(children.code, list(without))):
            if keys[i] not in seen:
                seen.add(keys[i])
                fresh.append(i)
        layer = children.stance[fresh]
        ways.append((children.parent[fresh], children.code[fresh]))
        highest = max(highest, float(layer["y"].max(initial=highest)))
        reached = np.flatnonzero(layer["stage"] >= len(task.goals))
        if len(reached):
            return Exhausted(_way_to(int(reached[0]), ways), False, len(seen), highest)
    return Exhausted(None, not len(layer), len(seen), highest)


def stance_keys(task: LimbedTask, stances: Records) -> list[bytes]:
    """What actions and hard checks read of each stance (page "The model", section 2); equal keys have equal futures."""
    n = len(task.robot.limbs)
    held = stances["hold"][:, :n].astype(np.int64)
    in_use = stances["in_use"].astype(np.int64)
    holders = np.count_nonzero(held >= 0, axis=1)
    idle = (holders >= 3) & (np.take_along_axis(held, in_use[:, None], axis=1)[:, 0] >= 0)
    idle &= task.rules.limb_in_use == "idle"
    pose = np.stack([stances["ix"], stances["iy"], stances["ia"]], axis=1)
    told = np.stack([np.where(idle, in_use + 1, 0), stances["stage"], stances["laps"]], axis=1)
    words = np.ascontiguousarray(np.concatenate([pose, held, told], axis=1))
    return [row.tobytes() for row in words]


def _way_to(last: int, ways: list[tuple[Ints, Ints]]) -> Ints:
    codes = []
    for parent, code in reversed(ways):
        codes.append(int(code[last]))
        last = int(parent[last])
    return np.array(codes[::-1], np.int32)
