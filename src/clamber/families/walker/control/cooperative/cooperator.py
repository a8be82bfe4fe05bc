"""The law of cooperative motion around its kernels: checks what comes in, solves the programme, looks one step ahead."""

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from .....types import Floats
from ...robot import WalkerRobot
from .limits import Kept, chain_of, limit_names
from .one_step import finish, move_freely, prepare, see
from .planted_feet import BALANCE, N_ROWS, ROW_UNITS, LimitError, PlantedFeet
from .programme import Law, calm, let_rest, make_programme
from .scratch import make_scratch, see_bounds, see_tool
from .settings import Cooperation, CooperationError, stretch, swerve
from .tool_chain import POSE

SOLVED: Final = 1
"""DAQP's word for an optimum."""
CONTRADICTED: Final = -1
"""DAQP's word for rows that contradict each other."""
ATTEMPTS: Final = 4
TIGHT: Final = 1e-7
"""A multiplier of the programme above this marks a limit that holds the motion back [-]."""
NUDGE: Final = 1e-5
"""Of a freedom, for the derivative of the manipulability's gradient [m, rad]."""


@dataclass(slots=True, eq=False)
class Step:
    """What one step came to."""

    q: Floats
    """Freedoms after it, shape (m,)."""
    place: Floats
    """Of the tool before it, world [m], shape (3,)."""
    measure: float
    """V before it [-]."""
    share: float
    """Of the programme's motion that was carried out [-]; less than 1 where a curved limit was nearer than its tangent."""
    tight: tuple[int, ...]
    """Limits that held the motion back, ranges and speeds, as places in `limit_names`."""
    solved: bool = True
    """Whether the programme was solved; if not, the robot rests for this step."""


class Cooperator:
    """Moves the freedoms of one walker for a tool, one step at a time."""

    def __init__(self, robot: WalkerRobot, settings: Cooperation, footing: PlantedFeet, kept: Kept = "all") -> None:
        """Raises `CooperationError` if the robot has no arm or the settings are for another number of freedoms.

        Args:
            robot: With an arm.
            settings: Of the law.
            footing: What it stands on.
            kept: Which limits are kept, where the settings ask for limits.
        """
        if robot.arm is None:
            raise CooperationError("robot", repr(robot.name), "must have an arm")
        m = POSE + robot.arm.n_joints
        if np.shape(settings.speeds) != (m,):
            raise CooperationError("speeds", settings.speeds, f"must be {m} numbers, one for each freedom")
        self.robot, self.settings, self._kept = robot, settings, kept
        self.names = limit_names(robot)
        self._m = m
        self._w = make_scratch(robot.arm.n_joints)
        self._programme = make_programme(m)
        self._tight = np.zeros(len(self.names))
        s = settings
        little = np.array([0.0 if s.lent else swerve(s, robot), stretch(s, robot)])
        self._law = Law(
            fastest=np.array(s.speeds),
            tool_speeds=np.array(s.tool_speeds),
            gain=float(s.gain),
            approach=float(s.approach),
            inside=float(s.inside),
            softness=float(s.softness),
            little=little,
            enough=s.damping * little,
        )
        self.stand(footing)

    def stand(self, footing: PlantedFeet) -> None:
        """Stand anew, with other feet or from another pose."""
        self.footing = footing
        self._record: Any = footing.record()[0]
        self.chain = chain_of(self.robot, balance=self.settings.balance, footing=footing, kept=self._kept)

    def check_weights(self, weights: Floats) -> None:
        """Raises `CooperationError` if a freedom takes part that the standing feet hold."""
        if np.shape(weights) != (self._m,) or not ((weights >= 0.0) & (weights <= 1.0)).all():
            raise CooperationError("weights", weights, f"must be {self._m} numbers from 0 to 1")
        if self.settings.limited and self.footing.support != "y" and weights[[0, 1, 3]].any():
            raise CooperationError("weights", weights, "x, y and alpha must be 0 unless the Y-frame alone stands")

    @property
    def n_ranges(self) -> int:
        """How many of `names` are ranges; the rest are speeds."""
        return self._m - POSE + N_ROWS

    def check_start(self, q: Floats) -> None:
        """Make sure that a configuration is within every limit.

        Raises:
            LimitError: With the limit that it breaks, and by how much.
        """
        if np.shape(q) != (self._m,) or not np.isfinite(q).all():
            raise CooperationError("q", q, f"must be {self._m} finite numbers")
        low, high = self.limits()
        values = self.limited_values(q)
        units = ("rad",) * (self._m - POSE) + ROW_UNITS
        for name, value, least, most, unit in zip(self.names, values, low, high, units, strict=False):
            if not least <= value <= most:
                allowed = f"{least:.6g} to {most:.6g} {unit}" if np.isfinite(most) else f"{least:.6g} {unit} and more"
                raise LimitError(f"{name} [{unit}]", float(value), f"allowed is {allowed}")

    def limits(self) -> tuple[Floats, Floats]:
        """Least and largest values in the order of `names`."""
        c = self.chain
        return np.concatenate([c.lowest, c.row_lowest]), np.concatenate([c.highest, c.row_highest])

    def limited_values(self, q: Floats) -> Floats:
        """What is limited, at a configuration, in the order of `names`; rows that the stance has not are in the middle of nothing: 1e9."""
        see_tool(self.chain, q, self._w)
        see_bounds(self.chain, self._record, q, self._w)
        values = np.concatenate([q[POSE:], self._w.values])
        values[self._m - POSE + BALANCE + self._record["n_edges"] :] = 1e9
        return values

    def place(self, q: Floats) -> Floats:
        """Of the tool, world [m], shape (3,)."""
        see_tool(self.chain, q, self._w)
        return self._w.place.copy()

    def measure(self, q: Floats, weights: Floats) -> float:
        """V of the normalised chain with some of its freedoms [-]."""
        return float(see(self.chain, self._record, q, weights, self._law, self.settings.limited, self._w))

    def gradient(self, q: Floats, weights: Floats) -> Floats:
        """dV/dq^ of the normalised chain [-], shape (m,)."""
        self.measure(q, weights)
        return self._w.gradient.copy()

    def scaled_jacobian(self, q: Floats, weights: Floats) -> Floats:
        """J^ [-], shape (3, m)."""
        self.measure(q, weights)
        return self._w.scaled.copy()

    def y_in_delta(self, q: Floats) -> tuple[tuple[float, float], float]:
        """Offset [m] and twist [rad] of the Y-frame in the Delta-frame at a configuration."""
        self.limited_values(q)
        x, y, twist = self._w.y_place.tolist()
        return (x, y), twist

    def step(
        self, q: Floats, target: Floats, velocity: Floats, weights: Floats, *, feedback: float | None = None
    ) -> Step:
        """The configuration one period later.

        Args:
            q: Freedoms now, within every limit, shape (m,).
            target: Where the tool is to be now, world [m], shape (3,).
            velocity: How that place moves [m/s], shape (3,).
            weights: 1 for each freedom that takes part, 0 for the others, anything between while switching, shape (m,).
            feedback: In place of the setting's [1/s].
        """
        s, w = self.settings, self._w
        back = s.feedback if feedback is None else feedback
        if not s.limited:
            measure = move_freely(
                self.chain, self._record, q, weights, self._law, back, target, velocity, s.form == "as printed", s.period, w
            )  # fmt: skip
            return Step(w.after.copy(), w.place.copy(), measure, 1.0, ())
        p = self._programme
        measure, count = prepare(
            self.chain, self._record, q, weights, self._law, back, target, velocity, s.lent, w, p
        )  # fmt: skip
        x, multipliers, solved = self._solve(count)
        if calm(x, count, self._law, w, p):
            x, multipliers, solved = self._solve(count)
        place = w.place.copy()
        share = finish(self.chain, self._record, q, x, multipliers, count, s.period, self._tight, w, p)
        tight = tuple(np.flatnonzero(self._tight > TIGHT).tolist())
        return Step(w.after.copy(), place, measure, share, tight, solved)

    def hold(self, q: Floats, point: Floats, weights: Floats) -> Step:
        """The configuration one period later, the tool brought to a point of the world [m], shape (3,), in that period.

        A body that walks carries the tool off within a period, and one period's motion takes it back. Other arguments as in `step`.
        """
        return self.step(q, point, np.zeros(3), weights, feedback=1.0 / self.settings.period)

    def _solve(self, count: int) -> tuple[Floats, Floats, bool]:
        """Solution, multipliers, and whether there is one; else rest, which every limit allows."""
        import daqp

        p, m = self._programme, self._m
        for _ in range(ATTEMPTS):
            x, _, flag, info = daqp.solve(
                p.weights, p.f, p.rows[:count], p.upper[: m + count], p.lower[: m + count], p.sense[: m + count].copy()
            )
            if flag == SOLVED:
                return x, info["lam"], True
            if flag == CONTRADICTED:
                let_rest(count, p)
            else:  # the method cycles where a tool's motion that cannot be had outweighs the rest by too many digits
                p.rows[:3, m:] *= 10.0
        return np.zeros(m + 3), np.zeros(m + count), False


def stable_gain(law: Cooperator, q: Floats, weights: Floats) -> float:
    """The gain k_p below which equation 19's second term comes to rest at a summit of V near a configuration.

    In steps of dt, a deviation from the summit along a direction that leaves the tool where it is, is multiplied by 1 + k_p dt h, with
    h < 0 the slope of the second term's own strength (I - J^+ J^) dV/dq^ in that direction: it shrinks while k_p dt |h| < 2. The slopes
    are taken at `q`; the projection turns with the posture, so they are not those of the gradient alone.

    Args:
        law: With its settings.
        q: Freedoms, shape (m,).
        weights: Of the freedoms, shape (m,).

    Returns:
        2 / (dt |h|) for the steepest slope [-]; infinite where V rises to no summit.
    """
    speeds = weights * law.settings.speeds

    def projector(p: Floats) -> Floats:
        scaled = law.scaled_jacobian(p, weights)
        out: Floats = np.eye(p.size) - np.linalg.pinv(scaled) @ scaled
        return out

    slopes = np.empty((q.size, q.size))
    for k in range(q.size):
        ahead, behind = q.copy(), q.copy()
        ahead[k] += NUDGE
        behind[k] -= NUDGE
        change = projector(ahead) @ law.gradient(ahead, weights) - projector(behind) @ law.gradient(behind, weights)
        slopes[:, k] = speeds[k] * change / (2.0 * NUDGE)
    rest = projector(q)
    steepest = float(np.linalg.eigvals(rest @ slopes @ rest).real.min())
    return float("inf") if steepest >= 0.0 else 2.0 / (law.settings.period * -steepest)
