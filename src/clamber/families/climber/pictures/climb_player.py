# ruff: noqa: E501 - the script is part of a page, not code
"""A climber for the player: its world and its moments as data, and the script that draws them."""

import math
from typing import Final

import numpy as np

from ....types import Json
from ....viewing import style
from ....viewing.player import round_all
from ....viewing.scene import Bounds
from ....viewing.view import Spread
from ....viewing.words import length_unit
from ..planning.task import LimbedTask
from .climber import Snapshot, force_scale
from .geometry import body_outline
from .torques import nice_force
from .wall import goal_label, goal_outline, hold_radius


def climb_world(task: LimbedTask, bounds: Bounds) -> Json:
    """Holds, keep-outs, goals and the shape of the robot."""
    robot, least = task.robot, hold_radius(task, bounds)
    return {
        "unit": length_unit(task),
        "holds": [
            {
                "at": round_all((hold.x, hold.y)),
                "r": max(hold.radius, least),
                "n": hold.number,
                "cone": None
                if hold.direction is None
                else [hold.direction, math.pi / 2 if hold.cone is None else hold.cone],
            }
            for hold in task.world.holds
        ],
        "forbidden": [[round_all(corner) for corner in polygon] for polygon in task.world.keep_out],
        "goals": [
            {"corners": [round_all(c) for c in corners], "label": goal_label(task, k), "last": k == len(task.goals) - 1}
            for k, goal in enumerate(task.goals)
            if (corners := goal_outline(goal, bounds)) is not None
        ],
        "limbs": [
            {"colour": style.PARTS[i % len(style.PARTS)], "kind": limb.end.kind} for i, limb in enumerate(robot.limbs)
        ],
        "radius": max(robot.link_radius, 0.004),
        "body": [round_all((point.real, point.imag)) for point in body_outline(robot)],
        "forceScale": force_scale(task),
        "forceKey": nice_force(robot.weight),
    }


def spread_snapshot(at: Snapshot) -> Spread:
    """Body's origin, chains and forces [N]; directions of body and end effectors; holds."""
    posture = at.posture
    lengths = np.concatenate([(posture.x, posture.y), posture.chains.ravel(), at.forces.ravel()])
    return Spread(lengths, np.concatenate([[posture.angle], posture.grips]), posture.held)


SCRIPT: Final = r"""function holds(g, X, Y, k, text) {
  g.font = "11px system-ui, sans-serif"; g.textAlign = "right"; g.textBaseline = "bottom";
  for (const h of D.holds) {
    if (h.cone) { g.beginPath(); g.moveTo(X(h.at[0]), Y(h.at[1])); g.arc(X(h.at[0]), Y(h.at[1]), 3.2 * h.r * k, -h.cone[0] - h.cone[1], -h.cone[0] + h.cone[1]);
      g.fillStyle = D.palette.hold + "44"; g.fill(); }
    g.beginPath(); g.arc(X(h.at[0]), Y(h.at[1]), h.r * k, 0, 7); g.fillStyle = D.palette.hold; g.fill();
    text(h.n, X(h.at[0]) - 3, Y(h.at[1]) - 3, "#6e7b87");
  }
}
function arrow(g, x0, y0, x1, y1) {
  const a = Math.atan2(y1 - y0, x1 - x0), c = D.palette.force; g.strokeStyle = g.fillStyle = c; g.lineWidth = 2;
  g.beginPath(); g.moveTo(x0, y0); g.lineTo(x1 - 5 * Math.cos(a), y1 - 5 * Math.sin(a)); g.stroke();
  g.beginPath(); g.moveTo(x1, y1); g.lineTo(x1 - 8 * Math.cos(a - .45), y1 - 8 * Math.sin(a - .45)); g.lineTo(x1 - 8 * Math.cos(a + .45), y1 - 8 * Math.sin(a + .45)); g.fill();
}
function robot({ g, s, X, Y, k, H, path, text }) {
  holds(g, X, Y, k, text);
  const n = D.limbs.length, [bx, by] = s.at, a = s.angles[0], c = s.at.slice(2, 2 + 8 * n), f = s.at.slice(2 + 8 * n), ca = Math.cos(a), sa = Math.sin(a), body = D.body.map(p => [bx + ca * p[0] - sa * p[1], by + sa * p[0] + ca * p[1]]);
  path(body); g.closePath(); g.fillStyle = D.palette.body; g.fill(); g.strokeStyle = "#22303c"; g.lineWidth = 1.5; g.stroke();
  const up = Math.min(...D.body.map(p => Math.hypot(...p))) * .5; path([[bx, by], [bx - sa * up, by + ca * up]]); g.stroke();
  for (let i = 0; i < n; i++) {
    const p = [0, 1, 2, 3].map(q => [c[8 * i + 2 * q], c[8 * i + 2 * q + 1]]), limb = D.limbs[i], h = s.marks[i];
    for (const [from, to, w] of [[0, 1, 1], [1, 2, .8]]) { for (const [colour, extra] of [["#fff", 1.6], [limb.colour, 0]]) {
      path([p[from], p[to]]); g.strokeStyle = colour; g.lineWidth = 2 * D.radius * w * k + extra; g.stroke(); } }
    path([p[2], p[3]]); g.strokeStyle = limb.colour; g.lineWidth = 2; g.stroke();
    if (h >= 0) { const hold = D.holds[h]; g.beginPath(); g.arc(X(hold.at[0]), Y(hold.at[1]), 1.25 * hold.r * k, 0, 7); g.fillStyle = limb.colour; g.fill(); }
    const r = 1.35 * Math.max(D.holds[0].r * 2.2, D.radius * .9) * k, x = X(p[3][0]), y = Y(p[3][1]), d = -s.angles[i + 1];
    g.lineWidth = 2.2; g.beginPath();
    if (limb.kind === "foot") { g.moveTo(x - r * Math.sin(d), y + r * Math.cos(d)); g.lineTo(x + r * Math.sin(d), y - r * Math.cos(d)); }
    else { const gap = limb.kind === "hook" ? 1.31 : h >= 0 ? .21 : 1.05; g.arc(x, y, r, d + gap, d + 2 * Math.PI - gap); }
    g.stroke(); g.fillStyle = "#fff";
    for (const q of [0, 1]) { g.beginPath(); g.arc(X(p[q][0]), Y(p[q][1]), 2.2, 0, 7); g.fill(); }
  }
  for (let i = 0; i < n; i++) {
    const x = c[8 * i + 6], y = c[8 * i + 7], fx = f[2 * i], fy = f[2 * i + 1];
    if (s.marks[i] >= 0 && Math.hypot(fx, fy) * D.forceScale * k > 4) arrow(g, X(x), Y(y), X(x + fx * D.forceScale), Y(y + fy * D.forceScale));
    if (s.marks[i] >= 0) { g.font = "bold 12px system-ui, sans-serif"; g.textAlign = "right"; g.textBaseline = "bottom"; const h = D.holds[s.marks[i]]; text(h.n, X(h.at[0]) - 5, Y(h.at[1]) - 5, "#22303c"); }
  }
  g.font = "11px system-ui, sans-serif"; g.textBaseline = "middle"; g.textAlign = "left";
  const L = D.forceKey * D.forceScale * k; arrow(g, 10, H - 10, 10 + L, H - 10); g.fillStyle = "#6e7b87"; g.fillText(D.forceKey + " N", 16 + L, H - 10);
}
"""
