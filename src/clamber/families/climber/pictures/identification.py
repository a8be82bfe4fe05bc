"""An identification as a picture: each joint's measured and modelled speed, the torque left over, and its friction curve."""

from pathlib import Path
from typing import Any, Final

import numpy as np

from ....control.identification.joint import IdentifiedJoint, model_speed
from ....types import Floats
from ....viewing import style
from ....viewing.output import drawing
from ..execution.log_identify import Identification

SHOWN: Final = 20.0
"""Longest piece of a log that is drawn over time [s]."""
MOST_POINTS: Final = 2500
"""Windows drawn in a friction curve."""


def draw_identification(result: Identification, path: str | Path) -> None:
    """Draw every joint of an identification, one below the other."""
    count = len(result.joints)
    with drawing(path, (9.2, 3.5 * count + 0.3)) as figure:
        parts = figure.subfigures(count, 1, squeeze=False)[:, 0]
        for part, joint in zip(parts, result.joints, strict=True):
            _draw_joint(part, joint)


def _draw_joint(part: Any, joint: IdentifiedJoint) -> None:
    grid = part.add_gridspec(2, 2, height_ratios=(2.4, 1.0), width_ratios=(1.5, 1.0))
    speeds, left, curve = part.add_subplot(grid[0, 0]), part.add_subplot(grid[1, 0]), part.add_subplot(grid[:, 1])
    span = _telling_span(joint)
    _draw_speeds(speeds, joint, span)
    _draw_left_over(left, joint, span)
    _draw_curve(curve, joint)
    for axes in (speeds, left, curve):
        style.bare(axes)
        axes.grid(color=style.FAINT, lw=0.6)
        axes.set_axisbelow(True)
    for axes in (speeds, left):
        axes.set_xlim(span)
    speeds.tick_params(labelbottom=False)


def _telling_span(joint: IdentifiedJoint) -> tuple[float, float]:
    """The piece of a log in which the speed varies most."""
    time = joint.samples.time
    if time[-1] - time[0] <= SHOWN:
        return float(time[0]), float(time[-1])
    count = round(SHOWN / joint.samples.period)
    varied = np.concatenate(((0.0,), np.cumsum(np.diff(joint.motion.speed) ** 2)))
    start = int(np.argmax(varied[count:] - varied[:-count]))
    return float(time[start]), float(time[start + count])


def _draw_speeds(axes: Any, joint: IdentifiedJoint, span: tuple[float, float]) -> None:
    time = joint.samples.time
    inside = (time >= span[0]) & (time <= span[1])
    axes.plot(time[inside], joint.motion.speed[inside], color=style.PARTS[4], lw=3.0, label="measured")
    model = model_speed(joint)
    if model is not None:
        axes.plot(time[inside], model[inside], color=style.INK, lw=1.0, label="model, driven by the log's torque")
    axes.set_ylabel("speed [rad/s]")
    axes.set_title(joint.samples.name)
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, fontsize=8, borderaxespad=0.1)


def _draw_left_over(axes: Any, joint: IdentifiedJoint, span: tuple[float, float]) -> None:
    """Torque per window that the model does not explain; nothing is drawn where the joint may stand."""
    axes.set_ylabel("left over\n[N m]")
    axes.set_xlabel("time [s]")
    if joint.fit is None or joint.fit.rows is None:
        return
    rows, fit = joint.fit.rows, joint.fit
    rest = rows.torques(fit.lag) - rows.regressors @ fit.values
    axes.plot(rows.centres, rest, color=style.PARTS[1], ls="none", marker=".", ms=2.5)
    inside = (rows.centres >= span[0]) & (rows.centres <= span[1])
    most = 1.2 * float(np.max(np.abs(rest[inside if inside.any() else slice(None)])))
    axes.set_ylim(-most, most)
    axes.axhline(0.0, color=style.QUIET, lw=0.6)


def _draw_curve(axes: Any, joint: IdentifiedJoint) -> None:
    """Torque without inertia's part over speed, window by window, and the line d qd + tau_f sign(qd) through it."""
    axes.set_xlabel("speed [rad/s]")
    axes.set_ylabel("torque without inertia's part [N m]")
    if joint.fit is None or joint.fit.rows is None:
        axes.text(0.5, 0.5, "no motion to fit", transform=axes.transAxes, ha="center", color=style.QUIET)
        return
    rows, values = joint.fit.rows, joint.fit.values
    speed = rows.regressors[:, 1]
    torque = rows.torques(joint.fit.lag) - rows.regressors[:, 0] * values[0]
    every = max(1, speed.size // MOST_POINTS)
    axes.plot(speed[::every], torque[::every], color=style.PARTS[4], ls="none", marker=".", ms=2.5, alpha=0.7)
    for sign in (-1.0, 1.0):
        side = speed[speed * sign > 0.0]
        if side.size:
            ends: Floats = np.array((0.0, sign * float(np.abs(side).max())))
            axes.plot(ends, values[3] + values[1] * ends + sign * values[2], color=style.INK, lw=1.4)
    axes.axhline(0.0, color=style.QUIET, lw=0.6)
    axes.axvline(0.0, color=style.QUIET, lw=0.6)
    axes.set_title(f"d = {values[1]:.3g} N m s/rad, friction {values[2]:.3g} N m", fontsize=9, fontweight="normal")
