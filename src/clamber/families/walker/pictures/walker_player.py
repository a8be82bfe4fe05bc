# ruff: noqa: E501 - the script is part of a page, not code
"""A walker for the player: its world and its moments as data, and the script that draws them."""

from typing import Final

import numpy as np

from ....types import Json
from ....viewing.player import round_all
from ....viewing.scene import Bounds, goal_box, name_goal
from ....viewing.view import Spread
from ....viewing.words import length_unit
from ..planning.problem import carried_weight
from ..planning.task import WalkerTask
from .walker_artists import COLOURS, RISE, SUPPORT, block_colour, foot_radius
from .walker_motion import WalkerMoment


def walker_world(task: WalkerTask, bounds: Bounds) -> Json:
    """Patches, goals, the shape of the robot and where its weight is."""
    weight = carried_weight(task)
    return {
        "unit": length_unit(task),
        "forbidden": [[round_all(corner) for corner in patch] for patch in task.world.forbidden()],
        "blocks": [
            {"corners": [round_all(corner) for corner in block.corners()], "colour": block_colour(block.height)}
            for block in task.world.raised()
        ],
        "goals": [
            {
                "corners": [round_all(c) for c in corners],
                "label": name_goal(task.goals, k),
                "last": k == len(task.goals) - 1,
            }
            for k, goal in enumerate(task.goals)
            if (corners := goal_box(goal, bounds)) is not None
        ],
        "colours": COLOURS,
        "support": SUPPORT,
        "rise": RISE,
        "joints": task.robot.attachments().tolist(),
        "feet": task.robot.feet().tolist(),
        "foot": foot_radius(task, bounds),
        "share": weight.share.tolist(),
        "load": weight.load.tolist(),
    }


def spread_moment(at: WalkerMoment) -> Spread:
    """Origins of both frames and their lifts; their angles."""
    return Spread(np.concatenate([at.poses[:, :2].ravel(), at.lifts]), at.poses[:, 2], ())


SCRIPT: Final = r"""function robot({ g, s, X, Y, k, H, path, text }) {
  const o = [[s.at[0], s.at[1]], [s.at[2], s.at[3]]], lift = [s.at[4], s.at[5]];
  const place = f => p => { const c = Math.cos(s.angles[f]), q = Math.sin(s.angles[f]); return [o[f][0] + c * p[0] - q * p[1], o[f][1] + q * p[0] + c * p[1]]; };
  const joints = D.joints.map((row, f) => row.map(place(f))), feet = D.feet.map((row, f) => row.map(place(f)));
  const down = [0, 1].filter(f => lift[f] < 1e-6);
  path(hull(down.flatMap(f => feet[f]))); g.closePath(); g.globalAlpha = .35; g.fillStyle = D.support; g.fill();
  g.globalAlpha = 1; g.setLineDash([6, 4]); g.strokeStyle = D.support; g.lineWidth = 1.2; g.stroke(); g.setLineDash([]);
  path(joints[0]); g.closePath(); g.globalAlpha = .1; g.fillStyle = D.colours[0]; g.fill(); g.globalAlpha = 1;
  const order = lift[0] > lift[1] ? [1, 0] : [0, 1];
  for (const f of order) {
    const j = joints[f]; path(f ? [j[0], o[1], j[1], o[1], j[2]] : [...j, j[0]]); g.strokeStyle = D.colours[f]; g.lineWidth = 4.5; g.stroke();
  }
  for (const [w, colour] of [[5, "#fff"], [2.6, "#22303c"]]) for (const i of [0, 1, 2]) {
    path([joints[0][i], joints[1][i]]); g.strokeStyle = colour; g.lineWidth = w; g.stroke();
    g.fillStyle = colour; for (const f of [0, 1]) { g.beginPath(); g.arc(X(joints[f][i][0]), Y(joints[f][i][1]), w / 2 + 1.4, 0, 7); g.fill(); }
  }
  for (const f of order) for (const p of feet[f]) {
    g.beginPath(); g.arc(X(p[0]), Y(p[1]), D.foot * k * (1 + D.rise * lift[f]), 0, 7); g.fillStyle = "#fff"; g.fill();
    g.globalAlpha = 1 - lift[f]; g.fillStyle = D.colours[f]; g.fill(); g.globalAlpha = 1; g.strokeStyle = D.colours[f]; g.lineWidth = 2.2; g.stroke();
  }
  const c = Math.cos(s.angles[0]), q = Math.sin(s.angles[0]), mass = k => D.share[0] * o[0][k] + D.share[1] * o[1][k];
  const x = X(mass(0) + c * D.load[0] - q * D.load[1]), y = Y(mass(1) + q * D.load[0] + c * D.load[1]);
  g.beginPath(); g.arc(x, y, 6, 0, 7); g.fillStyle = "#fff"; g.fill(); g.strokeStyle = "#22303c"; g.lineWidth = 1.8; g.stroke();
  g.beginPath(); g.moveTo(x - 6, y); g.lineTo(x + 6, y); g.moveTo(x, y - 6); g.lineTo(x, y + 6); g.stroke();
  g.font = "11px system-ui, sans-serif"; g.textBaseline = "middle"; g.textAlign = "left";
  let left = 10;
  for (const [words, colour] of [["Delta-frame", D.colours[0]], ["Y-frame", D.colours[1]], ["filled feet stand, hollow ones are lifted; shaded: support; ⊕ centre of mass", "#6e7b87"]]) {
    text(words, left, H - 10, colour); left += g.measureText(words).width + 12;
  }
}
function hull(points) {
  const turn = (a, b, c) => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]), out = [];
  for (const row of [sorted, [...sorted].reverse()]) { const side = [];
    for (const p of row) { while (side.length > 1 && turn(side[side.length - 2], side[side.length - 1], p) <= 0) side.pop(); side.push(p); }
    out.push(...side.slice(0, -1)); }
  return out;
}
"""
