"""What a user sets of a law: gains by direction, feed-forwards, damping near singularities, force; checked, then packed for the kernels."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from numbers import Real
from typing import Any, Final

import numpy as np

from ..errors import StatedError, UnknownNameError, describe_choices
from ..extensions import outside
from ..types import Floats, Records
from .chain import Chain, rotation
from .drive import (
    ADMITTANCE,
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
from .friction import FROM_AIM, FROM_LAST, FROM_MEASURED, FROM_TORQUE
from .records import AXES, SETTINGS
from .torque_loop import AT_BASE, AT_WRIST, NOWHERE

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
FORCING: Final = frozenset({"hybrid", "implicit-force"})
"""Laws that take rows of force."""
FEELING: Final = frozenset({"admittance"})
"""Laws that do nothing of their own unless they feel a force; hybrid feels one where it has an integral of it."""
AXIS_NAMES: Final = ("x", "y", "z", "rx", "ry", "rz")
FRICTION_SOURCES: Final[dict[str, int]] = {
    "aim": FROM_AIM,
    "measured": FROM_MEASURED,
    "torque": FROM_TORQUE,
    "last": FROM_LAST,
}
TORQUE_SENSORS: Final[dict[str, int]] = {"none": NOWHERE, "base": AT_BASE, "wrist": AT_WRIST}
WORDS: Final[dict[str, tuple[str, ...]]] = {
    "axes": AXIS_NAMES,
    "forced": AXIS_NAMES,
    "weight": ("inertia", "damping", "back-emf", "none"),
    "friction_from": tuple(FRICTION_SOURCES),
    "torque_sensor": tuple(TORQUE_SENSORS),
}
"""Settings that are words -> the words that are allowed."""
SWITCHES: Final = ("feed_velocity", "feed_acceleration", "feed_gravity", "feed_bias", "feed_force", "scaled")
PER_AXIS: Final = ("kp", "kd", "mass", "admittance_kp", "admittance_kd")
"""Settings that may differ by row."""
OPTIONAL: Final = ("weight", "joint_kp", "joint_kd", "feed_bias")
SIGNED: Final = ("angle", "frame")
POSITIVE: Final = ("friction_speed", "environment")
PLAIN: Final = (
    *("feed_velocity", "feed_acceleration", "feed_gravity", "feed_friction", "friction_speed", "feed_force"),
    *("sigma", "scaled", "derivative", "derivative_time", "force_gain", "force_limit", "force_damping"),
    *("torque_gain", "torque_limit", "environment", "posture_kp", "posture_kd"),
)
"""Settings that the kernels read as they are."""


def law_names() -> tuple[str, ...]:
    """Names of the laws, ours and those of other packages."""
    return (*LAWS, *(name for name in outside("controllers") if name not in LAWS))


class LawError(StatedError):
    """A setting of a law that cannot be used: names law, key, value and what is allowed."""

    says = "{law}: {key} = {value}: {allowed}"
    law: str
    key: str
    value: object
    allowed: str


PerAxis = float | tuple[float, ...]
"""One number for every controlled row, or one each."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LawSettings:
    """A law with its settings. Gains of `kp`, `kd` are those of the law's own equation: see its page for units.

    For laws that go through the joints' motion (scct, resolved-rate, ...) kp is in N m/rad and kd in N m s/rad; for jacobian-transpose N/m
    and N s/m, in its rows of rotation N m/rad and N m s/rad; for operational-space 1/s^2 and 1/s.
    """

    law: str
    kp: PerAxis = 200.0
    kd: PerAxis = 10.0
    axes: tuple[str, ...] = ()
    """Rows of the twist that are controlled, in the task frame.

    None: x and y of a plane chain, all six of a chain of six joints or more, else x, y, z.
    """
    angle: float = 0.0
    """Turn of the task frame about its own z [rad]: gains are along its axes."""
    frame: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Rotation vector from the base frame to the task frame, before `angle` turns it [rad]; for limbs that leave the plane."""
    weight: str | None = None
    """"inertia", "damping", "back-emf": K' of that; "none": all joints alike; None: as the law is published."""
    joint_kp: float | None = None
    """Stiffness of the joint servo [N m/rad]; None: the mean of kp."""
    joint_kd: float | None = None
    """Damping of the joint servo [N m s/rad]; None: the mean of kd."""
    feed_velocity: bool = True
    """Whether the damping is towards the aim's speed, else towards rest as in Bevly's Eq. 3.16."""
    feed_acceleration: bool = False
    """Whether the aim's acceleration is fed forward: through the model in operational-space, elsewhere times the motors' inertia."""
    feed_gravity: bool = True
    feed_bias: bool | None = None
    """Coriolis and centrifugal torques, and Jdot qd in operational-space; None: only there."""
    feed_friction: float = 0.0
    """Part of the modelled friction that is fed forward [-]."""
    friction_from: str = "aim"
    """Whose direction the friction has: that of the "aim", the "measured" speed, or the law's "torque"; "last": the aim's,
    and at rest that of the joint's last motion."""
    friction_speed: float = 0.02
    """Joint speed below which the Coulomb friction fed forward fades out [rad/s]."""
    feed_force: bool = True
    """Whether the aim's wrench is fed forward by J^T; rows of force have it from their own law."""
    sigma: float = 0.01
    """Smallest singular value of the task Jacobian that needs no damping [m/rad], of rows of rotation [-]; 0: never damped."""
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
    """Most this integral adds [N]."""
    force_damping: float = 50.0
    """Damping along rows of force [N s/m]."""
    torque_sensor: str = "none"
    """Where the torque loop that rejects joint friction senses: "base", "wrist", or "none" for no such loop."""
    torque_gain: float = 20.0
    """Bandwidth of that loop [1/s]."""
    torque_limit: float = 3.0
    """Most that this loop adds at a joint [N m]."""
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
        if self.law not in law_names():
            raise UnknownNameError("controller", str(self.law), law_names())
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, list):  # as files and command lines have it
                value = tuple(value)
                object.__setattr__(self, field.name, value)
            if field.name in SWITCHES:
                self._check_switch(field.name, value)
            elif field.name not in ("law", *WORDS):
                self._check_numbers(field.name, value)
        for key, allowed in WORDS.items():
            self._check_words(key, getattr(self, key), allowed)
        if self.forced and self.law not in FORCING:
            raise LawError(
                self.law, "forced", ", ".join(self.forced), f"only {' and '.join(sorted(FORCING))} take rows of force"
            )

    def _check_switch(self, key: str, value: object) -> None:
        if not isinstance(value, bool) and not (value is None and key in OPTIONAL):
            raise LawError(self.law, key, value, "must be true or false")

    def _check_numbers(self, key: str, value: object) -> None:
        if value is None and key in OPTIONAL:
            return
        if isinstance(value, tuple) and key not in (*PER_AXIS, "frame"):
            raise LawError(self.law, key, value, "must be one number")
        for number in value if isinstance(value, tuple) else (value,):
            if isinstance(number, bool) or not isinstance(number, Real):
                raise LawError(self.law, key, value, "must be a number")
            if not math.isfinite(number):
                raise LawError(self.law, key, value, "must be a finite number")
            if key not in SIGNED and number < 0.0:
                raise LawError(self.law, key, value, "must be 0 or more")
            if key in POSITIVE and number == 0.0:
                raise LawError(self.law, key, value, "must be more than 0")
        if key == "frame" and (not isinstance(value, tuple) or len(value) != 3):
            raise LawError(self.law, key, value, "must be three numbers: a rotation vector")

    def _check_words(self, key: str, value: object, allowed: tuple[str, ...]) -> None:
        if value is None and key in OPTIONAL:
            return
        several = key in ("axes", "forced")
        words = value if several and isinstance(value, tuple) else (value,)
        for word in words:
            if word not in allowed:
                raise LawError(self.law, key, word, f"must be {describe_choices(str(word), allowed)}")
        if several and not isinstance(value, tuple):
            raise LawError(self.law, key, value, f'must be a list of axes, such as ("{value}",)')
        if len(set(words)) < len(words):
            raise LawError(self.law, key, ", ".join(map(str, words)), "must name each axis once")

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
        most = 2 if chain.plane else 3 if chain.n < AXES else AXES
        names = self.axes or AXIS_NAMES[: min(chain.n, most)]
        return tuple(AXIS_NAMES.index(name) for name in names)

    def sensors(self) -> frozenset[str]:
        """Where the law reads a force sensor: "wrist", "base", both or neither; a torque loop's sensor serves the law too."""
        if self.torque_sensor != "none":
            return frozenset({self.torque_sensor})
        feels = self.law in FEELING or (self.law == "hybrid" and self.force_gain > 0.0)
        return frozenset({"wrist"}) if feels else frozenset()

    def weighs_joints(self) -> bool:
        """Whether the law weighs its joints by K'; else all count alike."""
        return self.law in WEIGHTED if self.weight is None else self.weight != "none"

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
        if self.law not in LAWS:
            allowed = "is another package's, in Python: what needs compiled laws (tuning, bodies) can't take it"
            raise LawError("controller", "law", self.law, allowed)
        rows = self.rows_of(chain)
        if len(rows) > chain.n:
            raise LawError(
                self.law, "axes", ", ".join(AXIS_NAMES[r] for r in rows), f"{chain.name} has {chain.n} joints only"
            )
        if not 0.0 < period < math.inf:
            raise LawError(self.law, "period", period, "must be more than 0 s, and finite")
        self._check_inertia(chain)
        out = np.zeros(1, SETTINGS)
        record = out[0]
        record["law"], record["n_rows"], record["period"] = LAWS[self.law], len(rows), period
        record["rows"][: len(rows)] = rows
        record["frame"] = self.task_frame()
        for key in PER_AXIS:
            record[key][: len(rows)] = self._per_axis(key, len(rows))
        for key, default in (("joint_kp", "kp"), ("joint_kd", "kd")):
            given = getattr(self, key)
            record[key] = float(np.mean(self._per_axis(default, len(rows)))) if given is None else given
        self._check_servo(record, len(rows))
        for name in self.forced:
            if AXIS_NAMES.index(name) not in rows:
                raise LawError(self.law, "forced", name, "must be one of the controlled axes")
            record["forced"][rows.index(AXIS_NAMES.index(name))] = 1
        record["weighted"] = self.weighs_joints()
        bias = self.law == "operational-space" if self.feed_bias is None else self.feed_bias
        record["feed_bias"] = bias
        record["friction_from"] = FRICTION_SOURCES[self.friction_from]
        record["torque_sensor"] = TORQUE_SENSORS[self.torque_sensor]
        record["lambda2"] = self.damping**2
        for key in PLAIN:
            record[key] = getattr(self, key)
        return out

    def task_frame(self) -> Floats:
        """The task frame in the base frame: its columns are the task's axes, shape (3, 3)."""
        return rotation(self.frame) @ rotation((0.0, 0.0, self.angle))

    def _check_inertia(self, chain: Chain) -> None:
        if self.law != "operational-space":
            return
        least = float(np.linalg.eigvalsh(chain.inertia(chain.joints["rest"])).min())
        if not least > 0.0:
            raise LawError(
                self.law, "inertia", least, f"{chain.name} must have an inertia about every joint: it divides by it"
            )

    def _check_servo(self, record: Any, count: int) -> None:
        """What a law divides by."""
        if self.law in ("resolved-rate", "admittance") and not record["joint_kd"] > 0.0:
            raise LawError(
                self.law, "joint_kd", float(record["joint_kd"]), "must be more than 0: it is what the law pulls by"
            )
        if self.law == "admittance" and not (record["mass"] + record["admittance_kd"])[:count].min() > 0.0:
            raise LawError(
                self.law,
                "admittance_kd",
                self.admittance_kd,
                "must be more than 0 where the mass is 0: force over it is a speed",
            )

    def _per_axis(self, key: str, count: int) -> Sequence[float]:
        value = getattr(self, key)
        if isinstance(value, tuple):
            if len(value) != count:
                raise LawError(self.law, key, value, f"must be one number, or {count}: one for each controlled axis")
            return value
        return (float(value),) * count
