"""The rival `mcts`: Monte-Carlo tree search for one player, with transpositions, that commits to one action at a time."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from ..planning.problem.problem import Records
from ..planning.progress import Listener
from ..planning.result import PlanResult
from ..planning.stance_table import scratch_for, table_size
from ..tasks import Task
from .mcts_kernels import CHECKS, DEAD, EDGES, NODES, TABU, Lines, Manner, Tree, enter, simulate
from .rivals import LONGEST, MAX_CHECKS, SearchBudget, guidance

MAX_STANCES: Final = 500_000
"""Nodes kept unless told otherwise: about 160 bytes each for the climber, edges included. A full tree is dropped, and a new
one grows from the action that it favours."""


@dataclass(frozen=True, slots=True)
class Settings:
    """How the tree is searched.

    Every descent from the start has a care, the next number of Luby's sequence: where quick descents end in a pocket, a
    careful one, that looks further and explores more before each action, comes in time.
    """

    explore: float = 0.5
    """Exploration constant of UCB1, for values scaled to 0..1 by the range seen from the present root [-]."""
    wariness: float = 0.5
    """What a doubled care adds to the exploration constant, as a share of it [-]."""
    boldness: float = 0.5
    """Weight of a node's best value against its mean: a plan is wanted, not a good average (Schadd et al. 2008) [-]."""
    visits: int = 100
    """Of the root, before the search commits to an action; those from before it was the root count. Times the care."""
    patience: int = 30
    """Commitments in a row after which no simulation saw anything better, before the search starts again from the start."""
    horizon: int = 2
    """Most actions of a simulation's random walk. Times the care."""
    again: float = 0.5
    """Probability of a walk to do the same as before, where it can."""


def plan_mcts(
    task: Task,
    *,
    seed: int = 0,
    seconds: float | None = None,
    threads: int | None = None,
    max_checks: int = MAX_CHECKS,
    max_stances: int = MAX_STANCES,
    progress: Listener | None = None,
    settings: Settings | None = None,
) -> PlanResult:
    """Search a tree of stances by UCT, commit to the most visited action, and so on to the goal; start again till the budget ends.

    Each simulation goes down by UCB1 to a leaf, adds its children at the second visit, walks on at random, and hands back
    the progress of the best stance that the walk saw.

    Args:
        task: What to plan.
        seed: Same seed, same plan.
        seconds: Most time [s].
        threads: The search runs on one.
        max_checks: Most actions to judge.
        max_stances: Memory: most nodes of the tree.
        progress: Called after every descent.
        settings: How the tree is searched.

    Returns:
        "found" with the shortest plan, or "stopped" with the furthest stance.

    Raises:
        PlannerError: If the task allows actions that can't be listed one by one.
    """
    hunt = SearchBudget("mcts", task, seed, max_checks, seconds, progress)
    tree = _Tree(hunt, min(max_stances, max_checks + 1), settings or Settings())
    with hunt:
        before = -1
        while not hunt.is_over and hunt.checks > before:
            before = hunt.checks
            tree.descend()
            hunt.tell()
    return hunt.result()


def luby(k: int) -> int:
    """The k-th number (from 1) of 1 1 2 1 1 2 4 1 1 2 ...: the best schedule of restarts for one who knows nothing (Luby et al. 1993)."""
    size = k.bit_length()
    return 1 << (size - 1) if k == (1 << size) - 1 else luby(k - (1 << (size - 1)) + 1)


class _Tree:
    """The arrays of a search, and one descent through them."""

    def __init__(self, hunt: SearchBudget, most: int, settings: Settings) -> None:
        problem = hunt.problem
        self.hunt, self.settings = hunt, settings
        self.descents = 0
        self.weights = guidance(problem)
        capacity = max(most, LONGEST) + 2 * problem.branching  # the way to the root always has room
        edges = 4 * capacity
        self.tree = Tree(
            keys=np.zeros((capacity, problem.key_words), np.int64),
            visits=np.zeros(capacity, np.int32),
            total=np.zeros(capacity),
            top=np.zeros(capacity),
            first=np.zeros(capacity, np.int32),
            edges=np.zeros(capacity, np.int32),
            mark=np.zeros(capacity, np.int64),
            child_of=np.zeros(edges, np.int32),
            code_of=np.zeros(edges, np.int32),
            table=np.zeros(table_size(capacity), np.int32),
        )
        self.lines = Lines(
            path=np.zeros(LONGEST + 1, np.int32),
            tried=np.zeros(problem.branching, np.int32),
            trail=np.zeros(LONGEST + 1, np.int32),
            plan=np.zeros(LONGEST + 1, np.int32),
            scale=np.zeros(2),
        )
        self.room = scratch_for(problem, 4)
        self.state = np.zeros(4, np.int64)

    def descend(self) -> None:
        """From the start, action by action, until a plan is found, nothing new is left to do, or the budget ends."""
        hunt, state = self.hunt, self.state
        self.descents += 1
        here = hunt.problem.start
        way: list[int] = []
        passed = [here]
        root = self._grow_anew(passed)
        furthest, stale = -np.inf, 0
        while not hunt.is_over and len(way) < hunt.longest and stale < self.settings.patience:
            self.lines.scale[:] = np.inf, -np.inf
            length = self._simulate(root, len(way))
            hunt.checks = int(state[CHECKS])
            if length >= 0:
                codes = np.concatenate([way, self.lines.plan[:length]]).astype(np.int32)
                hunt.take(codes, np.inf, found=True)
                continue
            edge = self._most_visited(root)
            if edge < 0:
                break
            way.append(int(self.tree.code_of[edge]))
            root = int(self.tree.child_of[edge])
            self.tree.mark[root] = TABU
            here = hunt.problem.rebind(hunt.problem.actions, here).replay(np.array(way[-1:], np.int32)).stances[-1:]
            passed.append(here)
            hunt.take(np.array(way, np.int32), hunt.problem.progress(here), found=hunt.problem.is_done(here))
            if hunt.problem.is_done(here):
                break
            room = len(self.tree.keys) - state[NODES], len(self.tree.child_of) - state[EDGES]
            if min(room) < hunt.problem.branching:
                root = self._grow_anew(passed)
            stale = 0 if self.lines.scale[1] > furthest else stale + 1
            furthest = max(furthest, self.lines.scale[1])

    def _simulate(self, root: int, depth: int) -> int:
        set_up, care = self.settings, luby(self.descents)
        explore = set_up.explore * (1.0 + set_up.wariness * np.log2(care))
        horizon, visits = min(LONGEST, set_up.horizon * care), set_up.visits * care
        hunt, again = self.hunt, set_up.again
        how = Manner(explore, set_up.boldness, again, horizon, hunt.longest, visits, hunt.max_checks, hunt.seed)
        params, at = hunt.problem.params.record, (root, depth)
        return int(simulate(params, self.weights, self.tree, self.room, self.state, at, how, self.lines))

    def _most_visited(self, root: int) -> int:
        """The edge to the child with the most visits that is neither dead nor on the way here; -1: there is none."""
        edges = np.arange(self.tree.first[root], self.tree.first[root] + self.tree.edges[root])
        children = self.tree.child_of[edges]
        free = (self.tree.mark[children] != TABU) & (self.tree.first[children] != DEAD)
        if not free.any():
            return -1
        return int(edges[np.argmax(np.where(free, self.tree.visits[children], -1))])

    def _grow_anew(self, passed: list[Records]) -> int:
        """An empty tree but for the stances on the way, the last of which is its root."""
        self.tree.table[:] = -1
        self.state[NODES] = self.state[EDGES] = 0
        for stance in passed:
            root = enter(self.hunt.problem.params.record, stance[0], self.tree, self.room.words, self.state)
            self.tree.mark[root] = TABU
        return int(root)
