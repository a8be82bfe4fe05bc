"""Plans that a population starts with: their actions join the inventory, each as an entry of its own."""

from collections.abc import Sequence

import numpy as np

from ..problem.table import ActionTable
from .evolve import Genes


def with_seeds(table: ActionTable, plans: Sequence[Genes]) -> tuple[ActionTable, list[Genes]]:
    """An inventory that can spell the given plans, and the plans in its entries.

    Args:
        table: The inventory.
        plans: Packed codes, every hold named.

    Returns:
        The inventory, longer by the actions that it lacks (grabs of a hold by its name, mostly), and genes of each plan.
    """
    single = {
        int(table.codes[table.offsets[entry]]): entry
        for entry in range(len(table))
        if table.offsets[entry + 1] - table.offsets[entry] == 1
    }
    lacking = sorted({int(code) for codes in plans for code in codes} - set(single))
    longer = table.extended([(f"code {code}", (code,), False) for code in lacking])
    single |= {code: len(table) + i for i, code in enumerate(lacking)}
    return longer, [np.array([single[int(code)] for code in codes], np.int32) for codes in plans]
