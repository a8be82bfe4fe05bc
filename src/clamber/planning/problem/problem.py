"""A family bound to a task, as planners see it: batches of arrays in, batches of arrays out."""

import copy
import math
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any, ClassVar, Final, Self

import numpy as np
import numpy.typing as npt

from ...errors import SpecError
from ...types import Floats
from .arrays import ActionTable, Children, CostToGoMap, Params, ScoredChildren
from .code_limits import CodeLimits, indices
from .loops import expand, expand_scored, features_of, possible, replay, rollout

MAX_FEATURES = 8
FEATURE_NAMES: Final = ("body", "limbs", "effort", "stages", "length", "unstable", "peak")
"""Features of actions that the families here measure, so that one profile's weights fit all."""
FEATURE_KINDS: Final = (0, 0, 1, 0, 1, 1, 2)
"""How each of them adds up over a plan: 0 the last, 1 the sum, 2 the largest."""
PIECES = 8
"""Most pieces of a batch that one thread takes."""
LEAST_PIECE = 64
"""Fewest plans of a piece, where a batch is cut into several per thread."""
ROLLOUT = np.dtype(
    [
        ("fitness", "f8"),  # at the stop
        ("best", "f8"),  # largest fitness of any prefix
        ("features", "f8", (MAX_FEATURES,)),
        ("cell", "i8"),
        ("genes", "i4"),  # genes that held
        ("actions", "i4"),  # actions that held
        ("checks", "i4"),  # actions tried
        ("best_genes", "i4"),  # genes of the prefix with the best fitness
        ("reason", "i4"),  # check that stopped it; -1: none, -2: too many actions
        ("done", "i4"),
    ],
    align=True,
)
Records = npt.NDArray[np.void]


@dataclass(frozen=True, slots=True)
class Replay:
    """A plan carried out: stances (n + 1), margins (n, n_checks), reasons (n; -1 where the action holds)."""

    stances: Records
    margins: Floats
    reasons: npt.NDArray[np.int32]

    @property
    def ok(self) -> bool:
        """Whether every action holds."""
        return bool(np.all(self.reasons < 0))


@dataclass(frozen=True, slots=True, kw_only=True)
class Beam:
    """The settings of a beam search; lengths in actions."""

    width: int = 500
    """Stances kept of each layer."""
    niche: int = 20
    """Most of one niche in a layer: same goals met, same contacts, nearby."""
    longest: int = 400
    """Layers, so actions of a plan."""
    toll: float = 0.0
    """What a stance's score loses per action that the family's bound says is left."""
    weights: tuple[tuple[str, float], ...] = (("body", 1.0), ("limbs", 0.1), ("stages", 0.5))
    """Feature -> weight in the score."""
    polish: int = 60_000
    """Most stances that windows about the plan may see afterwards."""


class CompiledProblem:
    """A task that planners can work on, its family a set of kernels: the loops of `loops.py`, spread over threads.

    The answer does not depend on the number of threads: every plan is carried out alone. Kernels take codes and indices as they are, and
    one that does not exist would make them use memory that is not theirs; so whatever is handed in is looked at here first.
    """

    stance_costs: ClassVar[tuple[str, ...]] = ()
    """Names of what the family's kernel `stance_cost` writes, each with its unit at the end."""
    foreseen: ClassVar[tuple[str, ...]] = ()
    """Features that the family's kernel `draft` tells of an action before it is judged; none where it has no such kernel."""
    beam: ClassVar[Beam] = Beam()
    """What suits the family's robots, unless told otherwise."""

    def __init__(
        self,
        params: Params,
        start: Records,
        actions: ActionTable,
        checks: tuple[str, ...],
        features: tuple[str, ...],
        threads: int | None = None,
    ) -> None:
        self.params = params
        self.start = start
        self.actions = self.limits.table(actions)
        self.checks = checks
        self.features = features
        self.threads = max(1, threads if threads is not None else (os.cpu_count() or 1))
        self._pool: ThreadPoolExecutor | None = None
        self._kept: list[Params] = []
        self._scratch = [self._make_scratch() for _ in range(self.threads)]

    @property
    def limits(self) -> CodeLimits:
        """The codes, and the indices in stances, that there are here."""
        raise NotImplementedError

    def _make_scratch(self) -> tuple[Any, Records, Floats, Floats]:
        params = self.params.for_thread()
        self._kept.append(params)
        stances = np.zeros(3, self.start.dtype)
        return params.record, stances, np.zeros(len(self.checks)), np.zeros((2, len(self.features)))

    def rollout(
        self, genes: npt.NDArray[np.int32], lengths: npt.NDArray[np.int32], weights: Floats, limit: int
    ) -> Records:
        """Carry out many plans, each up to its goal or its first failure.

        Args:
            genes: Entries of the action table, shape (n, longest).
            lengths: Genes of each plan, shape (n,).
            weights: One per feature.
            limit: Most actions of a plan.

        Returns:
            Records of `ROLLOUT`, shape (n,).

        Raises:
            SpecError: If a gene is no entry of the table, or a weight is missing.
        """
        genes, lengths = self.limits.genes(genes, lengths, self.actions)
        weights = self._weights(weights)
        out = np.zeros(len(genes), ROLLOUT)

        def part(worker: int, first: int, end: int) -> None:
            params, *scratch = self._scratch[worker]
            table = self.actions.offsets, self.actions.codes
            rollout(params, self.start, (genes, lengths, limit), (first, end), table, weights, tuple(scratch), out)

        self._spread(len(genes), part)
        return out

    def _weights(self, weights: Floats) -> Floats:
        taken = np.ascontiguousarray(weights, np.float64)
        if taken.shape != (len(self.features),):
            allowed = f"must be one number for each of {', '.join(self.features)}"
            raise SpecError(self.limits.label, "weights", taken.tolist(), allowed)
        return taken

    def _spread(self, n: int, part: Callable[[int, int, int], None]) -> None:
        """Run `part(worker, first, end)` over n items: spread over the pool, or here if there are few.

        Every worker takes several pieces from all over the batch, so that a run of long plans keeps no one waiting.
        """
        if self.threads == 1 or n < 4 * self.threads:
            part(0, 0, n)
            return
        if self._pool is None:
            self._pool = ThreadPoolExecutor(self.threads, thread_name_prefix="clamber")
        pieces = self.threads * max(1, min(PIECES, n // (LEAST_PIECE * self.threads)))
        cuts = np.linspace(0, n, pieces + 1).astype(int).tolist()

        def work(worker: int) -> None:
            for piece in range(worker, pieces, self.threads):
                part(worker, cuts[piece], cuts[piece + 1])

        for job in [self._pool.submit(work, worker) for worker in range(self.threads)]:
            job.result()

    def replay(self, codes: Sequence[int] | npt.NDArray[np.int32], *, go_on: bool = False) -> Replay:
        """Carry out one plan and keep every stance, margin and reason; stops at the first violation unless `go_on`.

        Raises:
            SpecError: If a code is no action of this task.
        """
        packed = self.limits.codes(codes)
        stances = np.zeros(len(packed) + 1, self.start.dtype)
        margins = np.full((len(packed), len(self.checks)), np.nan)
        reasons = np.full(len(packed), -1, np.int32)
        n = replay(self._scratch[0][0], self.start, packed, go_on, stances, margins, reasons)
        return Replay(stances[: n + 1], margins[:n], reasons[:n])

    def expand(self, stances: Records) -> Children:
        """Every valid child of every stance.

        Raises:
            SpecError: If a stance names a limb, hold or goal that does not exist.
        """
        self.limits.stances(stances, self.start.dtype)
        most = self.branching
        parts: list[Children] = []
        first = 0
        params, _, margins, _ = self._scratch[0]
        codes = np.zeros(most, np.int32)
        while first < len(stances):
            room = max(4 * most, 16 * (len(stances) - first))
            children = np.zeros(room, self.start.dtype)
            parent, code = np.zeros(room, np.int32), np.zeros(room, np.int32)
            n, first = expand(params, stances, (first, len(stances)), (codes, margins), children, parent, code)
            parts.append(Children(parent[:n], code[:n], children[:n]))
        return Children(
            np.concatenate([part.parent for part in parts]),
            np.concatenate([part.code for part in parts]),
            np.concatenate([part.stance for part in parts]),
        )

    def scored_children(self, n: int) -> ScoredChildren:
        """Memory for the children of up to n stances."""
        slots = self.branching
        return ScoredChildren(
            np.zeros(n, np.int32),
            np.zeros((n, slots), np.int32),
            np.zeros((n, slots)),
            np.zeros((n, slots), np.int64),
            np.zeros((n, slots), np.uint8),
            np.zeros((n, slots, self.key_words), np.int64),
        )

    def drafts(self, weights: Floats) -> bool:
        """Whether children can be scored by these weights of the features before they are judged."""
        return all(name in self.foreseen for name, weight in zip(self.features, weights, strict=True) if weight)

    def expand_scored(self, stances: Records, weights: Floats, toll: float, out: ScoredChildren) -> None:
        """Write every valid child of every stance, scored: weights times features, less `toll` times the bound on what is left.

        Where the score can be told before an action is judged (`drafts`), children are not judged, and may not be valid.

        Raises:
            SpecError: If a stance names a limb, hold or goal that does not exist, or a weight is missing.
        """
        self.limits.stances(stances, self.start.dtype)
        weights = self._weights(weights)
        assert len(stances) <= len(out.count), "memory for fewer stances"

        def part(worker: int, first: int, end: int) -> None:
            params, child, margins, row = self._scratch[worker]
            codes = np.zeros(self.branching, np.int32)
            scratch = margins, row[0], child, codes
            found = out.code, out.score, out.cell, out.done, out.keys
            drafts = self.drafts(weights)
            expand_scored(params, stances, (first, end), drafts, (weights, toll), scratch, out.count, found)

        self._spread(len(stances), part)

    def possible(self, genes: npt.NDArray[np.int32]) -> npt.NDArray[np.uint8]:
        """Which table entries hold after a plan that holds (the configuration filter), one byte per entry."""
        genes = indices(genes, len(self.actions), "genes", self.limits.label)
        params, stances, margins, _ = self._scratch[0]
        mask = np.zeros(len(self.actions), np.uint8)
        possible(params, self.start, genes, (self.actions.offsets, self.actions.codes), stances, margins, mask)
        return mask

    def rebind(self, actions: ActionTable, start: Records | None = None) -> Self:
        """The same problem with another inventory, and from another stance if one is given; threads and scratch are shared."""
        other = copy.copy(self)
        other.actions = actions if actions is self.actions else self.limits.table(actions)
        if start is not None:
            other.start = self.limits.stances(start, self.start.dtype)
        return other

    def with_rules(self, **fields: int) -> Self:
        """The same problem with some fields of its parameters changed; it works on one thread."""
        return self._with_params(self.params.with_fields(**fields))

    def _with_params(self, params: Params) -> Self:
        """The same problem with other parameters, on one thread."""
        other = copy.copy(self)
        other.params = params
        other.threads, other._pool, other._kept = 1, None, []
        other._scratch = [other._make_scratch()]
        return other

    def without_more_hangs(self, stance: Records) -> Self:
        """The same problem without the actions that `heuristic_between` can't bound from `stance` on; most families have none."""
        return self

    def resolve(self, codes: npt.NDArray[np.int32], stances: Records) -> npt.NDArray[np.int32]:
        """Codes with every choice that the world made for them written down; `stances` are those of the plan's replay."""
        return codes

    def relative(self, codes: npt.NDArray[np.int32], stances: Records) -> npt.NDArray[np.int32]:
        """Codes that say what to do from where the robot is, rather than name places; `stances` are those of the plan's replay."""
        return codes

    def measured(self, stances: Records) -> Floats:
        """Features of stances as actions led to them, shape (n, n_features)."""
        self.limits.stances(stances, self.start.dtype)
        rows = np.zeros((len(stances), len(self.features)))
        for i, row in enumerate(rows):
            features_of(self.params.record, stances[i : i + 1], row)
        return rows

    def progress(self, stance: Records) -> float:
        """The feature `body` of a stance (array of one record): how far along the goals the body is [m]."""
        return float(self.measured(stance)[0, self.features.index("body")])

    def way_left(self, stance: Records) -> float:
        """How far the body still has to go along the goals from a stance (array of one record) [m]."""
        return self.way - self.progress(stance)

    def informed(self, is_late: Callable[[], bool] = lambda: False) -> Self:
        """The same problem with all that its family knows of bounds and symmetry, for exact search; no answer depends on it.

        Args:
            is_late: Asked again and again whether there is no more time to work such a bound out; then it is a lower one.
        """
        return self

    def mirrored(self, code: int) -> int:
        """The mirror image of an action, in a problem that is its own mirror image."""
        raise NotImplementedError

    @property
    def incomplete(self) -> str | None:
        """Why `expand` and exact search can't list all that the task allows, or None: they can."""
        return None

    def ways(self) -> CostToGoMap | None:
        """About how far it is from every place of the world to each goal; None: the family has no such map."""
        return None

    @property
    def landmarks(self) -> int:
        """How many things the world has that limbs hold or must miss: holds, or patches."""
        raise NotImplementedError

    @property
    def estimated_stances(self) -> float:
        """A rough upper estimate of the stances there are, for choosing a planner; infinite where poses leave the lattice."""
        return math.inf

    @property
    def key_words(self) -> int:
        """Integers of a stance's key."""
        raise NotImplementedError

    @property
    def branching(self) -> int:
        """Most actions that `candidates` may list from one stance."""
        raise NotImplementedError

    @property
    def goals(self) -> int:
        """Number of the task's goals."""
        return len(self.params.array("goals"))

    @property
    def way(self) -> float:
        """The feature `body` of a stance that has met every goal [m]."""
        last = self.params.array("goals")[-1]
        return float(last["before"] + last["way"])

    def is_done(self, stance: Records) -> bool:
        """Whether a stance (array of one record) has met every goal."""
        return bool(stance["stage"][0] >= self.goals)

    def without_goals(self) -> tuple[Params, Records]:
        """Parameters and start of a robot that has every goal behind it: stances differ by where they are alone."""
        start = self.start.copy()
        start["stage"] = self.goals
        return self.params.for_thread(), start

    @property
    def pose_words(self) -> int:
        """Integers that the family's kernel `body_pose` writes: the body's pose, and a hold for each limb."""
        return 3
