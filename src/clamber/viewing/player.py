"""A plan as one HTML file that plays in any browser: all data inside, nothing loaded from elsewhere."""

import html
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final

from ..files import write_atomically
from ..types import Json
from . import style
from .frames import Frame, make_frames
from .player_page import PAGE
from .view import Moment, View

MOST_FRAMES: Final = 2400


def write_html(view: View[Any], path: Path, *, most_frames: int = MOST_FRAMES) -> None:
    """Write a plan as a page with its own player."""
    text = json.dumps(player_data(view, make_frames(view, most_frames)), separators=(",", ":"), allow_nan=False)
    text = text.replace("<", "\\u003c")  # so that no name in the data can end the script
    page = PAGE.replace("@TITLE@", html.escape(view.title)).replace("@ROBOT@", view.script).replace("@DATA@", text)
    write_atomically(path, page)


def player_data(view: View[Moment], frames: list[Frame[Moment]]) -> Json:
    """What the player is given; places [m], world frame."""
    gauges = view.gauges
    return {
        "title": view.title,
        "bounds": round_all(view.bounds),
        "palette": {
            "strip": style.STRIP, "words": view.strip_words, "body": style.BODY, "hold": style.HOLD,
            "goal": style.GOAL, "force": style.FORCE, "alert": style.ALERT,
        },
        "noun": view.noun,
        "strip": view.strip_title,
        "rows": [*view.rows, view.verdict_row],
        "bars": {
            "title": gauges.title,
            "names": gauges.names,
            "colours": gauges.colours,
            "low": gauges.low.tolist(),
            "high": gauges.high.tolist(),
            "limits": [share for share, _ in gauges.limits],
            "calm": gauges.calm,
            "unit": gauges.unit,
        },
        "steps": [_step(view, step) for step in range(len(view.replay.stances))],
        "frames": [_frame(view, frame) for frame in frames],
        **view.world(),
    }  # fmt: skip


def round_all(values: Iterable[float]) -> list[float]:
    """Lengths in whole tenths of a millimetre, and other numbers to four decimals."""
    return [round(float(value), 4) for value in values]


def _step(view: View[Moment], step: int) -> Json:
    return {
        "action": view.action(step) if step else "start",
        "facts": [*view.facts(step, view.settled(step)), view.verdict(step)],
        "grade": view.grades[step - 1] if step else 3,
    }


def _frame(view: View[Moment], frame: Frame[Moment]) -> list[Any]:
    spread = view.spread(frame.moment)
    return [
        frame.step,
        round(frame.length, 2),
        round_all(spread.lengths),
        round_all(spread.angles),
        list(spread.marks),
        round_all(view.values(frame.moment)),
    ]
