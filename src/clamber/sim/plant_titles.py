"""What each plant of a limb is, in a line: for lists, which must not wait until the simulators are loaded."""

from typing import Final

PLANT_TITLES: Final[dict[str, str]] = {
    "mujoco": "A batch of equal limbs in MuJoCo, with the sensors and motors of `flaws`. A `Plant`.",
    "ode": "A batch of equal limbs by the ODE of `ode_steps`, with the sensors and motors of `flaws`. A `Plant`.",
}
"""Plant -> the first line of its docstring."""
