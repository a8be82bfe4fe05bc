"""A law's portrait as one picture: step, circle and push or wall, on the same scales for every law so that they can be compared."""

import math
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...control.law_settings import LawSettings
from ...sim.flaw_texts import SET
from ...viewing import style
from ...viewing.output import CANVASES, check_suffix, save_figure
from ...viewing.style import LAW_COLOURS, styled
from ..entries import gain_unit
from ..measures import ForceMeasures, Measured, Measures, components, radial_error
from ..portrait import Portrait
from .panels import MM, dress

DPI: Final = 110
"""Of a file of pixels: about 900 by 400 of them."""
COLOURS: Final = 96
"""Of such a file."""
TIMES: Final = 3
"""By how much the distance from the circle is drawn larger than it is, of every law."""
WANTED: Final[dict[str, Any]] = {"color": style.INK, "lw": 0.9, "ls": (0, (2, 2)), "zorder": 2}
LOOKS: Final[dict[str, dict[str, Any]]] = {
    "nominal": {"lw": 1.0, "alpha": 0.55, "zorder": 3},
    "ideal": {"lw": 1.9, "zorder": 4},
}
FORCE_LOOKS: Final = (LOOKS["nominal"], LOOKS["ideal"])
"""Joint friction left alone, and dealt with."""
LAW_EQUATIONS: Final[dict[str, str]] = {
    "jacobian-transpose": r"$\tau = J^T (K_p e + K_d \dot e)$",
    "operational-space": r"$\tau = H J^{-1} (K_p e + K_d \dot e - \dot J \dot\theta) + h + g$",
    "resolved-rate": r"$\tau = k_d\,\{J^{-1} (\dot x_{des} + K_p e \,/\, k_d) - \dot\theta\}$",
    "resolved-rate-plain": r"$\tau = k_p (\theta_{des} - \theta) + k_d (\dot\theta_{des} - \dot\theta),"
    r"\;\; \theta_{des} = \int J^{-1} \dot x_{des}\, dt$",
    "admittance": r"$\tau = k_d K' \{J^{-1} (\dot x_{des} + \dot z + K_p (e + z) / k_d) - \dot\theta\},"
    r"\;\; m \ddot z + d \dot z + k z = f_{des} - f$",
    "joint-pd": r"$\tau = k_p (\theta_{des} - \theta) + k_d (\dot\theta_{des} - \dot\theta),"
    r"\;\; x(\theta_{des}) = x_{des}$",
    "scct": r"$\tau = K' J^{-1} (K_p e + K_d \dot e)$",
    "implicit-admittance": r"$\tau = (K'_p + K'_d s)\, J^{-1} (K_p e + K_d \dot e)$",
    "hybrid": r"$\tau = K' J^{-1} S (K_p e + K_d \dot e) + J^T (E - S)(f_{des} + f_I + d\,\dot e)$",
    "implicit-force": r"$\tau = K' J^{-1} (K_p (e + f_{des} / k_e) + K_d \dot e) + J^T f_{des}$",
}
"""Name of a law -> its torques."""


def draw_portrait(portrait: Portrait, path: str | Path) -> None:
    """Draw one law."""
    check_suffix(path, CANVASES)
    with styled():
        figure = Figure(figsize=(8.2, 3.65))
        figure.text(
            0.012, 0.975, portrait.law, va="top", fontsize=12, fontweight="bold", color=LAW_COLOURS[portrait.law]
        )
        figure.text(0.988, 0.975, LAW_EQUATIONS[portrait.law], va="top", ha="right", fontsize=10)
        figure.text(0.012, 0.895, _all_gains(portrait), va="top", fontsize=8, color=style.QUIET)
        words = "bold: ideal limb;  thin: backlash, encoders, delay too;  dashed: wanted"
        figure.text(0.988, 0.895, words, va="top", ha="right", fontsize=8, color=style.QUIET)
        left, middle, right = (
            figure.add_axes(box)
            for box in ((0.062, 0.125, 0.2, 0.6), (0.314, 0.125, 0.267, 0.6), (0.642, 0.125, 0.345, 0.6))
        )
        _draw_step(left, portrait)
        _draw_circle(middle, portrait)
        (_draw_force if portrait.forces else _draw_push)(right, portrait)
        save_figure(figure, path, DPI, COLOURS)


def _all_gains(portrait: Portrait) -> str:
    if not portrait.forces:
        return _gains(portrait.settings)
    wall = portrait.forces["nominal"][0].entry.settings
    return f"{_gains(portrait.settings)};  wall: {wall.kp:.4g}, {wall.kd:.4g}"


def _gains(settings: LawSettings) -> str:
    told = (f"{key} {getattr(settings, key):.4g} {gain_unit(settings.law, key)}" for key in ("kp", "kd"))
    return ", ".join(told)


def _frame(axes: Axes, title: str, told: str, across: str, up: str) -> None:
    dress(axes, across, up, fontsize=8)
    axes.text(0.0, 1.1, title, transform=axes.transAxes, fontsize=8.5, fontweight="bold")
    axes.text(0.0, 1.025, told, transform=axes.transAxes, fontsize=8)


def _both(portrait: Portrait, name: str) -> str:
    """A figure on both plants [mm]."""
    values = (portrait.figures()[name][plant] for plant in SET)
    return " / ".join("unstable" if value is None else f"{MM * value:.2f}" for value in values) + " mm"


def _look(portrait: Portrait, plant: str) -> dict[str, Any]:
    return {"color": LAW_COLOURS[portrait.law], "solid_capstyle": "round", **LOOKS[plant]}


def _errors(motion: Measured[Measures], direction: tuple[float, float]) -> tuple[Any, Any]:
    """Along and across, from the aim [mm]."""
    trace = motion.run.trace
    along, across = components((trace.true_places() - trace.wanted_places())[:, 0, :2], direction)
    return MM * along, MM * across


def _draw_step(axes: Axes, portrait: Portrait) -> None:
    direction = portrait.scenarios["step"].direction
    for plant, motion in portrait.motions["step"].items():
        along, across = _errors(motion, direction)
        axes.plot(across, -20.0 - along, **_look(portrait, plant))
    axes.plot([0.0, 0.0], [0.0, -20.0], **WANTED)
    axes.plot([0.0], [-20.0], ls="none", marker="+", ms=9, color=style.INK, zorder=5)
    axes.set_xlim(-4.0, 4.0)
    axes.set_ylim(-30.0, 3.0)
    axes.set_xticks((-4, -2, 0, 2, 4))
    _frame(axes, "Step of 2 cm", f"across: {_both(portrait, 'step')}", "across [mm]", "along [mm]")


def _draw_circle(axes: Axes, portrait: Portrait) -> None:
    scenario = portrait.scenarios["circle"]
    assert scenario.centre is not None and scenario.radius is not None
    centre, radius = MM * np.array(scenario.centre), MM * scenario.radius
    angles = np.linspace(0.0, math.tau, 361)
    axes.plot(centre[0] + radius * np.cos(angles), centre[1] + radius * np.sin(angles), **WANTED)
    for plant, motion in portrait.motions["circle"].items():
        trace = motion.run.trace
        places = trace.true_places()[trace.time >= scenario.settle, 0, :2]
        size = radius + TIMES * MM * radial_error(places, scenario)
        x, y = (MM * places - centre).T
        turn = np.arctan2(y, x)
        axes.plot(centre[0] + size * np.cos(turn), centre[1] + size * np.sin(turn), **_look(portrait, plant))
    axes.set_aspect("equal")
    for set_limits, value in ((axes.set_xlim, centre[0]), (axes.set_ylim, centre[1])):
        set_limits(value - 1.9 * radius, value + 1.9 * radius)
    _frame(axes, f"Circle in 3 s, error x {TIMES}", f"radial RMS: {_both(portrait, 'circle')}", "x [mm]", "y [mm]")


def _draw_push(axes: Axes, portrait: Portrait) -> None:
    scenario = portrait.scenarios["push"]
    assert scenario.push is not None
    push = scenario.push
    axes.axvspan(push.start, push.end + push.rise, color=style.FAINT, alpha=0.6, lw=0)
    axes.axhline(0.0, **WANTED)
    for plant, motion in portrait.motions["push"].items():
        axes.plot(motion.run.trace.time, _errors(motion, scenario.direction)[0], **_look(portrait, plant))
    axes.set_xlim(0.0, 5.0)
    axes.set_ylim(-6.0, 7.0)
    told = f"yields by {_both(portrait, 'push')}"
    _frame(axes, f"Push of {push.x:g} N along x, and release", told, "time [s]", "along the push [mm]")


def _draw_force(axes: Axes, portrait: Portrait) -> None:
    task = portrait.task
    axes.axhspan(task.force - task.tolerance, task.force + task.tolerance, color=style.GOAL, alpha=0.22, lw=0)
    rows = portrait.forces["nominal"]
    for row, look in zip(rows, FORCE_LOOKS, strict=True):
        way = row.entry.label.partition(" / ")[2]
        label = "friction left alone" if way == "none" else f"friction: {way}"
        axes.plot(
            row.run.trace.time, row.run.force_into(task.angle), color=LAW_COLOURS[portrait.law], label=label, **look
        )
    trace = rows[0].run.trace
    axes.plot(trace.time, np.linalg.norm(trace.aims["wrench"][:, 0, :2], axis=1), **WANTED)
    axes.axvline(task.slide_from, color=style.QUIET, lw=0.7, ls=":")
    axes.axvline(task.slide_from + task.sliding, color=style.QUIET, lw=0.7, ls=":")
    axes.text(task.slide_from + 0.5 * task.sliding, 24.5, "slides", ha="center", fontsize=7.5, color=style.QUIET)
    axes.set_xlim(0.0, task.seconds)
    axes.set_ylim(0.0, 27.0)
    axes.legend(loc="lower right", fontsize=7.5)
    told = f"largest error: {_worst(rows[0].measures)} alone, {_worst(rows[1].measures)} dealt with"
    _frame(axes, f"{task.force:g} N on a wall (backlash, encoders, delay)", told, "time [s]", "force [N]")


def _worst(measures: ForceMeasures) -> str:
    return f"{measures.worst:.2f} N" if math.isfinite(measures.worst) else "lost"
