"""What the panel says of a moment, as HTML: the step, its margins, the loads, and the strip of all steps."""

import math
from html import escape
from typing import Any, Final

import numpy as np

from ...types import Floats
from .. import style
from ..panel import Gauges
from ..recording import MarginRow, Recording

CELL: Final = "padding:1px 6px 1px 0;white-space:nowrap"
PAD: Final = "padding:0 12px"
NEAR: Final = 0.05
"""Margins with a smaller share of what is limited are shown as tight [-]."""
FAIR: Final = 0.15


def head_html(film: Recording[Any], step: int, moment: Any) -> str:
    """The step and what is to be said of the moment."""
    last = len(film.steps) - 1
    title = (
        f"{film.noun} {step} of {last}: {film.steps[step]}" if step else film.steps[0][:1].upper() + film.steps[0][1:]
    )
    ink = style.ALERT if step and film.grades[step] == 0 else style.INK
    rows = "".join(
        f'<tr><td style="{CELL};color:{style.QUIET};vertical-align:top">{escape(name)}</td><td>{escape(words)}</td></tr>'
        for name, words in film.facts(step, moment)
    )
    return (
        f'<div data-clamber="head" style="font-size:13px;{PAD}"><div style="font-weight:600;color:{ink};margin-bottom:4px">'
        f'{escape(title)}</div><table style="font-size:12px;border-spacing:0">{rows}</table></div>'
    )


def strip_html(film: Recording[Any], step: int, name: str) -> str:
    """A coloured cell for every step, a mark at the one that is shown, a ring about the worst, and what the colours mean."""
    n = len(film.steps) - 1
    if n < 1:
        return ""
    runs: list[tuple[int, int, int]] = []
    for k, grade in enumerate(film.grades[1:]):
        if runs and runs[-1][2] == grade:
            runs[-1] = runs[-1][0], k + 1, grade
        else:
            runs.append((k, k + 1, grade))
    cells = "".join(
        f'<rect x="{first}" y="0" width="{end - first}" height="10" fill="{style.STRIP[grade]}"/>'
        for first, end, grade in runs
    )
    worst = film.worst
    if worst is not None:
        cells += (
            f'<rect x="{worst - 1}" y="0" width="1" height="10" fill="none" stroke="{style.INK}" '
            f'stroke-width="1.5" vector-effect="non-scaling-stroke"/>'
        )
    at = max(step - 0.5, 0.0)
    cells += f'<line x1="{at}" x2="{at}" y1="0" y2="10" stroke="{style.INK}" stroke-width="2" vector-effect="non-scaling-stroke"/>'
    legend = "".join(
        f'<span style="display:inline-block;width:9px;height:9px;background:{shade};margin:0 3px 0 0"></span>'
        f'<span style="margin-right:9px">{escape(word)}</span>'
        for shade, word in zip(style.STRIP, film.words, strict=True)
    )
    told = "" if worst is None else f"; framed: the worst, {film.noun.lower()} {worst}"
    return (
        f'<div data-clamber="strip" style="font-size:11px;color:{style.QUIET};{PAD}"><div>{escape(name)}{told}</div>'
        f'<svg viewBox="0 0 {n} 10" preserveAspectRatio="none" style="width:100%;height:14px;display:block;margin:3px 0">'
        f"{cells}</svg>{legend}</div>"
    )


def margins_html(rows: list[MarginRow], whose: str = "") -> str:
    """A bar for every check, the nearest to failing in bold; checks that only report are paler; `whose` says what they are of."""
    if not rows:
        return f'<div style="font-size:12px;color:{style.QUIET};{PAD}">No margins here: checks judge the steps of a plan.</div>'
    made = []
    for row in sorted(rows, key=lambda row: (not row.hard, row.share)):
        shade = (
            style.ALERT
            if row.share < 0.0
            else style.STRIP[1]
            if row.share < NEAR
            else style.STRIP[2 if row.share < FAIR else 3]
        )
        width = 100.0 * min(max(abs(row.share), 0.02), 1.0)
        weight = "700" if row.worst else "400"
        made.append(
            f'<tr title="{escape(row.meaning, quote=True)}" style="font-weight:{weight};opacity:{1.0 if row.hard else 0.55}">'
            f'<td style="{CELL}">{"&#9656; " if row.worst else ""}{escape(row.name.replace("_", "-"))}</td>'
            f'<td style="width:40%;padding-right:6px"><div style="background:{style.FAINT};height:8px">'
            f'<div style="background:{shade};height:8px;width:{width:.1f}%"></div></div></td>'
            f'<td style="{CELL};text-align:right">{escape(row.value)}</td></tr>'
        )
    note = "share of what is limited; paler: checks that only report"
    head = f'<div style="font-size:12px">{escape(whose)}</div>' if whose else ""
    return (
        f'<div data-clamber="margins" style="{PAD}">{head}<table style="font-size:12px;width:100%;border-spacing:0">{"".join(made)}</table>'
        f'<div style="font-size:11px;color:{style.QUIET}">{note}</div></div>'
    )


def step_margins_html(film: Recording[Any], step: int, plan: Recording[Any] | None, planned: int | None) -> str:
    """The checks of a step; of a run that nothing judges those of its plan at the step that belongs to it, if there is one."""
    rows = film.margins(step)
    if rows or plan is None or not planned:
        return margins_html(rows)
    return margins_html(plan.margins(planned), f"of the plan, at its step {planned}")


def loads_html(blocks: tuple[Gauges, ...], values: tuple[Floats, ...]) -> str:
    """Blocks of bars in a column."""
    return '<div style="height:8px"></div>'.join(map(bars_html, blocks, values))


def bars_html(gauges: Gauges, values: Floats) -> str:
    """A bar for every value between its ends, with lines at its limits, red beyond what is calm; empty for one that is NaN: not told."""
    low, high = gauges.calm
    lines = "".join(
        f'<i style="position:absolute;left:calc({100.0 * share:.1f}% - 1px);top:-2px;bottom:-2px;width:2px;background:{style.ALERT}"></i>'
        for share, _ in gauges.limits
    )
    made = []
    for name, own, value, share in zip(gauges.names, gauges.colours, values, gauges.shares(values), strict=True):
        shade = own if low <= share <= high else style.ALERT
        told = not math.isnan(share)
        width = 100.0 * float(np.clip(share, 0.0, 1.0)) if told else 0.0
        made.append(
            f'<tr><td style="{CELL}">{escape(name)}</td><td style="width:45%;padding-right:8px">'
            f'<div style="background:{style.FAINT};height:8px;position:relative">'
            f'<div style="background:{shade};height:8px;width:{width:.1f}%"></div>{lines}</div></td>'
            f'<td style="{CELL};text-align:right">{escape(gauges.show(float(value))) if told else "&ndash;"}</td></tr>'
        )
    limits = "red line: " + ", ".join(word for _, word in gauges.limits) if gauges.limits else ""
    words = "; ".join(filter(None, (limits, gauges.note)))
    return (
        f'<div data-clamber="bars" style="{PAD};font-size:12px"><b>{escape(gauges.title)}</b>'
        f'<table style="font-size:12px;width:100%;border-spacing:0">{"".join(made)}</table>'
        f'<div style="font-size:11px;color:{style.QUIET}">{escape(words)}</div></div>'
    )


def message_html(words: str, *, bad: bool) -> str:
    """A message beside the thing that it is about; line breaks stay."""
    ink, ground = (style.ALERT, "#FBECEC") if bad else (style.INK, "#EDF3F8")
    return (
        f'<div data-clamber="{"error" if bad else "message"}" role="status" style="font-size:12px;color:{ink};background:{ground};'
        f'padding:5px 8px;margin:0 12px;border-radius:4px;white-space:pre-wrap;overflow-wrap:anywhere">{escape(words)}</div>'
        if words
        else ""
    )
