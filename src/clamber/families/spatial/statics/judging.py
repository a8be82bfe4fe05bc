"""Stances of a robot in space judged from Python: records in, records out."""

import math
from collections.abc import Sequence
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from ....types import Floats, Records
from ..robot.chains import Chains
from ..robot.contacts import Contact
from .checks import STANCE_CHECKS
from .records import BODY, CONTACT, JUDGED, RULES, WORK, robot_record
from .seeds import SeedTable, seed_table
from .stance_kernels import judge_each, lift_over

Reasons: TypeAlias = npt.NDArray[np.int64]
"""Numbers of checks (`STANCE_CHECKS`), -1 for none."""
REACHED: Final = 1e-4
"""Distance of tip and hold that counts as reached, per size of the robot."""


def rules_record(**rules: float) -> Records:
    """Rules of judging: those that are named, else every check hard, every margin exact, no limit to jumps, no need and no room.

    Args:
        **rules: Fields of `RULES` by name.
    """
    record = np.zeros(1, RULES)
    row = record[0]
    row["reach"] = REACHED
    row["jump"] = row["jump_moved"] = math.inf
    row["hard"], row["exact"] = (1 << len(STANCE_CHECKS)) - 1, 1
    for name, value in rules.items():
        row[name] = value
    return record


def lift_between(ends: Floats, normals: Floats, lift: float) -> Floats:
    """How far a tip's path is lifted off the straight line at its highest [m], shape (3,).

    Args:
        ends: Places of both holds [m], shape (2, 3).
        normals: Theirs, out of the surfaces, shape (2, 3).
        lift: Height over a plane [m].
    """
    up = np.empty(3)
    lift_over(ends[0], ends[1], normals[0], normals[1], lift, up)
    return up


class Statics:
    """A robot with its contacts and seeds, ready to judge stances."""

    def __init__(self, chains: Chains, contacts: Sequence[Contact]) -> None:
        """Make the robot's record and its table of seeds, or take the latter from memory."""
        self.robot: Records = robot_record(chains, contacts)
        self.table: SeedTable = seed_table(self.robot)
        self.n_limbs: int = len(contacts)

    def bodies(self, n: int, gravity: Sequence[float] = (0.0, 0.0, -9.80665)) -> Records:
        """Records of `BODY` at the world's origin, shape (n,); gravity in the world frame [m/s^2]."""
        made = np.zeros(n, BODY)
        made["rotation"], made["gravity"] = np.eye(3).reshape(-1), gravity
        return made

    def contacts(self, places: Floats, normals: Floats) -> Records:
        """Records of `CONTACT` that bear, shape (n, limbs), of places [m] and normals, both of shape (n, limbs, 3), world frame."""
        made = np.zeros(np.shape(places)[:-1], CONTACT)
        made["place"], made["normal"] = places, normals
        made["strength"] = made["friction"] = math.inf
        made["bears"] = 1
        return made

    def judge(self, bodies: Records, contacts: Records, rules: Records | None = None) -> tuple[Records, Reasons]:
        """Records of `JUDGED` and the first violated hard check of each stance, -1 if none, both of shape (n,).

        Args:
            bodies: Records of `BODY`, shape (n,).
            contacts: Records of `CONTACT`, shape (n, limbs).
            rules: Of `rules_record`; None: its defaults.
        """
        assert contacts.shape == (len(bodies), self.n_limbs)
        out = np.zeros(len(bodies), JUDGED)
        reasons = np.zeros(len(bodies), np.int64)
        rules = rules_record() if rules is None else rules
        before, work = np.zeros(1, JUDGED), np.zeros(1, WORK)
        judge_each(self.robot[0], self.table.records[0], (bodies, contacts, out, reasons), before[0], rules[0], work[0])
        return out, reasons
