"""What runs in a worker process: items come in as JSON text, results go out as JSON text, one at a time."""

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


def serve(name: str, line: "Connection[Any, Any]") -> None:
    """Work until the line is closed.

    Args:
        name: The function, as "module:name".
        line: Gives items and takes ends `{"result", "seconds", "error"}`.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the whole group; the parent alone decides
    threading.Thread(target=_leave_with_parent, daemon=True).start()
    function = find_function(name)
    while True:
        try:
            item = json.loads(line.recv_bytes())
        except EOFError:
            return
        started = time.monotonic()
        try:
            result, error = json.dumps(function(item), sort_keys=True, allow_nan=False), None
        except Exception as problem:  # one bad item must not take the others with it; its text is the item's end
            result, error = None, f"{type(problem).__name__}: {problem}"
        end = {"result": result, "seconds": time.monotonic() - started, "error": error}
        line.send_bytes(json.dumps(end).encode())


def _leave_with_parent() -> None:
    """A killed parent leaves nobody to send to: stop in the middle of the item."""
    parent = parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)
