"""The copying of a recorder, as a kernel on addresses: handing a kernel an array costs more than copying a small one."""

import numpy as np

from ..compiled import carray, kernel, pointer

BASE = 0
"""Address of the first row."""
SOURCE = 1
"""Address of what fills a row."""
SIZE = 2
"""Bytes of a row."""


@kernel
def copy_rows(table, tick):
    """Copy each line's source into its row `tick`; shape of the table: (arrays, 3)."""
    for i in range(table.shape[0]):
        size = table[i, SIZE]
        row = carray(pointer(table[i, BASE] + tick * size), size, np.uint8)
        source = carray(pointer(table[i, SOURCE]), size, np.uint8)
        for k in range(size):
            row[k] = source[k]
