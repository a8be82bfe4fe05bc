"""The loops over a family's `step`, written once for all families: rollout of many plans, replay of one, expansion of many stances."""

from ...compiled import kernel
from .family_kernels import bound, candidates, cell, done, draft, key, measure, step

SUM, LARGEST = 1, 2


@kernel
def accumulate(kinds, row, totals):
    """Add one action's features to a plan's: the last value, the sum, or the largest, as the family says."""
    for i in range(totals.shape[0]):
        if kinds[i] == SUM:
            totals[i] += row[i]
        elif kinds[i] == LARGEST:
            totals[i] = max(totals[i], row[i])
        else:
            totals[i] = row[i]


@kernel
def rollout(p, start, plans, which, table, weights, scratch, out):
    """Carry out plans, each up to its goal or its first failure.

    Args:
        p: A family's parameters.
        start: Start stance, array of one record.
        plans: Entries of the action table, shape (n, longest), genes of each plan, shape (n,), and most actions of a plan.
        which: The first plan, and the one after the last.
        table: Offsets and codes: entry g is codes[offsets[g]:offsets[g + 1]], one code or a macro.
        weights: Weights of the features.
        scratch: Three stances, margins of the family's checks, and rows of features, shape (2, n_features).
        out: Record array of the plans (`problem.ROLLOUT`): genes and actions that held, reason and stance of the stop, fitness there, the
            prefix with the best fitness, features, cell.
    """
    genes, lengths, limit = plans
    offsets, codes = table
    stances, margins, row = scratch
    for plan in range(which[0], which[1]):
        result = out[plan]
        totals = row[1]
        for i in range(totals.shape[0]):
            totals[i] = 0.0
        now = 0
        stances[0] = start[0]
        actions = 0
        held = 0
        reason = -1
        checks = 0
        best = 0.0
        best_genes = 0
        fitness = 0.0
        finished = done(p, stances[0])
        for g in range(lengths[plan]):
            if finished:
                break
            entry = genes[plan, g]
            for at in range(offsets[entry], offsets[entry + 1]):
                if actions >= limit:
                    reason = -2
                    break
                nxt = 1 - now
                checks += 1
                reason = step(p, stances[now], codes[at], stances[nxt], margins)
                if reason >= 0:
                    break
                now = nxt
                actions += 1
                measure(p, stances[now], row[0])
                accumulate(p.kinds, row[0], totals)
                if done(p, stances[now]):
                    finished = True
                    break
            if reason != -1:
                break
            held = g + 1
            fitness = 0.0
            for i in range(totals.shape[0]):
                fitness += weights[i] * totals[i]
            if fitness > best:
                best = fitness
                best_genes = held
            if finished:
                break
        result.genes = held
        result.actions = actions
        result.checks = checks
        result.reason = reason
        result.fitness = fitness
        result.best = best
        result.best_genes = best_genes
        result.done = 1 if finished else 0
        result.cell = cell(p, stances[now])
        for i in range(totals.shape[0]):
            result.features[i] = totals[i]


@kernel
def replay(p, start, codes, go_on, stances, margins, reasons):
    """Carry out one plan and keep everything.

    Args:
        p: A family's parameters.
        start: Start stance, array of one record.
        codes: Packed actions, shape (n,).
        go_on: Whether to go on past a violation.
        stances: Output, shape (n + 1,): the start and the stance after each action.
        margins: Output, shape (n, n_checks).
        reasons: Output, shape (n,): -1 or the violated check.

    Returns:
        Number of actions carried out.
    """
    stances[0] = start[0]
    for i in range(codes.shape[0]):
        reasons[i] = step(p, stances[i], codes[i], stances[i + 1], margins[i])
        if reasons[i] >= 0 and not go_on:
            return i + 1
    return codes.shape[0]


@kernel
def expand(p, parents, which, scratch, children, parent_of, code_of):
    """Every valid child of the stances from the first of `which` to before the second; stops before `children` is full.

    `scratch`: codes and margins.

    Returns:
        Number of children, and the parent to go on from.
    """
    n = 0
    codes, margins = scratch
    for i in range(which[0], which[1]):
        if n + codes.shape[0] > children.shape[0]:
            return n, i
        for c in range(candidates(p, parents[i], codes)):
            if step(p, parents[i], codes[c], children[n], margins) < 0:
                parent_of[n] = i
                code_of[n] = codes[c]
                n += 1
    return n, which[1]


@kernel
def expand_scored(p, parents, which, drafts, scoring, scratch, count, found):
    """Every valid child of some stances, each in a slot of its parent's own, so that threads never meet.

    Args:
        p: A family's parameters.
        parents: Stances.
        which: The first of them to look at, and the one after the last.
        drafts: Whether children are drafted alone: they may not be valid.
        scoring: Weights of the features in a child's score, and what it loses per action that `bound` says is left.
        scratch: Checks, features, one stance, candidates.
        count: Output: children of each parent.
        found: Output per parent and slot: action, score, cell, whether every goal is met, and the key, shape (n, slots, words).
    """
    weights, toll = scoring
    margins, row, child, codes = scratch
    code, score, niche, met, keys = found
    for i in range(which[0], which[1]):
        n = 0
        for c in range(candidates(p, parents[i], codes)):
            if drafts:
                if draft(p, parents[i], codes[c], child[0]) < 0:
                    continue
            elif step(p, parents[i], codes[c], child[0], margins) >= 0:
                continue
            measure(p, child[0], row)
            value = -toll * bound(p, child[0]) if toll != 0.0 else 0.0
            for f in range(weights.shape[0]):
                value += weights[f] * row[f]
            code[i, n] = codes[c]
            score[i, n] = value
            niche[i, n] = cell(p, child[0])
            met[i, n] = 1 if done(p, child[0]) else 0
            key(p, child[0], keys[i, n])
            n += 1
        count[i] = n


@kernel
def possible(p, start, genes, table, stances, margins, mask):
    """Which table entries hold at the end of a plan that holds: the configuration filter.

    Args:
        p, start, table, stances, margins: As in `rollout`.
        genes: One plan, shape (n,).
        mask: Output, one byte per table entry.
    """
    offsets, codes = table
    now = 0
    stances[0] = start[0]
    for g in range(genes.shape[0]):
        for at in range(offsets[genes[g]], offsets[genes[g] + 1]):
            nxt = 1 - now
            if step(p, stances[now], codes[at], stances[nxt], margins) >= 0:
                return False
            now = nxt
    for entry in range(mask.shape[0]):
        at = offsets[entry]
        mask[entry] = 1 if step(p, stances[now], codes[at], stances[2], margins) < 0 else 0
    return True


@kernel
def features_of(p, stance, row):
    """Features of one stance (array of one record)."""
    measure(p, stance[0], row)
