"""A plan that moves: GIF, a page with a player, or MP4, by the file's suffix."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from .gif import write_gif
from .player import write_html
from .video import write_mp4
from .view import View

WRITERS: Final[dict[str, Callable[[View[Any], Path], None]]] = {
    ".gif": write_gif,
    ".html": write_html,
    ".mp4": write_mp4,
}
"""Suffix -> what writes it."""
