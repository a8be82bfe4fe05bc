"""The start stance where a climb needs least torque: on the holds of the task's start, anywhere the body can go without letting go."""

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Final, TypeAlias

import numpy as np

from ...errors import StartError
from ...planning.problem.problems import pose_problem
from ...types import Json
from ..bevly_1997.replayed import limbed_task
from .boards import MODEL
from .proofs import Proof, proof_of, prove

MOVES: Final = 'rules.allowed=["+x","-x","+y","-y","+theta","-theta"]'
"""Only the body moves."""

Place: TypeAlias = tuple[str, int, int, int]
"""Limb that moved last, and the body's steps in x, y and angle from the task's start."""


@dataclass(frozen=True, slots=True)
class Calm:
    """The start of least need, and the proof of what is needed from there."""

    proof: Proof
    start_torque: float
    """Largest joint torque of that start stance itself [N m]."""
    calmest: float
    """The least that any of the start stances has [N m], whatever it leads to."""
    places: int
    """Start stances that were compared."""
    searches: int
    """Whole searches that this took."""


def calmest(board: str) -> Calm:
    """Find the start of least need.

    Body moves can be undone, so starts that moves join under a limit can all do the same under it. Of each such group one start is
    searched whole; what it needs is the next, lower limit, until no start is left below the limit.
    """
    loads = places_on_start_holds(board)
    left = dict(loads)
    best: tuple[Proof, Place] | None = None
    searches = 0
    while left:
        place = min(left, key=lambda key: (left[key], key))
        proof = prove(board, (*MODEL, *start_at(board, place)), minimize=("torque",))
        searches += 1
        assert proof.feasible and proof.torque is not None, f"{board}: {proof.reason}"
        group = joined(place, left)
        if best is None or best[0].torque is None or proof.torque < best[0].torque:
            best = proof, place
        under = best[0].torque or 0.0
        left = {key: load for key, load in left.items() if key not in group and load < under * (1.0 - 1e-9)}
    assert best is not None, f"{board}: its own start is a place"
    shortest = prove(board, best[0].overrides, minimize=("torque", "length"))
    return Calm(shortest, loads[best[1]], min(loads.values()), len(loads), searches)


def places_on_start_holds(board: str) -> dict[Place, float]:
    """Every start that holds on the holds of the task's start, with its largest joint torque [N m]."""
    loads: dict[Place, float] = {}
    for limb in limbed_task(board).robot.limb_names:
        try:
            problem = pose_problem(limbed_task(board, (*MODEL, MOVES, f"start.in_use={limb}")), threads=1).problem
        except StartError:  # with this limb idle the others can't carry
            continue
        step = limbed_task(board, MODEL).step
        turn = round(2.0 * np.pi / step.angle)
        origin = problem.start[0]
        layer = problem.start
        while len(layer):
            fresh = []
            peaks = problem.measured(layer)[:, problem.features.index("peak")]
            for k, stance in enumerate(layer):
                place = (
                    limb,
                    round((stance["x"] - origin["x"]) / step.length),
                    round((stance["y"] - origin["y"]) / step.length),
                    round((stance["angle"] - origin["angle"]) / step.angle) % turn,
                )
                if place not in loads:
                    loads[place] = float(peaks[k])
                    fresh.append(k)
            layer = problem.expand(layer[fresh]).stance if fresh else layer[:0]
    return loads


def start_torque(board: str) -> float:
    """Largest joint torque of the task's start stance [N m]."""
    problem = pose_problem(limbed_task(board, MODEL), threads=1).problem
    return float(problem.measured(problem.start)[0, problem.features.index("peak")])


def start_at(board: str, place: Place) -> tuple[str, ...]:
    """The overrides that start a task at a place."""
    task = limbed_task(board, MODEL)
    limb, x, y, angle = place
    return (
        f"start.in_use={limb}",
        f"start.x={task.start.x + x * task.step.length!r} m",
        f"start.y={task.start.y + y * task.step.length!r} m",
        f"start.theta={task.start.theta + angle * task.step.angle!r} rad",
    )


def joined(place: Place, among: Iterable[Place]) -> set[Place]:
    """The places that single body moves join to one, itself included."""
    turn = round(2.0 * np.pi / limbed_task("ladder", MODEL).step.angle)
    left, edge, group = set(among), [place], {place}
    while edge:
        limb, x, y, angle = edge.pop()
        for dx, dy, da in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)):
            near = (limb, x + dx, y + dy, (angle + da) % turn)
            if near in left and near not in group:
                group.add(near)
                edge.append(near)
    return group


def calmest_item(item: Json) -> Json:
    """`calmest` in a worker."""
    return asdict(calmest(item["board"]))


def calm_of(told: Json) -> Calm:
    """From plain data."""
    return Calm(**told | {"proof": proof_of(told["proof"])})
