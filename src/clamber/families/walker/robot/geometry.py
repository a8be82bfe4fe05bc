"""How the two frames lie to each other: the checked face of the mechanism's kinematics."""

import math
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from ....errors import ClamberError
from ....types import Floats
from .assemblies import assemblies
from .mechanism import Mechanism
from .two_frames import FOUND, actuator_lengths, follow_branch, length_jacobian, singular_measure

NO_LENGTH: Final = 1e-12
"""An actuator as short has no direction [m]."""
Status: TypeAlias = Literal["found", "singular"]


class PoseError(ClamberError):
    """A relative pose, or lengths of actuators, that the mechanism's formulas do not hold for."""

    def __init__(self, what: str, value: tuple[float, ...], allowed: str) -> None:
        super().__init__(what, value, allowed)
        self.what, self.value, self.allowed = what, value, allowed

    def __str__(self) -> str:
        return f"{self.what} ({', '.join(f'{one:.6g}' for one in self.value)}): {self.allowed}"


@dataclass(frozen=True, slots=True)
class Followed:
    """Where lengths of the actuators lead from a pose, on its own assembly branch."""

    status: Status
    """found, or singular: the way of lengths meets a singular pose before its end."""
    pose: Floats
    """x, y [m] and theta [rad] of the Y-frame in the Delta-frame, shape (3,); where it stops, if singular."""
    error: float
    """Largest difference of a length from what was asked [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class TwoFrames:
    """The planar 3-RPR mechanism of a walker. A pose is that of the Y-frame in the Delta-frame: x, y [m], theta [rad], shape (3,)."""

    delta: Floats
    """Attachments of the Delta-frame in its own frame [m], shape (3, 2)."""
    y: Floats
    """Attachments of the Y-frame in its own frame [m], shape (3, 2)."""
    shortest: float
    """Length of an actuator that is drawn in [m]."""
    longest: float
    """Length of an extended actuator [m]."""
    guard: float
    """Largest `nearness` of a pose that is used [-]."""

    @classmethod
    def of(cls, mechanism: Mechanism) -> "TwoFrames":
        """The mechanism that a robot file states."""
        delta, y = mechanism.attachments()
        return cls(delta.copy(), y.copy(), mechanism.shortest, mechanism.longest, mechanism.guard)

    def lengths(self, pose: npt.ArrayLike) -> Floats:
        """Lengths of the actuators [m], shape (3,): the inverse kinematics, which has one answer."""
        x, y, theta = _pose(pose)
        out = np.empty(3)
        actuator_lengths(self.delta, self.y, x, y, theta, out)
        return out

    def room(self, pose: npt.ArrayLike) -> float:
        """How far the actuators' lengths lie inside their range, the least of them [m]; negative outside."""
        lengths = self.lengths(pose)
        return float(min(lengths.min() - self.shortest, self.longest - lengths.max()))

    def jacobian(self, pose: npt.ArrayLike) -> Floats:
        """Derivatives of the lengths by x, y, theta, shape (3, 3) [-], [-], [m].

        Raises:
            PoseError: If a length is zero, where it has no derivative.
        """
        x, y, theta = _pose(pose)
        if self.lengths((x, y, theta)).min() <= NO_LENGTH:
            raise PoseError(
                "pose", (x, y, theta), "an actuator has no length there, so it has no direction; move off it"
            )
        lengths, jacobian = np.empty(3), np.empty((3, 3))
        length_jacobian(self.delta, self.y, x, y, theta, lengths, jacobian)
        return jacobian

    def singular_measure(self, pose: npt.ArrayLike) -> float:
        """Determinant of the Jacobian times the three lengths [m^4]; zero where singular, its sign tells the kinds of assembly apart."""
        x, y, theta = _pose(pose)
        return float(singular_measure(self.delta, self.y, x, y, theta))

    def nearness(self, pose: npt.ArrayLike) -> float:
        """How near a pose is to a singular one: 0 with the origins on each other, 1 where it is singular, more beyond [-].

        It is sqrt(1 - D / D_0), with D the singular measure and D_0 that of the same theta with the origins on each other. D is quadratic
        in x and y; where attachments are on circles about the origins, this is |p| / rho. 0 also where D / D_0 is above 1, and infinite
        where D_0 is 0.
        """
        x, y, theta = _pose(pose)
        centre = float(singular_measure(self.delta, self.y, 0.0, 0.0, theta))
        if centre == 0.0:
            return math.inf
        return math.sqrt(max(0.0, 1.0 - float(singular_measure(self.delta, self.y, x, y, theta)) / centre))

    def assemblies(self, lengths: npt.ArrayLike) -> Floats:
        """Every real pose with these lengths, by theta in (-pi, pi], shape (n, 3): at most 6, at most 4 for similar triangles."""
        return assemblies(self.delta, self.y, _lengths(lengths))

    def follow(self, lengths: npt.ArrayLike, start: npt.ArrayLike) -> Followed:
        """The pose with these lengths on the branch of `start`: where the mechanism goes when its lengths change evenly from there.

        It goes in pieces on which the solution is provably unique, so it never jumps to another branch.
        """
        aim, pose = _lengths(lengths), np.array(_pose(start))
        ended = follow_branch(self.delta, self.y, aim, pose, np.empty((9, 3)))
        error = float(abs(self.lengths(pose) - aim).max())
        return Followed("found" if ended == FOUND else "singular", pose, error)


def _pose(pose: npt.ArrayLike) -> tuple[float, float, float]:
    given = np.asarray(pose, np.float64)
    if given.shape != (3,) or not np.isfinite(given).all():
        raise PoseError("pose", tuple(given.ravel()), "must be three finite numbers: x, y [m] and theta [rad]")
    return float(given[0]), float(given[1]), float(given[2])


def _lengths(lengths: npt.ArrayLike) -> Floats:
    given = np.array(lengths, np.float64)
    if given.shape != (3,) or not np.isfinite(given).all() or given.min() <= 0.0:
        raise PoseError("lengths", tuple(given.ravel()), "must be three finite lengths of more than 0 m")
    return given
