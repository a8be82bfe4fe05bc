"""What a user sets of a law: gains by direction, feed-forwards, damping near singularities, force; checked, then packed for the kernels."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Final

import numpy as np

from ..errors import ClamberError, UnknownNameError, describe_choices
from ..types import Records
from .chain import Chain
from .drive import (
    ADMITTANCE,
    FROM_AIM,
    FROM_MEASURED,
    FROM_TORQUE,
    HYBRID,
    IMPLICIT_ADMITTANCE,
    IMPLICIT_FORCE,
    JACOBIAN_TRANSPOSE,
    JOINT_PD,
    OPERATIONAL_SPACE,
    RESOLVED_RATE,
    RESOLVED_RATE_PLAIN,
    SCCT,
)
from .records import AXES, SETTINGS

LAWS: Final[dict[str, int]] = {
    "jacobian-transpose": JACOBIAN_TRANSPOSE,
    "operational-space": OPERATIONAL_SPACE,
    "resolved-rate": RESOLVED_RATE,
    "resolved-rate-plain": RESOLVED_RATE_PLAIN,
    "admittance": ADMITTANCE,
    "joint-pd": JOINT_PD,
    "scct": SCCT,
    "implicit-admittance": IMPLICIT_ADMITTANCE,
    "hybrid": HYBRID,
    "implicit-force": IMPLICIT_FORCE,
}
"""Name -> number in `drive`; the command line, the bench and the tests read it."""
WEIGHTED: Final = frozenset({"scct", "implicit-admittance", "hybrid", "implicit-force", "admittance"})
"""Laws that weigh their joints by K' unless told otherwise."""
FRICTION_SOURCES: Final[dict[str, int]] = {"aim": FROM_AIM, "measured": FROM_MEASURED, "torque": FROM_TORQUE}
PLAIN: Final = (
    *("feed_velocity", "feed_acceleration", "feed_gravity", "feed_friction", "friction_speed", "feed_force"),
    *("sigma", "scaled", "derivative", "derivative_time", "force_gain", "force_limit", "force_damping"),
    *("environment", "posture_kp", "posture_kd"),
)
"""Settings that the kernels read as they are."""
AXIS_NAMES: Final = ("x", "y", "z", "rx", "ry", "rz")


class LawError(ClamberError):
    """A setting of a law that cannot be used: names law, key, value and what is allowed."""

    def __init__(self, law: str, key: str, value: object, allowed: str) -> None:
        super().__init__(law, key, value, allowed)
        self.law, self.key, self.value, self.allowed = law, key, value, allowed

    def __str__(self) -> str:
        return f"{self.law}: {self.key} = {self.value}: {self.allowed}"


PerAxis = float | tuple[float, ...]
"""One number for every controlled row, or one each."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LawSettings:
    """A law with its settings. Gains of `kp`, `kd` are those of the law's own equation: see its page for units.

    For laws that go through the joints' motion (scct, resolved-rate, ...) kp is in N m/rad and kd in N m s/rad; for jacobian-transpose N/m
    and N s/m; for operational-space 1/s^2 and 1/s.
    """

    law: str
    kp: PerAxis = 200.0
    kd: PerAxis = 10.0
    axes: tuple[str, ...] = ()
    """Rows of the twist that are controlled, in the task frame; none: x and y of a plane chain, else all that the joints allow."""
    angle: float = 0.0
    """Turn of the task frame about z of the base frame [rad]: gains are along its axes."""
    weight: str | None = None
    """"inertia", "damping", "back-emf": K' of that; "none": all joints alike; None: as the law is published."""
    joint_kp: float | None = None
    """Stiffness of the joint servo [N m/rad]; None: the mean of kp."""
    joint_kd: float | None = None
    """Damping of the joint servo [N m s/rad]; None: the mean of kd."""
    feed_velocity: bool = True
    feed_acceleration: bool = False
    feed_gravity: bool = True
    feed_bias: bool | None = None
    """Coriolis and centrifugal torques; None: only in operational-space."""
    feed_friction: float = 0.0
    """Part of the modelled friction that is fed forward [-]."""
    friction_from: str = "aim"
    """Whose direction the friction has: that of the "aim", the "measured" speed, or the law's "torque"."""
    friction_speed: float = 0.02
    """Joint speed below which the Coulomb friction fed forward fades out [rad/s]."""
    feed_force: bool = True
    sigma: float = 0.01
    """Smallest singular value of the Jacobian that needs no damping [m/rad]."""
    damping: float = 0.02
    """Damping lambda at a singular pose [m/rad]."""
    scaled: bool = False
    """At a limit: whether all torques shrink together, which keeps their direction, or each is cut off."""
    derivative: float = 0.02
    """K'_d of implicit-admittance over K'_p [s]."""
    derivative_time: float = 0.02
    """Time constant of the filter of that derivative [s]."""
    forced: tuple[str, ...] = ()
    """Rows that carry a force (hybrid, implicit-force)."""
    force_gain: float = 0.0
    """Integral gain of a sensed force [1/s]; 0: open loop."""
    force_limit: float = 20.0
    """Most that this integral adds [N]."""
    force_damping: float = 50.0
    """Damping along rows of force [N s/m]."""
    environment: float = 10_000.0
    """Stiffness that implicit-force believes the surface to have [N/m]."""
    mass: PerAxis = 1.0
    """Of the admittance [kg]."""
    admittance_kp: PerAxis = 0.0
    """Of the admittance [N/m]."""
    admittance_kd: PerAxis = 200.0
    """Of the admittance [N s/m]."""
    posture_kp: float = 5.0
    """Pull of a redundant limb to its rest posture [N m/rad]."""
    posture_kd: float = 1.0
    """Damping of what a redundant limb does beside its task [N m s/rad]."""

    def __post_init__(self) -> None:
        if self.law not in LAWS:
            raise UnknownNameError("controller", self.law, tuple(LAWS))
        for field in fields(self):
            value = getattr(self, field.name)
            numbers = value if isinstance(value, tuple) else (value,)
            for number in numbers:
                if isinstance(number, (int, float)) and not isinstance(number, bool):
                    self._check_number(field.name, float(number))
        if self.weight not in (None, "none", "inertia", "damping", "back-emf"):
            raise LawError(self.law, "weight", self.weight, "must be inertia, damping, back-emf or none")
        if self.friction_from not in FRICTION_SOURCES:
            raise LawError(self.law, "friction_from", self.friction_from, f"must be {', '.join(FRICTION_SOURCES)}")
        for key in ("axes", "forced"):
            for name in getattr(self, key):
                if name not in AXIS_NAMES:
                    raise LawError(self.law, key, name, f"must be of {describe_choices(name, AXIS_NAMES)}")

    def _check_number(self, key: str, value: float) -> None:
        if not math.isfinite(value):
            raise LawError(self.law, key, value, "must be a finite number")
        if key != "angle" and value < 0.0:
            raise LawError(self.law, key, value, "must be 0 or more")
        if key in ("friction_speed", "environment") and value == 0.0:
            raise LawError(self.law, key, value, "must be more than 0")

    def with_changes(self, **changes: Any) -> "LawSettings":
        """A copy with some settings changed.

        Raises:
            LawError: If there is no such setting, or its value is not allowed.
        """
        known = tuple(field.name for field in fields(self))
        for key in changes:
            if key not in known:
                raise LawError(
                    self.law, key, changes[key], f"no such setting; there are {describe_choices(key, known)}"
                )
        return replace(self, **changes)

    def rows_of(self, chain: Chain) -> tuple[int, ...]:
        """Indices of the controlled rows of the twist."""
        names = self.axes or (("x", "y")[: chain.n] if chain.plane else AXIS_NAMES[: min(chain.n, AXES)])
        return tuple(AXIS_NAMES.index(name) for name in names)

    def weigh(self, chain: Chain) -> Chain:
        """The chain with K' as this law weighs its joints."""
        return chain if self.weight in (None, "none") else chain.with_shares(self.weight)  # type: ignore[arg-type]

    def record(self, chain: Chain, period: float) -> Records:
        """One record of `SETTINGS` for this chain, shape (1,).

        Args:
            chain: What is to be controlled.
            period: Between two ticks [s].

        Raises:
            LawError: If the settings do not fit the chain.
        """
        rows = self.rows_of(chain)
        if len(rows) > chain.n:
            raise LawError(
                self.law, "axes", ", ".join(AXIS_NAMES[r] for r in rows), f"{chain.name} has {chain.n} joints only"
            )
        if not period > 0.0:
            raise LawError(self.law, "period", period, "must be more than 0 s")
        out = np.zeros(1, SETTINGS)
        record = out[0]
        record["law"], record["n_rows"], record["period"] = LAWS[self.law], len(rows), period
        record["rows"][: len(rows)] = rows
        c, s = math.cos(self.angle), math.sin(self.angle)
        record["frame"] = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]
        for key in ("kp", "kd", "mass", "admittance_kp", "admittance_kd"):
            record[key][: len(rows)] = self._per_axis(key, len(rows))
        record["joint_kp"] = float(np.mean(self._per_axis("kp", len(rows)))) if self.joint_kp is None else self.joint_kp
        record["joint_kd"] = float(np.mean(self._per_axis("kd", len(rows)))) if self.joint_kd is None else self.joint_kd
        if self.law in ("resolved-rate", "admittance") and not record["joint_kd"] > 0.0:
            raise LawError(
                self.law, "joint_kd", float(record["joint_kd"]), "must be more than 0: it is what the law pulls by"
            )
        for name in self.forced:
            if AXIS_NAMES.index(name) not in rows:
                raise LawError(self.law, "forced", name, "must be one of the controlled axes")
            record["forced"][rows.index(AXIS_NAMES.index(name))] = 1
        weighted = self.law in WEIGHTED if self.weight is None else self.weight != "none"
        record["weighted"] = weighted
        bias = self.law == "operational-space" if self.feed_bias is None else self.feed_bias
        record["feed_bias"] = bias
        record["friction_from"] = FRICTION_SOURCES[self.friction_from]
        record["lambda2"] = self.damping**2
        for key in PLAIN:
            record[key] = getattr(self, key)
        return out

    def _per_axis(self, key: str, count: int) -> Sequence[float]:
        value = getattr(self, key)
        if isinstance(value, tuple):
            if len(value) != count:
                raise LawError(self.law, key, value, f"must be one number, or {count}: one for each controlled axis")
            return value
        return (float(value),) * count
