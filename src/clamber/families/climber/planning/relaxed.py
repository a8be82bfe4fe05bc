"""The relaxed problem of a limbed climber as arrays: its exact distances are the bound of exact search.

Without forces, and for robots of more than three limbs without the limbs beyond a pair, the stances are few: every one is looked at once,
backward from the goals, all angles together. Every valid action is an action of the relaxed problem too, so what is left of a stance there
is never more than what is left of it in truth, and an action lowers it by one at most: the bound is admissible and consistent.
"""

import math
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from ....planning.problem.arrays import AnyArray, Params
from ....planning.problem.check import TICKS
from ..statics.elbows import EVERY
from ..statics.records import STANCE
from ..statics.stance import HANGS, REACH
from .relaxed_places import SECTORS, UNREACHED, find_grips, number_states
from .relaxed_sweep import find_beside, mark_goals, sort_sources, sweep_back

MOST_BYTES: Final = 192 << 20
"""Of the table; a larger one costs more than it saves: then rotation is free in it, and if that is too large too, there is none."""
MOST_PLACES: Final = 4_000_000
FIRST_ROOM: Final = 1 << 16
"""Grips that there is room for at first."""
PIECE: Final = 1024
"""Places whose grips are listed between two looks at the clock."""


def with_bound(params: Params, is_late: Callable[[], bool] = lambda: False) -> Params:
    """The parameters with a table that makes `bound` the fewest actions of the relaxed problem.

    The same parameters where it says nothing (hangs without end, `reach` or `hangs` not hard, a robot of one limb) or doesn't fit.

    Args:
        params: Of the task.
        is_late: Asked again and again whether there is no more time. Then the table stays as far as it has come: what is not known to
            be nearer to the goals is at least as far off as the search has come, which is a bound as good as any, only lower.
    """
    record: Any = params.record
    needed = 1 << REACH | 1 << HANGS
    if record["max_hangs"] < 0 or record["hard"] & needed != needed or record["n_limbs"] < 2:
        return params
    fields = _frame(params)
    places = fields["places_nx"] * fields["places_ny"]
    if places > MOST_PLACES:
        return params
    framed = params.extended(fields)
    scratch = np.zeros(1, STANCE)
    scratch["hold"], scratch["elbows"] = -1, EVERY
    grips = _grips(framed, scratch, places, is_late)
    if grips is None:
        return params
    starts, found, masks, grabs = grips
    limbs = int(record["n_limbs"])
    base = np.zeros(places * (limbs * (limbs - 1) // 2 + 1) + 1, np.int64)
    framed = framed.extended({}, grip_starts=starts, grip_holds=found, state_base=base)
    layers = int(record["n_goals"]) * fields["laps_most"]
    states = int(number_states(framed.record, base, MOST_BYTES // (2 * layers)))
    if states <= 0:
        return params
    kept = fields["angles"]
    if kept > SECTORS or 2 * layers * states * kept > MOST_BYTES:
        kept = 1
    left = np.full(layers * states * kept, UNREACHED, np.uint16)
    full = framed.extended({"angles_kept": kept}, left=left)
    place_of = np.repeat(np.arange(places, dtype=np.int32), np.diff(base[:: (len(base) - 1) // places]))
    _sweep(full, scratch, masks, grabs, place_of, left.reshape(int(record["n_goals"]), -1), is_late)
    return full


def _frame(params: Params) -> dict[str, int]:
    """The box of places from which two limbs might hold, and how many angles and laps are told apart."""
    record: Any = params.record
    limbs: Any = params.array("limbs")
    holds: Any = params.array("holds")
    goals: Any = params.array("goals")
    stride = float(record["tick"]) * TICKS
    sight = float(np.max(limbs["length"] + np.hypot(limbs["port_x"], limbs["port_y"])))
    low = [math.floor((float(holds[axis].min()) - sight - float(record[f"{axis}0"])) / stride) for axis in "xy"]
    high = [math.ceil((float(holds[axis].max()) + sight - float(record[f"{axis}0"])) / stride) for axis in "xy"]
    turns = [float(goal["turns"]) / math.tau for goal in goals]
    least = min(0, math.floor(min(turns)) - 1) if min(turns) < 0.0 else 0
    most = max(0, math.ceil(max(turns)) + 1) if max(turns) > 0.0 else 0
    return {
        "places_x": low[0],
        "places_y": low[1],
        "places_nx": high[0] - low[0] + 1,
        "places_ny": high[1] - low[1] + 1,
        "angles": int(record["turn_ticks"]) // TICKS,
        "laps_least": least,
        "laps_most": most - least + 1,
    }


def _grips(
    framed: Params, scratch: Any, places: int, is_late: Callable[[], bool]
) -> tuple[AnyArray, AnyArray, AnyArray, AnyArray] | None:
    """The grips of every place: starts, holds, angles that hold, angles that grab; None if there was no time for all."""
    starts = np.zeros(places * int(framed.record["n_limbs"]) + 1, np.int32)
    listed = np.zeros(FIRST_ROOM, np.int32), np.zeros(FIRST_ROOM, np.uint64), np.zeros(FIRST_ROOM, np.uint64)
    n = first = 0
    while first < places:
        if is_late():
            return None
        end = min(places, first + PIECE)
        fits = find_grips(framed.record, scratch[0], (first, end), n, starts, listed)
        if fits < 0:
            found, masks, grabs = (np.concatenate((part, np.zeros(3 * len(part), part.dtype))) for part in listed)
            listed = found, masks, grabs
        else:
            n, first = fits, end
    found, masks, grabs = (part[:n] for part in listed)
    return starts, found, masks, grabs


def _sweep(
    full: Params, scratch: Any, masks: AnyArray, grabs: AnyArray, place_of: AnyArray, left: Any, is_late: Callable[[], bool]
) -> None:  # fmt: skip
    """Fill the table, the last goal first, as far as there is time."""
    record: Any = full.record
    cells = len(place_of) * int(record["laps_most"])
    cross = _crossings(record)
    beside = np.zeros((len(masks), 4), np.int16)
    find_beside(record, beside)
    members = np.zeros((3, 2), np.int64)
    for stage in range(len(left) - 1, -1, -1):
        mark_goals(record, scratch[0], stage, masks, left[stage], members)
        first_of = np.zeros(UNREACHED + 2, np.int64)
        order = np.zeros(int(np.count_nonzero(left[stage] < UNREACHED)), np.int64)
        sort_sources(left[stage], first_of, order)
        last = int(np.searchsorted(first_of, len(order))) + 1
        at_layer = np.zeros(3, np.int64)
        reached, pending, carried = (np.zeros(cells, np.uint64) for _ in range(3))
        scratch_of_stage = reached, pending, np.zeros((2, cells), np.int64), carried, members
        more = True
        while more:
            if is_late():
                np.minimum(left[stage], np.uint16(at_layer[0]), out=left[stage])
                left[:stage] = 0
                return
            more = sweep_back(
                record, (masks, grabs), (beside, cross), place_of, left[stage], (first_of[: last + 1], order), scratch_of_stage, at_layer,
            )  # fmt: skip


def _crossings(record: Any) -> AnyArray:
    """Change of the lap of a step from each place along +x, -x, +y, -y: over the branch cut of atan2 about the task's centre."""
    nx, ny = int(record["places_nx"]), int(record["places_ny"])
    cross = np.zeros((nx * ny, 4), np.int8)
    if not record["circles"]:
        return cross
    column, row = np.meshgrid(np.arange(-1, nx + 1), np.arange(-1, ny + 1))
    x = record["x0"] + (column + record["places_x"]) * TICKS * record["tick"]
    y = record["y0"] + (row + record["places_y"]) * TICKS * record["tick"]
    bearing = np.arctan2(y - record["centre_y"], x - record["centre_x"])
    here = bearing[1:-1, 1:-1]
    for axis, there in enumerate((bearing[1:-1, 2:], bearing[1:-1, :-2], bearing[2:, 1:-1], bearing[:-2, 1:-1])):
        turn = there - here
        cross[:, axis] = ((turn < -np.pi).astype(np.int8) - (turn > np.pi).astype(np.int8)).ravel()
    return cross
