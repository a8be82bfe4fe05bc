"""The limb as Bevly's (1997) simplified model, Eq. 3.28, as a plant: geared joints that do not know of each other."""

import numpy as np

from ..control.chain import Chain
from ..control.kinematics import FRAME
from ..control.records import AXES
from ..execution.plant import Sensed, Truth
from ..types import Floats
from .limb_electronics import Chances, LimbElectronics
from .limb_flaws import LimbFlaws
from .ode_steps import step_limbs
from .plant_rules import PlantError


class OdeLimb:
    """A batch of equal limbs by the ODE of `ode_steps`, with the sensors and motors of `flaws`. A `Plant`.

    It knows the joints' reflected inertia, viscous and Coulomb friction and a push on the tip, and shares the electronics of every plant.

    Args:
        chain: The limb as it is; masses and inertias of its links do not count.
        flaws: What is not ideal about it.
        gears: Motor turns per joint turn, shape (n,): encoder counts are of the motor.
        batch: Number of limbs.
        threads: Not used: a batch is one loop in one kernel.

    Raises:
        PlantError: If `flaws` asks for what the model does not have: backlash, a payload, weight, a wall, joint limits.
    """

    def __init__(
        self, chain: Chain, flaws: LimbFlaws, *, gears: Floats | None = None, batch: int = 1, threads: int = 0
    ) -> None:
        _refuse(chain, flaws)
        self.chain, self.flaws, self.batch = chain, flaws, batch
        self.period = flaws.period
        n = chain.n
        self._joints = chain.joints.copy()
        self._joints["damping"] *= flaws.damping
        self._joints["friction"] *= flaws.friction
        self._electronics = LimbElectronics(chain, flaws, gears, batch)
        self._initial_conditions = None if flaws.seed is None else Chances(flaws, batch, n, self._electronics.counts)
        self._force = np.zeros(2)
        self._scratch = (np.zeros((n, FRAME)), np.zeros((AXES, n)), np.zeros((4, max(n, 12))))
        self._sensed = Sensed(self._electronics.states, np.zeros((batch, AXES)), np.zeros((batch, AXES)))
        self._truth = Truth(np.zeros((batch, 2, n)), np.zeros((batch, n)), np.zeros((batch, AXES)))
        self.tick = 0

    def reset(self, q: Floats) -> None:
        """See `Plant`."""
        self._truth.states[:, 0] = q
        self._truth.states[:, 1] = 0.0
        self._truth.torques[:] = 0.0
        self._truth.wrenches[:] = 0.0
        if self._initial_conditions is not None:
            self._initial_conditions.restart()
        self._electronics.reset()
        self.tick = 0

    def sense(self) -> Sensed:
        """See `Plant`."""
        states, initial_conditions = self._truth.states, self._initial_conditions
        self._electronics.read(
            states[:, 0] if initial_conditions is None else states[:, 0] + initial_conditions.phase, states[:, 1]
        )
        if initial_conditions is not None:
            initial_conditions.disturb(self._sensed.states)
        self._sensed.number[0] = self.tick
        return self._sensed

    def actuate(self, torques: Floats) -> None:
        """See `Plant`."""
        self._electronics.ask(torques)

    def step(self) -> None:
        """See `Plant`. The motors' limits follow the speed at every physics step."""
        if self.flaws.push is not None:
            self._force[:] = self.flaws.push.at((self.tick + 0.5) * self.period)
            self._truth.wrenches[:, :2] = -self._force
        step_limbs(
            self._joints,
            self.chain.root,
            (self._electronics.wanted, self._electronics.limits, self._electronics.no_load),
            self._force,
            (self.flaws.steps, 1.0 / self.flaws.physics_rate),
            self._truth.states,
            self._truth.torques,
            self._scratch,
        )
        self.tick += 1

    def truth(self) -> Truth:
        """See `Plant`."""
        return self._truth


def _refuse(chain: Chain, flaws: LimbFlaws) -> None:
    ode = "the ODE plant has none: take the plant 'mujoco'"
    for key, value, allowed in (
        ("backlash", flaws.backlash, "must be 0 rad"),
        ("payload", flaws.payload, "must be 0 kg"),
        ("upright", flaws.upright, "must be false, as its limbs have no weight"),
        ("joint_limits", flaws.joint_limits, "must be false"),
    ):
        if value:
            raise PlantError(key, value, f"{allowed}; {ode}")
    for key in ("wrist", "base"):
        if getattr(flaws, key) is not None:
            raise PlantError(key, "a force sensor", f"must be left out; {ode}")
    if flaws.wall is not None:
        raise PlantError("wall", f"({flaws.wall.x:g}, {flaws.wall.y:g}) m", f"must be left out; {ode}")
    if np.any(chain.root["gravity"]):
        raise PlantError("gravity", chain.root["gravity"][0].tolist(), f"must be 0 in the chain; {ode}")
    for name, rotor in zip(chain.joint_names, chain.joints["rotor"], strict=True):
        if not rotor > 0.0:
            raise PlantError(
                f"{name}.rotor", float(rotor), "must be more than 0 kg m^2: it is all the inertia of the ODE"
            )
