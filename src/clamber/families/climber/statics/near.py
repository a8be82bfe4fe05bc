"""Holds near a place, through the grid: the cost grows with the holds in sight, not with the board."""

import math

from ....compiled import inlined, kernel
from ....plane import wrap
from .records import cell_start, cells, holds

SIGHT = 1.0
"""How far holds are looked for [m]."""


@inlined
def cells_about(p, x, y, radius):
    """Range of grid cells that a circle may touch: first and last column, first and last row (empty if first > last)."""
    x0 = max(0, int(math.floor((x - radius - p.grid_x) / p.grid_cell)))
    x1 = min(p.grid_nx - 1, int(math.floor((x + radius - p.grid_x) / p.grid_cell)))
    y0 = max(0, int(math.floor((y - radius - p.grid_y) / p.grid_cell)))
    y1 = min(p.grid_ny - 1, int(math.floor((y + radius - p.grid_y) / p.grid_cell)))
    return x0, x1, y0, y1


@inlined
def cells_in_row(p, row, x0, x1):
    """Where the holds of one row of cells, columns x0 to x1, lie in `cells`: first and end."""
    if x0 > x1:
        return 0, 0
    base = row * p.grid_nx
    return cell_start(p)[base + x0], cell_start(p)[base + x1 + 1]


@inlined
def nearest_hold(p, x, y):
    """Distance of the nearest hold from a point [m]; infinity if none is within sight."""
    best = math.inf
    radius = p.grid_cell
    while True:
        x0, x1, y0, y1 = cells_about(p, x, y, radius)
        for row in range(y0, y1 + 1):
            first, end = cells_in_row(p, row, x0, x1)
            for at in range(first, end):
                hold = holds(p)[cells(p)[at]]
                dx = hold.x - x
                dy = hold.y - y
                best = min(best, dx * dx + dy * dy)
        if best <= radius * radius or radius >= SIGHT:
            break
        radius = min(SIGHT, 2.0 * radius)
    best = math.sqrt(best)
    return best if best <= SIGHT else math.inf


@kernel
def arc_clearance(p, hx, hy, radius, angle, turn):
    """Distance of the nearest hold from the arc about (hx, hy) that starts at `angle` and goes on by `turn` [m]."""
    best = math.inf
    x0, x1, y0, y1 = cells_about(p, hx, hy, radius + SIGHT)
    ax = hx + radius * math.cos(angle)
    ay = hy + radius * math.sin(angle)
    bx = hx + radius * math.cos(angle + turn)
    by = hy + radius * math.sin(angle + turn)
    for row in range(y0, y1 + 1):
        first, end = cells_in_row(p, row, x0, x1)
        for at in range(first, end):
            hold = holds(p)[cells(p)[at]]
            dx = hold.x - hx
            dy = hold.y - hy
            d = math.sqrt(dx * dx + dy * dy)
            near = min(math.hypot(hold.x - ax, hold.y - ay), math.hypot(hold.x - bx, hold.y - by))
            if d > 0.0:
                ahead = wrap(math.atan2(dy, dx) - angle)
                if 0.0 <= ahead <= turn or turn <= ahead <= 0.0:
                    near = min(near, abs(d - radius))
            else:
                near = min(near, radius)
            best = min(best, near)
    return best if best <= SIGHT else math.inf
