"""Make any plan shorter: a beam search about it, exact windows between its own stances, the shortest path through the stances about it."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from ..errors import SpecError
from ..interrupts import Interruptible
from ..tasks import Task
from ..types import Ints
from .beam_layers import Corridor, search_layers
from .problem.plan import Plan
from .problem.problem import CompiledProblem, Records
from .problem.problems import goal_step, plan_family, pose_problem
from .progress import Clock, Listener, Shortening
from .result import PlanResult
from .shorten_kernels import Graph, Line, Tree, collect, search_window, shortest, stance_keys
from .stance_table import path_to, rehash, scratch_for, table_size

SHORTEST_WINDOW: Final = 6
"""Actions of the smallest window."""
WINDOW_GROWTH: Final = 1.5
"""A window's length as a multiple of the one before."""


@dataclass(frozen=True, slots=True)
class Shortened:
    """A plan made shorter, and what that cost."""

    codes: Ints
    """The plan; the one given where nothing helped."""
    stances: int
    """Stances seen, all searches together."""
    checks: int
    """Actions judged."""
    complete: bool
    """Whether every search ended by itself, rather than by its limit."""
    interrupted: bool = False
    """Whether Ctrl-C ended it; the plan is the shortest up to then."""


class WindowSearch:
    """The memory of window searches, used again for each."""

    def __init__(self, problem: CompiledProblem, most: int) -> None:
        """Take memory for windows of at most `most` stances."""
        capacity = most + problem.branching
        self.tree = Tree(
            keys=np.zeros((capacity, problem.key_words), np.int64),
            g=np.zeros(capacity, np.int32),
            closed=np.zeros(capacity, np.uint8),
            parent=np.zeros(capacity, np.int32),
            code=np.zeros(capacity, np.int32),
            entries=np.zeros(capacity, np.int32),
            following=np.zeros(capacity, np.int64),
            heads=np.zeros(0, np.int64),
            table=np.zeros(table_size(capacity), np.int32),
        )
        self.room = scratch_for(problem)
        self.state = np.zeros(5, np.int64)
        self.seen = 0
        self.checks = 0
        self.complete = True

    def shorten(
        self, problem: CompiledProblem, codes: Ints, plan: Records, window: tuple[int, int]
    ) -> tuple[Ints, Records]:
        """The plan with a shorter way from its stance `first` on, or as it is, and its stances.

        A window that ends where the plan does may end in any goal stance.

        Args:
            problem: The task.
            codes: A plan that holds; every hold named.
            plan: Its stances, start included.
            window: Its first and last stance.
        """
        first, last = window
        to_goal = last == len(codes)
        near = problem if to_goal else problem.without_more_hangs(plan[first : first + 1])
        if not to_goal and near is not problem and plan["hangs"][last] != plan["hangs"][first]:
            near = problem
        params = near.params.record
        keys = np.zeros((len(plan), problem.key_words), np.int64)
        stance_keys(params, plan, keys)
        table = np.full(table_size(len(plan)), -1, np.int32)
        rehash(keys, len(plan), table)
        tree = self.tree._replace(heads=np.zeros(len(plan) + 1, np.int64))
        search_window(params, Line(plan, keys, table), (first, last), to_goal, tree, self.room, self.state)
        nodes, judged, node, rejoined, saved = (int(value) for value in self.state)
        self.seen += nodes
        self.checks += judged
        self.complete &= nodes + problem.branching <= len(tree.keys)
        if not saved:
            return codes, plan
        way = path_to(tree.parent, tree.code, node)
        shorter = np.concatenate([codes[:first], way, codes[rejoined:]]).astype(np.int32)
        stances = stances_to_goal(problem, shorter)
        return (codes, plan) if stances is None else (shorter, stances)


def shorten_by_windows(
    problem: CompiledProblem,
    codes: Ints,
    *,
    most: int = 20_000,
    effort: int = 1_000_000,
    seconds: float | None = None,
    tell: Callable[[int], None] | None = None,
) -> Shortened:
    """Make a plan shorter: windows of growing length slide over it until none saves an action.

    Args:
        problem, codes, seconds, tell: As in `shorten`.
        most: Most stances of one window.
        effort: Most stances of all windows together; the last window may go beyond it.
    """
    clock = Clock(seconds)
    search = WindowSearch(problem, most)
    length, first = SHORTEST_WINDOW, 0
    plan = problem.replay(codes).stances
    with Interruptible() as block:
        while len(codes) > 1:
            if search.seen >= effort or clock.is_over:
                search.complete = False
                break
            length = min(length, len(codes))
            before = len(codes)
            codes, plan = search.shorten(problem, codes, plan, (first, min(before, first + length)))
            if tell is not None:
                tell(len(codes))
            if len(codes) < before:
                first = max(0, first - length // 2)
            elif first + length < before:
                first += max(1, length // 3)
            elif length < before:
                length, first = int(WINDOW_GROWTH * length), 0
            else:
                break
    return Shortened(codes, search.seen, search.checks, search.complete and not block.interrupted, block.interrupted)


def stances_to_goal(problem: CompiledProblem, codes: Ints) -> Records | None:
    """Stances of codes that hold all the way and end in a goal stance, start included; None of others."""
    replayed = problem.replay(codes)
    return replayed.stances if replayed.ok and problem.is_done(replayed.stances[-1:]) else None


FIRST_CORRIDOR: Final = 10_000
"""Stances of the first corridor."""
CORRIDOR_GROWTH: Final = 4
"""Stances of a corridor as a multiple of those of the one before, when that held nothing shorter."""
EDGES_PER_STANCE: Final = 12
"""Ways on per stance that memory is taken for; where there are more, the corridor gets narrower."""


def shorten_in_corridor(
    problem: CompiledProblem,
    codes: Ints,
    *,
    most: int = 200_000,
    effort: int = 1_000_000,
    seconds: float | None = None,
    tell: Callable[[int], None] | None = None,
) -> Shortened:
    """Make a plan shorter: the shortest plan among all stances near it, again and again, in corridors that widen until none helps.

    The neighbourhood graph of Nakhost and Mueller (Action elimination and plan neighborhood graph search, ICAPS 2010), without the
    stances that no shorter plan can visit.

    Args:
        problem, codes, seconds, tell: As in `shorten`.
        most: Most stances of one corridor: memory, about 100 bytes and a key each.
        effort: Most stances of all corridors together; the last corridor may go beyond it.
    """
    clock = Clock(seconds)
    size, seen, checks, complete = min(FIRST_CORRIDOR, most), 0, 0, False
    with Interruptible() as block:
        while not complete and seen < effort and not clock.is_over:
            before = len(codes)
            codes, nodes, judged, complete = _through(problem, codes, size)
            seen += nodes
            checks += judged
            if tell is not None:
                tell(len(codes))
            if len(codes) < before:
                continue
            if size >= most:
                break
            size = min(most, CORRIDOR_GROWTH * size)
    return Shortened(codes, seen, checks, complete and not block.interrupted, block.interrupted)


def _through(problem: CompiledProblem, codes: Ints, size: int) -> tuple[Ints, int, int, bool]:
    """The shortest plan in a corridor; stances and actions that it took; whether every stance that matters was in it."""
    plan = problem.replay(codes).stances
    room = size + len(plan) + problem.branching
    graph = Graph(
        keys=np.zeros((room, problem.key_words), np.int64),
        leads=np.zeros(room, np.uint8),
        table=np.full(table_size(room), -1, np.int32),
        first_edge=np.zeros(room + 1, np.int64),
        edge_to=np.zeros(EDGES_PER_STANCE * room, np.int32),
        edge_code=np.zeros(EDGES_PER_STANCE * room, np.int32),
    )
    state = np.zeros(3, np.int64)
    collect(problem.params.record, plan, graph, scratch_for(problem), state)
    nodes, expanded, judged = (int(value) for value in state)
    parent, code = np.zeros((2, nodes), np.int32)
    goal = shortest(expanded, graph, parent, code, np.zeros(nodes, np.int32))
    complete = expanded == nodes
    if goal < 0:
        return codes, nodes, judged, complete
    way = path_to(parent, code, goal)
    better = len(way) < len(codes) and stances_to_goal(problem, way) is not None
    return way if better else codes, nodes, judged, complete


def shorten_by_beam(
    problem: CompiledProblem,
    codes: Ints,
    *,
    width: int,
    steps: float = 10.0,
    seconds: float | None = None,
) -> Shortened:
    """Search for a shorter plan whose body stays near that of a given one.

    Args:
        problem, codes, seconds: As in `shorten`.
        width: Stances kept of each layer.
        steps: How far the body may go from the plan's places, in body steps of the plan.
    """
    stances = problem.replay(codes).stances
    places = np.stack([stances["x"], stances["y"]], axis=1)
    strides = np.hypot(*np.diff(places, axis=0).T)
    moved = strides[strides > 0.0]
    radius = steps * float(np.median(moved)) if len(moved) else 0.0
    reached = search_layers(
        problem,
        replace(problem.beam, width=width, longest=max(0, len(codes) - 1)),
        corridor=Corridor(places, radius),
        seconds=seconds,
    )
    better = reached.found and len(reached.codes) < len(codes) and stances_to_goal(problem, reached.codes) is not None
    return Shortened(reached.codes if better else codes, reached.stances, reached.checks, False, reached.interrupted)


WIDTH: Final = 300
"""Stances kept of each layer of the beam."""
WINDOW: Final = 3_000
"""Most stances of one window."""
CORRIDOR: Final = 40_000
"""Most stances of one corridor: memory, about 250 bytes each."""
EFFORT: Final = 300_000
"""Most stances of windows and corridors together, unless told otherwise."""


def shorten(
    problem: CompiledProblem,
    codes: Ints,
    *,
    width: int = WIDTH,
    effort: int = EFFORT,
    seconds: float | None = None,
    tell: Callable[[int], None] | None = None,
) -> Shortened:
    """Make a plan shorter; it stays valid, and ends in a goal stance.

    Args:
        problem: The task. One whose actions can't be listed (`CompiledProblem.incomplete`) leaves the plan as it is.
        codes: A plan that holds and reaches the goal; every hold named (`CompiledProblem.resolve`).
        width: Width of the beam about the plan; 0 for none.
        effort: Most stances of windows and corridors; 0 for none.
        seconds: Most time [s]; a search that it ends is not repeatable.
        tell: Called with the length of the plan now and then.

    Returns:
        The plan, never longer; `complete` if it is proved that no plan of the task is shorter.
    """
    done = Shortened(codes, 0, 0, complete=not len(codes))
    if problem.incomplete is not None or not len(codes):
        return done
    clock = Clock(seconds)
    if width:
        done = shorten_by_beam(problem, codes, width=width, seconds=clock.left)
        if tell is not None:
            tell(len(done.codes))
    if effort and not done.interrupted:
        near = shorten_by_windows(problem, done.codes, most=WINDOW, effort=effort, seconds=clock.left, tell=tell)
        done = _then(done, near)
        effort -= near.stances
    if effort > 0 and not done.interrupted:
        wide = shorten_in_corridor(problem, done.codes, most=CORRIDOR, effort=effort, seconds=clock.left, tell=tell)
        done = _then(done, wide)
    return done


def _then(first: Shortened, second: Shortened) -> Shortened:
    return replace(second, stances=first.stances + second.stances, checks=first.checks + second.checks)


def polish_plan(
    task: Task,
    plan: Plan,
    *,
    width: int = WIDTH,
    effort: int = EFFORT,
    seconds: float | None = None,
    progress: Listener | None = None,
    label: str = "plan",
) -> PlanResult:
    """Make a plan shorter (`planning.shorten`).

    Args:
        task: The task to carry it out in.
        plan: A plan that holds and reaches the goal; what comes after the goal is left out.
        width, effort, seconds: As in `shorten`.
        progress: Called now and then.
        label: What errors call the plan.

    Returns:
        The plan ("found"; "optimal" where every shorter one was ruled out).

    Raises:
        SpecError: If the plan breaks a hard check on its way to the goal, or does not get there.
    """
    clock = Clock(seconds)
    problem = pose_problem(task).problem
    codes = plan.codes(task, label)
    stances = problem.replay(codes).stances
    end = goal_step(problem, codes, stances)
    if stances_to_goal(problem, codes[:end]) is None:
        allowed = "must hold up to the goal and reach it; `clamber check` says where it does not"
        raise SpecError(label, "actions", f"{len(codes)} actions", allowed)

    def tell(length: int) -> None:
        if progress is not None:
            progress(Shortening(length))

    done = shorten(problem, codes[:end], width=width, effort=effort, seconds=seconds, tell=tell)
    family = plan_family(task)
    after = problem.replay(done.codes).stances[1:]
    cut = len(codes) - len(done.codes)
    reason = f"{len(codes)} actions before, {cut} fewer now" if cut else "no shorter plan was found about it"
    made = Plan.of_codes(task, done.codes, seed=plan.seed, planner=f"{plan.planner}, polished" if cut else plan.planner)
    return PlanResult(
        status="optimal" if done.complete else "found",
        plan=made if cut else replace(plan),
        task=task,
        reason=reason,
        evaluations=0,
        checks=done.checks,
        seconds=clock.spent,
        seed=plan.seed or 0,
        planner=made.planner,
        max_torque=max((family.torque(stance) for stance in after), default=0.0),
        lower_bound=len(done.codes) if done.complete else None,
        stances=done.stances,
        model=family.model(task) if done.complete else "",
        first_length=len(codes),
    )
