"""Options that several commands share, stated once: the fields of a dataclass become options of a command that takes one."""

import inspect
from collections.abc import Callable
from dataclasses import MISSING, fields
from functools import wraps
from typing import Any, TypeVar, get_type_hints

Holder = TypeVar("Holder")


def shares(holder: type[Holder]) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Make a command of a function whose last parameter, `words`, takes `holder`.

    Args:
        holder: A dataclass; each field is annotated as a Typer option and has a default.
    """
    hints = get_type_hints(holder, include_extras=True)
    shared = [
        inspect.Parameter(
            field.name, inspect.Parameter.KEYWORD_ONLY, default=field.default, annotation=hints[field.name]
        )
        for field in fields(holder)  # type: ignore[arg-type]
    ]
    assert all(one.default is not MISSING for one in shared), holder

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        own_hints = get_type_hints(command, include_extras=True)
        own = [
            one.replace(kind=inspect.Parameter.KEYWORD_ONLY, annotation=own_hints[one.name])
            for one in inspect.signature(command).parameters.values()
            if one.name != "words"
        ]

        @wraps(command)
        def run(**given: Any) -> None:
            words = holder(**{one.name: given.pop(one.name) for one in shared})
            command(**given, words=words)

        run.__signature__ = inspect.Signature([*own, *shared])  # type: ignore[attr-defined]
        run.__annotations__ = {one.name: one.annotation for one in (*own, *shared)}
        del run.__wrapped__  # else its signature counts
        return run

    return decorate
