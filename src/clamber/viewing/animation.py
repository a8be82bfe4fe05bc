"""A climb that moves: GIF, a page with a player, or MP4, by the file's suffix."""

from collections.abc import Callable
from pathlib import Path
from typing import Final

from ..actions.problem import Replay
from ..tasks.limbed import LimbedTask
from .gif import write_gif
from .output import check_suffix
from .player import write_html
from .style import styled
from .video import write_mp4
from .view import ClimbView

WRITERS: Final[dict[str, Callable[[ClimbView, Path], None]]] = {
    ".gif": write_gif,
    ".html": write_html,
    ".mp4": write_mp4,
}
"""Suffix -> what writes it."""


def animate_limbed(task: LimbedTask, replay: Replay, path: str | Path) -> None:
    """Write a limbed climber's plan, carried out, as an animation (.gif, .html, .mp4).

    Raises:
        SuffixError: If the file's suffix names no format for animations.
        MissingExtraError: If .mp4 is asked for without the extra `video`.
        FileError: If the file cannot be written.
    """
    suffix = check_suffix(path, WRITERS)
    with styled():
        WRITERS[suffix](ClimbView(task, replay), Path(path))
