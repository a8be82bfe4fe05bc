"""Options held by dataclasses: a command takes them whole, and several commands share one.

A command of many options states them once, in a dataclass, and hands that value on.
"""

import inspect
from collections.abc import Callable
from dataclasses import MISSING, fields, is_dataclass
from functools import wraps
from typing import Any, get_type_hints


def takes_options(command: Callable[..., None]) -> Callable[..., None]:
    """Make a command of a function: a parameter annotated with a dataclass stands for options, one for each of its fields.

    Args:
        command: Its other parameters, and the fields, are annotated as Typer options; each field has a default.
    """
    hints = get_type_hints(command, include_extras=True)
    holders = {name: hint for name, hint in hints.items() if isinstance(hint, type) and is_dataclass(hint)}
    options: list[inspect.Parameter] = []
    for one in inspect.signature(command).parameters.values():
        if one.name in holders:
            options += _options_of(holders[one.name])
        else:
            options.append(one.replace(kind=inspect.Parameter.KEYWORD_ONLY, annotation=hints[one.name]))

    @wraps(command)
    def run(**given: Any) -> None:
        words = {
            name: holder(**{field.name: given.pop(field.name) for field in fields(holder)})
            for name, holder in holders.items()
        }
        command(**given, **words)

    run.__signature__ = inspect.Signature(options)  # type: ignore[attr-defined]
    run.__annotations__ = {one.name: one.annotation for one in options}
    del run.__wrapped__  # else its signature counts
    return run


def _options_of(holder: type[Any]) -> list[inspect.Parameter]:
    hints = get_type_hints(holder, include_extras=True)
    assert all(field.default is not MISSING for field in fields(holder)), holder
    return [
        inspect.Parameter(
            field.name, inspect.Parameter.KEYWORD_ONLY, default=field.default, annotation=hints[field.name]
        )
        for field in fields(holder)
    ]
