"""Inputs of the panel: set by the viewer, or by whoever looks at it."""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import Any

from ...errors import SpecError, StartError


def set_input(handle: Any, value: Any) -> None:
    """Set what an input shows; nothing that listens to whoever looks at the page hears of it."""
    handle.value = value  # its type says that it can only be read


def by_hand(act: Callable[[Any], None], lock: AbstractContextManager[Any] | None = None) -> Callable[[Any], None]:
    """What is to happen when an input is changed on the page, and not when the viewer sets it; one after the other under a lock."""

    def heard(event: Any) -> None:
        if event.client is not None:
            with nullcontext() if lock is None else lock:
                act(event)

    return heard


def about(error: Exception) -> str:
    """What an error is about: "start", "goal", or "world", the board or the ground."""
    if isinstance(error, StartError):
        return "start"
    key = str(error.key).split(".")[0] if isinstance(error, SpecError) else ""
    return "start" if key == "start" else "goal" if key in ("goal", "subgoals", "way") else "world"
