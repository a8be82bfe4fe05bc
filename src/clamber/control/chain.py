"""A serial chain as laws and plants read it: any number of joints from base to tip, with their motors, planar or spatial."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, Literal, TypeAlias

import numpy as np

from ..errors import StatedError
from ..types import Floats, Records
from .kinematics import FRAME, accelerate, fill_inertia, fill_jacobian, place_chain, place_tips
from .records import AXES, JOINT, ROOT

ShareBasis: TypeAlias = Literal["inertia", "damping", "back-emf"]
"""What K' is made of (Bevly 1997, 3.3.2)."""
SMALLEST_SHARE: Final = 1e-6
"""A joint may not count for less than this of the largest."""
TURN: Final = "must be a rotation: orthonormal and right-handed"
EVEN: Final = 1e-8
"""Rounding that a rotation, or the symmetry of an inertia over its largest number, may be off by [-]."""


class ChainError(StatedError):
    """A chain that cannot be: names the joint, the field, the value and what is allowed."""

    says = "{chain}: {key} = {value}: {allowed}"
    chain: str
    key: str
    value: object
    allowed: str


@dataclass(frozen=True, slots=True, eq=False)
class Chain:
    """A serial chain: `joints`, records of `JOINT`, shape (n,), and `root`, one record of `ROOT`.

    The arrays are this chain's own; nobody else writes them.
    """

    name: str
    joint_names: tuple[str, ...]
    joints: Records
    root: Records
    plane: bool = False
    """Whether the tip stays in a plane across z, so that the task is x and y."""

    def __post_init__(self) -> None:
        if not self.joints.size or len(self.joint_names) != self.joints.size:
            raise ChainError(
                self.name, "joint_names", len(self.joint_names), f"must be one or more, {self.joints.size}"
            )
        for key in ("place", "turn", "axis", "centre", "inertia", "lower", "upper", "rest"):
            self._check_joints(key, np.isfinite(self.joints[key]), "must be finite numbers")
        for key in ("mass", "rotor", "damping", "friction", "back_emf"):
            values = self.joints[key]
            self._check_joints(key, (values >= 0.0) & (values < np.inf), "must be 0 or more, and finite")
        for key in ("limit", "speed", "share"):
            self._check_joints(key, self.joints[key] > 0.0, "must be more than 0")
        unit = np.abs(np.linalg.norm(self.joints["axis"], axis=1) - 1.0) < 1e-9
        self._check_joints("axis", unit, "must be a unit vector")
        crossed = int(np.argmax(self.joints["lower"] > self.joints["upper"]))
        most = f"must be at most upper, {self.joints['upper'][crossed]:g}"
        self._check_joints("lower", self.joints["lower"] <= self.joints["upper"], most)
        self._check_joints("turn", _is_turn(self.joints["turn"]), TURN)
        inertia = self.joints["inertia"]
        largest = np.abs(inertia).max(axis=(1, 2))
        even = np.abs(inertia - inertia.transpose(0, 2, 1)).max(axis=(1, 2)) <= EVEN * largest
        body = even & (np.linalg.eigvalsh(inertia).min(axis=1) >= -1e-9 * largest)
        self._check_joints("inertia", body, "must be symmetric, without negative eigenvalue")
        for key in ("tip", "tip_turn", "gravity"):
            if not np.isfinite(self.root[key]).all():
                raise ChainError(self.name, key, self.root[key][0].tolist(), "must be finite numbers")
        if not _is_turn(self.root["tip_turn"])[0]:
            raise ChainError(self.name, "tip_turn", self.root["tip_turn"][0].tolist(), TURN)

    def _check_joints(self, key: str, fine: Any, allowed: str) -> None:
        """Complain of the first joint, a row, of which a field is not all fine."""
        if not fine.all():
            joint = int(np.argmin(fine.reshape(self.n, -1).all(axis=1)))
            value = self.joints[key][joint].tolist()
            raise ChainError(self.name, f"{self.joint_names[joint]}.{key}", value, allowed)

    @property
    def n(self) -> int:
        """Number of joints."""
        return int(self.joints.size)

    @property
    def largest_inertia(self) -> float:
        """Largest reflected inertia of a motor and gear [kg m^2]: what K' is normalised by."""
        return float(self.joints["rotor"].max())

    def with_gravity(self, acceleration: Sequence[float]) -> "Chain":
        """This chain under another gravity, an acceleration in the base frame [m/s^2]."""
        root = self.root.copy()
        root["gravity"][0] = acceleration
        return replace(self, root=root)

    def with_payload(self, mass: float) -> "Chain":
        """This chain with a point mass at its tip [kg], carried by the last link."""
        if not mass >= 0.0:
            raise ChainError(self.name, "payload", mass, "must be 0 kg or more")
        joints = self.joints.copy()
        last = joints[-1:]
        before, at = float(last["mass"][0]), self.root["tip"][0]
        total = before + mass
        if total > 0.0:
            old = last["centre"][0].copy()
            new = (before * old + mass * at) / total
            inertia = last["inertia"][0].copy()
            for part, place in ((before, old), (mass, at)):
                arm = place - new
                inertia += part * (arm @ arm * np.eye(3) - np.outer(arm, arm))
            last["mass"], last["centre"], last["inertia"] = total, new, inertia
        return replace(self, joints=joints)

    def with_shares(self, basis: ShareBasis) -> "Chain":
        """This chain with K' made of its joints' inertia, damping, or back-EMF.

        Back-EMF: the torque at the joint that a motor on a voltage amplifier loses with speed, N^2 k_t^2 / R [N m s/rad].

        Raises:
            ChainError: If a joint's value is 0, so that K' would have no inverse.
        """
        values = {
            "inertia": self.joints["rotor"],
            "damping": self.joints["damping"],
            "back-emf": self.joints["back_emf"],
        }[basis]
        largest = float(values.max())
        for name, value in zip(self.joint_names, values, strict=True):
            if not value > SMALLEST_SHARE * largest:
                raise ChainError(self.name, f"{name}'s share by {basis}", float(value), "must be more than 0 for K'")
        joints = self.joints.copy()
        joints["share"] = values / largest
        return replace(self, joints=joints)

    # What follows serves set-up, tests and plots; a law works the same things out by the same kernels.

    def place(self, q: Sequence[float] | Floats) -> Floats:
        """Tip in the base frame at the joint angles `q` [m], shape (3,)."""
        return self._placed(q)[1][:3].copy()

    def places(self, q: Floats) -> Floats:
        """Tips in the base frame at many rows of joint angles, shape (m, n) [m], shape (m, 3)."""
        out = np.empty((len(q), 3))
        angles = np.ascontiguousarray(q, dtype=np.float64)
        place_tips(self.joints, self.root, angles, np.zeros((self.n, FRAME)), np.zeros(12), out)
        return out

    def jacobian(self, q: Sequence[float] | Floats) -> Floats:
        """Jacobian of the tip's twist, base frame, shape (6, n)."""
        frames, tip = self._placed(q)
        out = np.zeros((AXES, self.n))
        fill_jacobian(self.joints, frames, tip, out)
        return out

    def inertia(self, q: Sequence[float] | Floats) -> Floats:
        """Inertia matrix, motors and gears included, shape (n, n) [kg m^2]."""
        frames, _ = self._placed(q)
        out = np.zeros((self.n, self.n))
        fill_inertia(self.joints, frames, out)
        return out

    def bias(self, q: Sequence[float] | Floats, qd: Sequence[float] | Floats) -> Floats:
        """Torques h + g that hold the joints' speeds against Coriolis, centrifugal and weight, shape (n,) [N m]."""
        return self._accelerated(q, qd)[0]

    def drift(self, q: Sequence[float] | Floats, qd: Sequence[float] | Floats) -> Floats:
        """Jdot qd: the tip's acceleration at steady joint speeds, base frame, shape (6,)."""
        return self._accelerated(q, qd)[1]

    def _placed(self, q: Sequence[float] | Floats) -> tuple[Floats, Floats]:
        frames, tip = np.zeros((self.n, FRAME)), np.zeros(12)
        place_chain(self.joints, self.root, np.ascontiguousarray(q, dtype=np.float64), frames, tip)
        return frames, tip

    def _accelerated(self, q: Sequence[float] | Floats, qd: Sequence[float] | Floats) -> tuple[Floats, Floats]:
        frames, tip = self._placed(q)
        torques, drift = np.zeros(self.n), np.zeros(AXES)
        speeds = np.ascontiguousarray(qd, dtype=np.float64)
        accelerate(self.joints, self.root, frames, tip, (speeds, np.zeros(self.n)), True, drift, torques)
        return torques, drift


def empty_chain(n: int) -> tuple[Records, Records]:
    """Records of `n` joints and of a root, massless, turning about z, unlimited: to be filled in."""
    joints, root = np.zeros(n, JOINT), np.zeros(1, ROOT)
    joints["turn"] = np.eye(3)
    joints["axis"] = (0.0, 0.0, 1.0)
    joints["share"], joints["limit"], joints["speed"] = 1.0, np.inf, np.inf
    joints["lower"], joints["upper"] = -np.pi, np.pi
    root["tip_turn"] = np.eye(3)
    return joints, root


def rotation(vector: Sequence[float] | Floats) -> Floats:
    """Matrix of a rotation vector [rad], shape (3, 3) (Rodrigues)."""
    x, y, z = vector
    angle = float(np.sqrt(x * x + y * y + z * z))
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    half = np.sinc(angle / (2 * np.pi))  # sin(angle / 2) / (angle / 2)
    out: Floats = np.eye(3) + np.sinc(angle / np.pi) * cross + 0.5 * half**2 * cross @ cross
    return out


def _is_turn(turns: Floats) -> Any:
    """Whether each matrix is orthonormal and right-handed, shape (n,)."""
    off = np.abs(turns @ turns.transpose(0, 2, 1) - np.eye(3)).max(axis=(1, 2))
    return (off <= EVEN) & (np.linalg.det(turns) > 0.0)


def _wrapped(angle: float) -> float:
    return angle - 2 * math.pi * math.ceil((angle - math.pi) / (2 * math.pi))
