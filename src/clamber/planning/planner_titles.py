"""What each planner is, in a line: for lists, which must not wait until all planners are loaded."""

from typing import Final

PLANNER_TITLES: Final[dict[str, str]] = {
    "genetic": 'Plan by genetic search (thesis 2.2.3; page "The model", section 10).',
    "exact": "Find the best plan, or prove that there is none.",
    "beam": "Plan by beam search, with or without hangs: quick and near the shortest plan; it proves nothing.",
    "hybrid": "Plan by genetic and exact search together: a plan soon, then how much shorter one may be, or that none is.",
    "auto": "Choose a planner by the problem, say why, and go on with the next where one finds nothing.",
    "route": "Find a plan over a board of any size; choose it where the way is long.",
    "greedy": "Go on from the stance with the most progress, never to a stance twice, until the first plan.",
    "random": "Walk at random, jump to where the best walk led, start again where none leads further; keep the shortest plan.",
    "mcts": "Search a tree of stances by UCT, commit to the most visited action, and so on to the goal; start again till the budget ends.",
}
"""Planner -> the first line of its docstring."""
