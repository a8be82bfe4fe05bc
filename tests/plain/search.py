"""Small boards, and breadth-first search over everything that can be done on them: what exact answers are held against."""

import numpy as np

from clamber.compiled import kernel
from clamber.planning.problem.family_kernels import bound, key, restore
from clamber.planning.problem.problem import CompiledProblem

NO_HANGS = "rules.max_hangs=0"
UNCLIMBABLE = (NO_HANGS, "step.length=3in", 'rules.allowed=["+y","-y","grab","release"]', "goal.y_min=60in")
SMALL = {
    "short ladder": ("ladder", (NO_HANGS, "goal.y_min=24in")),
    "ladder, three rungs, 6 in": ("ladder", (NO_HANGS, "step.length=6in", "goal.y_min=30in")),
    "modified ladder, start of the gap": ("modified-ladder", (NO_HANGS, "step.length=3in", "goal.y_min=18in")),
    "no way up": ("modified-ladder", UNCLIMBABLE),
    "one limb grabs no more": ("ladder", (NO_HANGS, "goal.y_min=24in", 'rules.allowed=["+y","grab"]')),
    "walker": ("patch-walk", ("goal.x_min=0.3m", "step.length=80mm", "step.angle=30deg")),
}


@kernel
def key_and_bound(p, stances, words, bounds):
    for i in range(stances.shape[0]):
        key(p, stances[i], words[i])
        bounds[i] = bound(p, stances[i])


@kernel
def restored(p, words, stances):
    for i in range(words.shape[0]):
        restore(p, words[i], stances[i])


def keys_of(problem: CompiledProblem, stances: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    words = np.zeros((len(stances), problem.key_words), np.int64)
    bounds = np.zeros(len(stances))
    key_and_bound(problem.params.record, stances, words, bounds)
    return words, bounds


def breadth_first(problem: CompiledProblem, most: int = 60_000) -> tuple[int | None, dict[bytes, int]]:
    """Length of the shortest plan by plain breadth-first search (None: there is none), and the depth of every stance."""
    seen = {keys_of(problem, problem.start)[0].tobytes(): 0}
    layer = problem.start
    depth = 0
    while len(layer) and len(seen) < most:
        if any(problem.is_done(layer[i : i + 1]) for i in range(len(layer))):
            return depth, seen
        children = problem.expand(layer).stance
        words, _ = keys_of(problem, children)
        fresh = []
        for i, word in enumerate(words):
            mark = word.tobytes()
            if mark not in seen:
                seen[mark] = depth + 1
                fresh.append(i)
        layer = children[fresh]
        depth += 1
    assert len(seen) < most, "the board is not small"
    return None, seen
