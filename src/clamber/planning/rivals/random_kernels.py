"""A burst of random walks from one stance, as one kernel."""

from ...compiled import kernel
from .walks import wander


@kernel
def burst(
    p, here, codes, stances, margins, row, weights, again, walks, most, most_checks, seed, number, trail, best, found
):  # fmt: skip
    """Walk at random from a stance, many times, and keep the walk that is worth most; a goal ends the burst.

    Args:
        p: A family's parameters.
        here: Where the walks begin, array of one record; the best walk's end on return.
        codes, stances, margins, row: Scratch of `wander`.
        weights, again: As in `wander`.
        walks: How many.
        most: Most actions of a walk.
        most_checks: Most actions to judge.
        seed, number: Counters of the random numbers.
        trail: Scratch, `most` codes.
        best: Output: the actions of the best walk.
        found: Worth to be exceeded.

    Returns:
        Actions of the best walk (-1: none exceeds `found`), what it is worth, actions judged, and whether it meets the goal.
    """
    length = -1
    checks = 0
    for walk in range(walks):
        if checks >= most_checks:
            break
        stances[0] = here[0]
        actions, value, judged, reached = wander(
            p, stances, codes, margins, row, weights, again, most, most_checks - checks, seed, number, walk, trail
        )
        checks += judged
        if reached or value > found:
            found = value
            length = actions
            for i in range(actions):
                best[i] = trail[i]
            here[1] = stances[2]
        if reached:
            here[0] = here[1]
            return length, found, checks, True
    if length >= 0:
        here[0] = here[1]
    return length, found, checks, False
