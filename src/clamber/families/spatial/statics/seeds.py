"""Tables of seeds, made once for a robot and kept in memory and on disk; limbs that are equal but for their mounts share one."""

import contextlib
import hashlib
from collections import OrderedDict
from pathlib import Path
from typing import Final

import numpy as np

from ....kernel_cache import cache_folder, cache_problem
from ....sealed import SealError, read_sealed, write_sealed
from ....types import Floats, Records
from .records import JOINTS, SEEDS, WORK
from .seeds_kernels import TURNS, UNREACHED, refine_seeds, sample_seeds, widen_seeds

CELLS: Final = 24
"""Cells along the longest side of a limb's reach."""
CELLS_ALIGNED: Final = 12
"""The same where each cell has 24 directions."""
SAMPLES: Final = 60_000
SAMPLES_ALIGNED: Final = 300_000
SWEEPS: Final = 4
MOST_KEPT: Final = 16
"""Robots whose tables are kept in memory: a few megabytes each."""
_LIKENESS: Final = ("n_joints", "sliding", "lower", "upper", "nominal", "aligned")
"""Fields of the robot that make two limbs' tables alike, besides their frames after the mount."""


class SeedTable:
    """Seeds of a robot's limbs, and the record that kernels read them by."""

    def __init__(self, robot: Records, file: Path | None = None) -> None:
        """The table of a robot (`robot_record`) from a file, or made: under a second and a half, most of it for limbs that are aligned.

        Args:
            robot: Record of `ROBOT`.
            file: Where it is read from, and written to where it is not there; None: nowhere.
        """
        self.records: Records = np.zeros(1, SEEDS)
        """The record that kernels read it by, as an array of one; valid as long as this object lives."""
        row = self.records[0]
        groups: list[int] = []
        made: list[tuple[Floats, Floats]] = []
        start = 0
        firsts: dict[bytes, int] = {}
        for limb in range(int(robot["n_limbs"][0])):
            alike = _likeness(robot, limb)
            if alike in firsts:
                first = firsts[alike]
                for name in ("cell", "low", "count", "turns", "start"):
                    row[name][limb] = row[name][first]
                continue
            firsts[alike] = limb
            groups.append(limb)
            low, high = _bounds(robot, limb)
            turns = TURNS if robot["aligned"][0, limb] else 1
            cell = max(float((high - low).max()) / (CELLS if turns == 1 else CELLS_ALIGNED), 1e-6)
            count = np.maximum(np.ceil((high - low) / cell).astype(int), 1)
            row["cell"][limb], row["low"][limb], row["count"][limb] = cell, low, count
            row["turns"][limb], row["start"][limb] = turns, start
            n = int(count.prod()) * turns
            made.append((np.zeros((n, JOINTS)), np.full(n, UNREACHED)))
            start += n
        self.postures: Floats = np.concatenate([postures for postures, _ in made])
        self.scores: Floats = np.concatenate([scores for _, scores in made])
        row["n_seeds"] = start
        row["posture_at"], row["score_at"] = self.postures.ctypes.data, self.scores.ctypes.data
        if file is not None and self._read(file):
            return
        work = np.zeros(1, WORK)
        for limb in groups:
            moved = _at_its_mount(robot, limb)
            aligned = bool(robot["aligned"][0, limb])
            sample_seeds(moved[0], row, limb, work[0], SAMPLES_ALIGNED if aligned else SAMPLES)
            refine_seeds(moved[0], row, limb, work[0], SWEEPS)
            widen_seeds(moved[0], row, limb)
        if file is not None:
            with contextlib.suppress(OSError):  # it is made anew another time
                write_sealed(file, self.scores.tobytes() + self.postures.tobytes())

    def _read(self, file: Path) -> bool:
        """Take scores and postures from a file; False if there is none that can be trusted."""
        try:
            numbers = np.frombuffer(read_sealed(file))
        except (OSError, SealError, ValueError):
            return False
        if len(numbers) != self.scores.size + self.postures.size:
            return False
        self.scores[:] = numbers[: self.scores.size]
        self.postures[:] = numbers[self.scores.size :].reshape(self.postures.shape)
        return True


_KEPT: OrderedDict[bytes, SeedTable] = OrderedDict()


def seed_table(robot: Records) -> SeedTable:
    """The table of a robot, from memory or disk where it was made before: the folder's name tells the kernels that made it."""
    key = b"".join(_likeness(robot, limb) for limb in range(int(robot["n_limbs"][0])))
    if key not in _KEPT:
        folder = cache_folder()
        made = repr((CELLS, CELLS_ALIGNED, SAMPLES, SAMPLES_ALIGNED, SWEEPS)).encode()
        file = folder / f"seeds-{hashlib.sha256(made + key).hexdigest()[:32]}.bin"
        _KEPT[key] = SeedTable(robot, file if folder.is_dir() and cache_problem() is None else None)
    _KEPT.move_to_end(key)
    while len(_KEPT) > MOST_KEPT:
        _KEPT.popitem(last=False)
    return _KEPT[key]


def _likeness(robot: Records, limb: int) -> bytes:
    parts = [robot[name][0, limb] for name in _LIKENESS]
    return b"".join(
        np.asarray(part).tobytes() for part in (*parts, robot["offset"][0, limb, 1:], robot["rotation"][0, limb, 1:])
    )


def _at_its_mount(robot: Records, limb: int) -> Records:
    """The robot with the mount of one limb moved to the base frame."""
    moved = robot.copy()
    moved["offset"][0, limb, 0] = 0.0
    moved["rotation"][0, limb, 0] = np.eye(3).reshape(-1)
    return moved


def _bounds(robot: Records, limb: int) -> tuple[Floats, Floats]:
    """Corners of a box that holds all places of the tip, frame of the mount [m]: boxes of joints and links, added up from the tip."""
    n = int(robot["n_joints"][0, limb])
    reach = 0.0
    for k in range(n, 0, -1):
        reach += float(np.linalg.norm(robot["offset"][0, limb, k]))
    low, high = np.full(3, -reach), np.full(3, reach)
    for k in range(n):
        if robot["sliding"][0, limb, k]:
            out = max(abs(robot["lower"][0, limb, k]), abs(robot["upper"][0, limb, k]))
            low, high = low - out, high + out
    return low, high
