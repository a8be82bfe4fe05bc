"""What fields mean, as the classes tell whose values are printed.

Their sources are read and not imported: what a command prints is told without loading simulators.
"""

import ast
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Final, TypeVar

from ...spec_text import field_docs
from .base import Printed

PACKAGE: Final = Path(__file__).parents[2]
P = TypeVar("P", bound=Printed)


def means_as(place: str) -> Callable[[type[P]], type[P]]:
    """Give each field of an object that says nothing of itself the meaning that it has where its value is made.

    Args:
        place: A file below the package and a class in it, such as "limb_bench/measures.py:TipMeasures". Where that says None or
            inf, JSON has null.
    """
    file, _, name = place.partition(":")
    known = field_docs(_classes(file)[name])

    def tell(told: type[P]) -> type[P]:
        silent = [key for key, field in told.model_fields.items() if field.description is None and key in known]
        assert silent, f"{place} says nothing of {told.__name__} that is not said already"
        for key in silent:
            told.model_fields[key].description = re.sub(r"\b(None|inf|NaN)\b", "null", known[key])
        told.model_rebuild(force=True)
        return told

    return tell


@cache
def _classes(file: str) -> dict[str, ast.ClassDef]:
    tree = ast.parse((PACKAGE / file).read_text(encoding="utf-8"))
    return {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
