"""Which cases of a test are among the fast ones."""

from collections.abc import Iterable
from typing import Any

import pytest


def first_fast(cases: Iterable[Any], fast: int = 1) -> list[Any]:
    """The cases of a parametrised test: the first `fast` of them stay as they are, the others are slow."""
    kept = list(cases)
    more = (pytest.param(*case if isinstance(case, tuple) else (case,), marks=pytest.mark.slow) for case in kept[fast:])
    return [*kept[:fast], *more]
