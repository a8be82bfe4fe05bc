"""The viewer as one page that needs no server: the scene recorded, and what the panel says of it beside."""

import contextlib
import html
import io
import json
from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import numpy as np

from ...files import write_atomically
from ...types import Floats, Json
from .. import style
from ..animation import Progress, untold
from ..output import check_suffix
from ..panel import Gauges
from ..recording import Recording
from .app import LOOPBACK, aim_camera, check_viser, guarded_server, light_scene
from .own_pages import TITLE, Guard
from .panel_html import head_html, step_margins_html
from .scene_view import STRIPS, SceneView
from .viewer_content import ViewerContent

SUFFIXES: Final = (".html",)
PICTURES: Final = 20.0
"""Of a recording, in a second of it."""
MOST: Final = 2400
"""Pictures of a recording, at most: longer films get fewer in a second."""
PANEL: Final = Path(__file__).with_name("panel.html")
"""`@TITLE@` and `@DATA@` in it are replaced; the data is JSON as `panel_data` makes it."""
END: Final = 0.01
"""So long before its end a recording may stand still; at its end it begins again [s]."""


def write_page(exhibit: ViewerContent, path: Path, progress: Progress = untold) -> int:
    """Write a viewer's page with the recorded scene and the client inside; nothing is loaded from elsewhere.

    Returns:
        Its size [bytes].

    Raises:
        SuffixError: If the file's suffix is not .html.
        MissingViserError: If the viewer's package is missing.
        FileError: If the file cannot be written.
    """
    check_suffix(path, SUFFIXES)
    check_viser()
    with contextlib.redirect_stdout(io.StringIO()):  # its last words
        server = guarded_server(LOOPBACK, Guard(0))  # nobody is to come
        try:
            page = _record(server, exhibit, progress)
        finally:
            server.stop()
    content = page.encode()
    write_atomically(path, content)
    return len(content)


def _record(server: Any, exhibit: ViewerContent, progress: Progress) -> str:
    stage = SceneView(server, exhibit)
    light_scene(server)
    aim_camera(server, exhibit.scenery.camera())
    film = stage.main
    times = film.times(PICTURES, MOST) if film.seconds > 0.0 else np.zeros(1)
    stage.show(film, 0.0)
    recorder = server.get_scene_serializer()
    for number, (before, now) in enumerate(pairwise(times.tolist()), start=1):
        progress(number, len(times) - 1)
        recorder.insert_sleep((now - before) / film.speed)
        stage.show(film, now)
    page: str = recorder.as_html()
    data = json.dumps(
        panel_data(film, times, stage.main_kind, exhibit.plan_film), separators=(",", ":"), allow_nan=False
    )
    data = data.replace("<", "\\u003c")  # so that no name in the data can end the script
    panel = PANEL.read_text(encoding="utf-8")
    panel = panel.replace("@TITLE@", html.escape(exhibit.title)).replace("@DATA@", data)
    page = page.replace(TITLE.decode(), f"<title>{html.escape(exhibit.title)} - Clamber</title>", 1)
    end = page.rindex("</body>")
    return page[:end] + panel + page[end:]


def panel_data(
    film: Recording[Any], times: "np.ndarray[tuple[int], np.dtype[np.float64]]", kind: str, plan: Recording[Any] | None
) -> Json:
    """What the page's own panel is given; times in seconds of the recording, `plan` the plan of a run."""

    def margins(step: int) -> str:
        then = None if plan is None else film.planned_time(film.rest(step), plan)
        return step_margins_html(film, step, plan, None if plan is None or then is None else plan.step_at(then))

    moments = [film.at(float(time)) for time in times]
    last = max(film.seconds / film.speed - END, 0.0)
    return {
        "times": round_all(times / film.speed),
        "starts": round_all(film.starts / film.speed),
        "rests": round_all(min(film.rest(step) / film.speed, last) for step in range(len(film.steps))),
        "steps": [
            {"words": words, "grade": grade, "head": head_html(film, k, film.at(film.rest(k))), "margins": margins(k)}
            for k, (words, grade) in enumerate(zip(film.steps, film.grades, strict=True))
        ],
        "worst": film.worst,
        "strip": {"title": f"{STRIPS[kind]} {film.noun.lower()}", "colours": style.STRIP, "words": film.words},
        "bars": [block_data(gauges) for gauges in film.gauges],
        "values": [_numbers(film.values(moment)) for moment in moments],
    }  # fmt: skip


def round_all(values: Iterable[float]) -> list[float]:
    """Lengths in whole tenths of a millimetre, and other numbers to four decimals."""
    return [round(float(value), 4) for value in values]


def block_data(gauges: Gauges) -> Json:
    """A block of bars for the page's panel."""
    return {
        "title": gauges.title,
        "names": gauges.names,
        "colours": gauges.colours,
        "low": gauges.low.tolist(),
        "high": gauges.high.tolist(),
        "limits": gauges.limits,
        "calm": [gauges.calm[0], min(gauges.calm[1], 1e9)],
        "unit": gauges.unit,
        "note": gauges.note,
        "alert": style.ALERT,
    }


def _numbers(blocks: tuple[Floats, ...]) -> list[float | None]:
    """Values of all blocks in a row, those that are not told as None."""
    flat = np.concatenate((*blocks, ()))
    return [
        number if known else None
        for number, known in zip(round_all(np.nan_to_num(flat)), np.isfinite(flat), strict=True)
    ]
