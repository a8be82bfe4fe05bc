"""Options that climbs take and walks do not."""

from collections.abc import Collection
from dataclasses import fields
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


def refuse_for_walk(what: str, words: "DataclassInstance", names: Collection[str]) -> None:
    """Make sure that nothing is asked of a walk that only climbs have.

    Args:
        what: The walk's name or file.
        words: Options as they came.
        names: Fields of options that only climbs have.

    Raises:
        BadParameter: If one of these options is not as usual.
    """
    for field in fields(words):
        if field.name in names and getattr(words, field.name) != field.default:
            flag = f"--{'no-' if field.default is True else ''}{field.name.replace('_', '-')}"
            raise typer.BadParameter(f"'{what}' is a walk, and this is for climbs", param_hint=flag)
