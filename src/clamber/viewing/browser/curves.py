"""Curves over time of what the bars show: drawn once for a film, with a mark that moves over them."""

from html import escape
from typing import Any, Final

import numpy as np

from ...types import Floats
from .. import style
from ..panel import Gauges
from ..recording import Recording

POINTS: Final = 240
"""Of a curve, at most."""
FULL: Final = 0.6
"""Curves that fill less of the way to their limit are drawn larger, and their limit is told in words [-]."""
WIDE, HIGH = 300, 90
"""Of the drawing, in its own units."""
PAD: Final = "padding:0 12px"


class Curves:
    """Values of one block of a film's bars over its time.

    Args:
        film: The film.
        block: Number of the block.
    """

    def __init__(self, film: Recording[Any], block: int) -> None:
        self.seconds, self.gauges = film.seconds, film.gauges[block]
        self.times: Floats = np.linspace(0.0, film.seconds, POINTS)
        self.values: Floats = np.abs([film.values(film.at(time))[block] for time in self.times.tolist()])
        """Sizes, as the bars have them, shape (POINTS, n)."""

    def html(self) -> str:
        """The curves, their limits, scale and names."""
        gauges = self.gauges
        shares = (self.values - gauges.low) / (gauges.high - gauges.low)
        most = float(np.nanmax(shares, initial=1e-6))
        top = max(1.0, most) if most > FULL else 1.15 * most
        lines = "".join(
            f'<polyline points="{_points(shares[:, k] / top)}" fill="none" stroke="{gauges.colours[k]}" stroke-width="1.3" '
            f'vector-effect="non-scaling-stroke"/>'
            for k in range(shares.shape[1])
        )
        marks = [(share, "turns red") for share in gauges.calm if 0.0 < share < 1.0] + list(gauges.limits)
        limits = "".join(
            f'<line x1="0" x2="{WIDE}" y1="{HIGH * (1.0 - share / top):.1f}" y2="{HIGH * (1.0 - share / top):.1f}" stroke="{style.ALERT}" '
            f'stroke-dasharray="{"3 3" if words == "turns red" else "none"}" vector-effect="non-scaling-stroke"/>'
            for share, words in marks
            if share <= top
        )
        key = "".join(
            f'<span style="white-space:nowrap;margin-right:8px"><span style="color:{shade}">&#9473;</span> {escape(name)}</span> '
            for name, shade in _key(gauges)
        )
        return (
            f'<div data-clamber="curves" style="font-size:11px;color:{style.QUIET};{PAD}"><div>{key}</div>'
            f"<div>{escape(self._scale(top, marks))}</div>"
            f'<svg viewBox="0 0 {WIDE} {HIGH}" preserveAspectRatio="none" style="width:100%;height:{HIGH}px;display:block;background:#fff;'
            f'border:1px solid {style.FAINT};box-sizing:border-box">{limits}{lines}</svg></div>'
        )

    def _scale(self, top: float, marks: list[tuple[float, str]]) -> str:
        """What the edges of the drawing are, and the limits, those that lie above it, too."""
        gauges = self.gauges
        same = bool(np.ptp(gauges.high) < 1e-9 and np.ptp(gauges.low) < 1e-9)

        def value(share: float) -> str:
            at = float(gauges.low[0] + share * (gauges.high - gauges.low)[0])
            return gauges.show(at) if same else f"{100.0 * share:.0f} % of the limit"

        told = [
            f"{words} {value(share)}{'' if share <= top else ', above'}"
            for share, words in marks
            if same or words == "turns red"
        ]
        return "; ".join((f"top {value(top)}", *told, f"right {self.seconds:.1f} s"))

    def mark_html(self, time: float) -> str:
        """Where a time [s] is along the curves."""
        at = WIDE * min(max(time / self.seconds, 0.0), 1.0) if self.seconds > 0.0 else 0.0
        return (
            f'<div data-clamber="now" style="{PAD}"><svg viewBox="0 0 {WIDE} 8" preserveAspectRatio="none" style="width:100%;height:8px;'
            f'display:block"><path d="M{at - 4:.1f} 8 L{at:.1f} 0 L{at + 4:.1f} 8 Z" fill="{style.INK}"/></svg></div>'
        )


def _points(shares: Floats) -> str:
    """A curve's corners; where nothing is told it lies at the bottom."""
    heights = HIGH * (1.0 - np.nan_to_num(shares))
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in zip(np.linspace(0.0, WIDE, len(shares)), heights, strict=True))


def _key(gauges: Gauges) -> list[tuple[str, str]]:
    """Names and colours: one for each colour, of what all of its names begin with."""
    groups: dict[str, list[str]] = {}
    for name, shade in zip(gauges.names, gauges.colours, strict=True):
        groups.setdefault(shade, []).append(name)
    return [(" to ".join(dict.fromkeys((names[0], names[-1]))), shade) for shade, names in groups.items()]
