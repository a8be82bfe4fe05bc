"""The limb as Bevly's (1997) simplified model, Eq. 3.28, as a plant: geared joints that do not know of each other."""

import numpy as np

from ..control.chain import Chain
from ..control.kinematics import FRAME
from ..control.records import AXES
from ..types import Floats
from .limb_electronics import SimulatedLimb
from .limb_flaws import LimbFlaws
from .ode_steps import step_limbs
from .plant_rules import PlantError


class OdeLimb(SimulatedLimb):
    """A batch of equal limbs by the ODE of `ode_steps`, with the sensors and motors of `flaws`. A `Plant`.

    It knows the joints' reflected inertia, viscous and Coulomb friction and a push on the tip, and shares the electronics of every plant.

    Args:
        chain: The limb as it is; masses and inertias of its links do not count.
        flaws, gears, batch: As of any `SimulatedLimb`.
        threads: Not used: a batch is one loop in one kernel.

    Raises:
        PlantError: If `flaws` asks for what the model does not have: backlash, a payload, weight, a wall, joint limits.
    """

    def __init__(
        self, chain: Chain, flaws: LimbFlaws, *, gears: Floats | None = None, batch: int = 1, threads: int = 0
    ) -> None:
        _refuse(chain, flaws)
        super().__init__(chain, flaws, gears, batch)
        n = chain.n
        self._joints = chain.joints.copy()
        self._joints["damping"] *= flaws.damping
        self._joints["friction"] *= flaws.friction
        self._force = np.zeros(2)
        self._scratch = (np.zeros((n, FRAME)), np.zeros((AXES, n)), np.zeros((4, max(n, 12))))

    def reset(self, q: Floats) -> None:
        """See `Plant`."""
        self._truth.states[:, 0] = q
        self._truth.states[:, 1] = 0.0
        self._restart()

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
