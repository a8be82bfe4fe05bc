"""What a worker does: an item comes in as JSON text, its end goes out as JSON text."""

import importlib
import json
import os
import signal
import threading
import time
from collections.abc import Callable
from multiprocessing import parent_process
from multiprocessing.connection import Connection, wait
from typing import Any

from ..types import Json


def find_function(name: str) -> Callable[[Json], Json]:
    """The function that "module:name" stands for; it must lie at the top of its module."""
    module, _, word = name.partition(":")
    function: Callable[[Json], Json] = getattr(importlib.import_module(module), word)
    return function


def run_item(function: Callable[[Json], Json], item: str) -> Json:
    """The end of one item: `{"result", "seconds", "error"}`; the result is JSON text."""
    started = time.monotonic()
    try:
        result, error = json.dumps(function(json.loads(item)), sort_keys=True, allow_nan=False), None
    except Exception as problem:  # one bad item must not take the others with it; its text is the item's end
        result, error = None, f"{type(problem).__name__}: {problem}"
    return {"result": result, "seconds": time.monotonic() - started, "error": error}


def serve(name: str, line: "Connection[Any, Any]") -> None:
    """Work until the line is closed.

    Args:
        name: The function, as "module:name".
        line: Gives items and takes their ends.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the whole group; the parent alone decides
    threading.Thread(target=_leave_with_parent, daemon=True).start()
    function = find_function(name)
    while True:
        try:
            item = line.recv_bytes().decode()
        except EOFError:
            return
        line.send_bytes(json.dumps(run_item(function, item)).encode())


def _leave_with_parent() -> None:
    """A killed parent leaves nobody to send to: stop in the middle of the item."""
    parent = parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)
