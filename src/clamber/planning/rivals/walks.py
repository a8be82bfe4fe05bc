"""Random walks as a kernel: what the random planner is made of, and how Monte-Carlo tree search looks ahead."""

from ...compiled import inlined, kernel
from ..problem.family_kernels import candidates, done, measure, step
from ..problem.randoms import below, draw, unit


@inlined
def worth(p, s, weights, row):
    """What a stance is worth to a search: its features, weighted."""
    measure(p, s, row)
    value = 0.0
    for i in range(row.shape[0]):
        value += weights[i] * row[i]
    return value


@kernel
def wander(p, stances, codes, margins, row, weights, again, most, most_checks, seed, a, b, trail):
    """One random walk: every action is drawn from those that hold, and what the walk is worth is its best prefix.

    Args:
        p: A family's parameters.
        stances: Scratch, three records; the walk begins at the first, which it overwrites. The last is its best stance.
        codes: Scratch for candidates.
        margins: Scratch of the family's checks.
        row: Scratch for features.
        weights: Weights of the features.
        again: Probability of doing the same as before, where that is among the candidates.
        most: Most actions.
        most_checks: Most actions to judge.
        seed, a, b: Counters of the random numbers.
        trail: Output: the actions, `most` of them at most.

    Returns:
        Actions of the best prefix, what it is worth, actions judged, and whether it meets the goal.
    """
    now = 0
    stances[2] = stances[0]
    best = worth(p, stances[0], weights, row)
    best_at = 0
    checks = 0
    last = -1
    drawn = 0
    if done(p, stances[0]):
        return 0, best, 0, True
    for at in range(most):
        n = candidates(p, stances[now], codes)
        moved = False
        while n > 0 and checks < most_checks:
            pick = below(draw(seed, a, b, drawn), n)
            if last >= 0 and unit(draw(seed, a, b, drawn + 1)) < again:
                for c in range(n):
                    if codes[c] == last:
                        pick = c
            drawn += 2
            chosen = codes[pick]
            codes[pick] = codes[n - 1]
            n -= 1
            checks += 1
            if step(p, stances[now], chosen, stances[1 - now], margins) >= 0:
                continue
            now = 1 - now
            trail[at] = chosen
            last = chosen
            moved = True
            break
        if not moved:
            break
        if done(p, stances[now]):
            stances[2] = stances[now]
            return at + 1, worth(p, stances[now], weights, row), checks, True
        value = worth(p, stances[now], weights, row)
        if value > best:
            best = value
            best_at = at + 1
            stances[2] = stances[now]
    return best_at, best, checks, False
