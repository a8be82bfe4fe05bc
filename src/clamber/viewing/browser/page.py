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
END: Final = 0.01
"""So long before its end a recording may stand still; at its end it begins again [s]."""


def write_page(exhibit: ViewerContent, path: Path) -> int:
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
            page = _record(server, exhibit)
        finally:
            server.stop()
    content = page.encode()
    write_atomically(path, content)
    return len(content)


def _record(server: Any, exhibit: ViewerContent) -> str:
    stage = SceneView(server, exhibit.scenery)
    light_scene(server)
    stage.set_film("plan", exhibit.plan_film)
    stage.set_film("run", exhibit.run_film)
    stage.shown = "both" if len(stage.films) > 1 else "plan"
    aim_camera(server, exhibit.scenery.camera())
    film = stage.main
    times = _times(film)
    stage.show(film, 0.0)
    recorder = server.get_scene_serializer()
    for before, now in pairwise(times.tolist()):
        recorder.insert_sleep((now - before) / film.speed)
        stage.show(film, now)
    page: str = recorder.as_html()
    data = json.dumps(
        panel_data(film, times, stage.main_kind, exhibit.plan_film), separators=(",", ":"), allow_nan=False
    )
    data = data.replace("<", "\\u003c")  # so that no name in the data can end the script
    panel = PANEL.replace("@TITLE@", html.escape(exhibit.title)).replace("@DATA@", data)
    page = page.replace(TITLE.decode(), f"<title>{html.escape(exhibit.title)} - Clamber</title>", 1)
    end = page.rindex("</body>")
    return page[:end] + panel + page[end:]


def _times(film: Recording[Any]) -> "np.ndarray[tuple[int], np.dtype[np.float64]]":
    """When the pictures are taken, in the film's time [s]."""
    count = int(min(MOST, np.ceil(film.seconds / film.speed * PICTURES)))
    return np.linspace(0.0, film.seconds, max(count, 1) + 1) if film.seconds > 0.0 else np.zeros(1)


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


PANEL: Final = r"""<style>
#clamber { position: fixed; right: 12px; top: 12px; width: min(340px, 44vw); max-height: calc(100vh - 76px); overflow: auto; z-index: 2; background: #fffffff2; color: #22303c;
  font: 13px/1.4 system-ui, sans-serif; border-radius: 8px; box-shadow: 0 1px 8px #22303c2e; padding: 10px 0; box-sizing: border-box; }
#clamber[hidden] { display: none; } #clamber h1 { font-size: 15px; margin: 0 40px 6px 12px; } #clamber h2 { font-size: 12px; margin: 10px 12px 3px; }
#clamber ol { list-style: none; margin: 0; padding: 0; max-height: 200px; overflow: auto; border-block: 1px solid #dce1e6; }
#clamber li { padding: 2px 12px; cursor: pointer; display: flex; gap: 8px; align-items: baseline; } #clamber li:hover { background: #f1f4f7; }
#clamber li.now { background: #dfe8f0; font-weight: 600; } #clamber li.worst b { outline: 2px solid #22303c; }
#clamber li i { width: 10px; height: 10px; flex: none; border-radius: 2px; } #clamber li b { min-width: 22px; text-align: right; color: #6e7b87; font-weight: 500; }
#clamber canvas { width: calc(100% - 24px); height: 14px; margin: 3px 12px; display: block; cursor: pointer; }
#clamber .bar { display: grid; grid-template-columns: 105px 1fr 74px; gap: 8px; padding: 1px 12px; align-items: center; font-size: 12px; }
#clamber .bar > div { position: relative; height: 8px; background: #dce1e6; } #clamber .bar > div > div { height: 8px; } #clamber .bar > span:last-child { text-align: right; }
#clamber .bar i { position: absolute; top: -2px; bottom: -2px; width: 2px; margin-left: -1px; }
#clamber .legend { padding: 0 12px; font-size: 11px; color: #6e7b87; } #clamber .legend span { white-space: nowrap; margin-right: 8px; } #clamber .legend i { display: inline-block; width: 9px; height: 9px; margin: 0 3px 0 0; }
#clamber-fold { position: fixed; right: 18px; top: 16px; width: 28px; z-index: 3; font: 14px system-ui, sans-serif; background: none; border: 0; color: #6e7b87; cursor: pointer; }
#clamber[hidden] + #clamber-fold { background: #fff; border-radius: 6px; box-shadow: 0 1px 8px #22303c2e; }
</style>
<aside id="clamber"><h1>@TITLE@</h1><div data-part="head"></div><h2 data-part="strip-title"></h2><canvas data-part="strip"></canvas><div class="legend" data-part="words"></div>
<h2>Steps</h2><ol></ol><div data-part="bars"></div><h2>Margins</h2><div data-part="margins"></div></aside>
<button id="clamber-fold" aria-label="Hide panel" title="Hide panel">&#x2715;</button>
<script id="clamber-data" type="application/json">@DATA@</script>
<script>
"use strict";
(() => {
const D = JSON.parse(document.getElementById("clamber-data").textContent), panel = document.getElementById("clamber");
const part = name => panel.querySelector('[data-part="' + name + '"]'), list = panel.querySelector("ol"), strip = part("strip");
const fold = document.getElementById("clamber-fold");
fold.onclick = () => { panel.hidden = !panel.hidden; const words = panel.hidden ? "Show panel" : "Hide panel"; fold.title = words; fold.setAttribute("aria-label", words); fold.textContent = panel.hidden ? "\u2630" : "\u2715"; makeRoom(); };
part("strip-title").textContent = D.strip.title;
D.strip.words.forEach((word, k) => { const i = document.createElement("i"); const span = document.createElement("span"); i.style.background = D.strip.colours[k]; span.append(i, word); part("words").append(span, " "); });
const items = D.steps.map((step, k) => {
  const li = document.createElement("li"), i = document.createElement("i"), b = document.createElement("b");
  i.style.background = k ? D.strip.colours[step.grade] : "transparent"; b.textContent = k; li.append(i, b, step.words);
  if (k === D.worst) li.classList.add("worst");
  li.onclick = () => seek(D.rests[k]); list.append(li); return li;
});
const make = (kind, words, into) => { const made = document.createElement(kind); made.textContent = words; into.append(made); return made; };
const rows = D.bars.flatMap(G => {
  make("h2", G.title, part("bars"));
  const made = G.names.map((name, q) => {
    const row = document.createElement("div"); row.className = "bar"; row.innerHTML = "<span></span><div><div></div></div><span></span>"; row.firstChild.textContent = name;
    for (const [share] of G.limits) { const i = document.createElement("i"); i.style.left = 100 * share + "%"; i.style.background = G.alert; row.children[1].append(i); }
    part("bars").append(row); return [G, q, row.children[1].firstChild, row.lastChild];
  });
  const said = [G.limits.length ? "red line: " + G.limits.map(limit => limit[1]).join(", ") : "", G.note].filter(Boolean).join("; ");
  make("div", said, part("bars")).className = "legend"; return made;
});
// The scene is drawn beside the panel, not behind it: what grows with the window, it leaves the panel's width free.
function makeRoom() {
  let at = document.querySelector("canvas[data-engine]"); while (at && getComputedStyle(at).flexGrow !== "1") at = at.parentElement;
  const room = panel.hidden ? "" : panel.offsetWidth + 24 + "px"; if (at && at.style.marginRight !== room) at.style.marginRight = room;
}
// The recording's own time bar tells the time; the number field beside it takes another.
const field = () => document.querySelector("#root .mantine-NumberInput-input"), bar = () => document.querySelector("#root [role=slider]");
function seek(time) {
  const input = field(); if (!input) return;
  Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value").set.call(input, time.toFixed(4));
  input.dispatchEvent(new Event("input", { bubbles: true })); show(time);
}
function last(list, time) { let lo = 0, hi = list.length - 1; while (lo < hi) { const m = (lo + hi + 1) >> 1; list[m] <= time + 1e-6 ? lo = m : hi = m - 1; } return lo; }
let shown = -1;
function show(time) {
  const step = last(D.starts, time), values = D.values[last(D.times, time)];
  values.forEach((v, k) => { const [G, q, fill, text] = rows[k], u = v === null ? 0 : (Math.abs(v) - G.low[q]) / (G.high[q] - G.low[q]);
    fill.style.width = 100 * Math.min(Math.max(u, 0), 1) + "%"; fill.style.background = u < G.calm[0] || u > G.calm[1] ? G.alert : G.colours[q];
    text.textContent = v === null ? "\u2013" : (v / G.unit[1]).toFixed(G.unit[2]).replace(/^-(0\.?0*)$/, "$1") + " " + G.unit[0]; });
  draw(step);
  if (step === shown) return;
  if (items[shown]) items[shown].classList.remove("now");
  shown = step; items[step].classList.add("now"); panel.dataset.step = step;
  const top = items[step].offsetTop - list.offsetTop; if (top < list.scrollTop + 20 || top > list.scrollTop + list.clientHeight - 40) list.scrollTop = top - list.clientHeight / 2;
  part("head").innerHTML = D.steps[step].head; part("margins").innerHTML = D.steps[step].margins;
}
function draw(step) {
  const r = window.devicePixelRatio || 1, w = Math.round(strip.clientWidth * r), h = Math.round(strip.clientHeight * r), n = D.steps.length - 1;
  if (strip.width !== w || strip.height !== h) { strip.width = w; strip.height = h; }
  const g = strip.getContext("2d"); g.clearRect(0, 0, w, h); if (!n) return;
  for (let k = 1; k <= n; k++) { g.fillStyle = D.strip.colours[D.steps[k].grade]; g.fillRect((k - 1) / n * w, 0, w / n + .5, h); }
  g.strokeStyle = g.fillStyle = "#22303c"; g.lineWidth = 2;
  if (D.worst) g.strokeRect((D.worst - 1) / n * w + 1, 1, Math.max(w / n - 2, 2), h - 2);
  g.fillRect(Math.max(step - .5, 0) / n * w - 1, 0, 2, h);
}
strip.onclick = e => { const n = D.steps.length - 1; if (n) seek(D.rests[Math.min(n, 1 + Math.floor(e.offsetX / strip.clientWidth * n))]); };
show(0);
setInterval(() => { makeRoom(); const slider = bar(); if (slider) show(Number(slider.getAttribute("aria-valuenow")) || 0); }, 80);
})();
</script>
"""  # noqa: E501 - a part of a page, not code
"""`@TITLE@` and `@DATA@` are replaced; the data is JSON as `panel_data` makes it."""
