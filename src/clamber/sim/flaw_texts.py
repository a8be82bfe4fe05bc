"""A plant's properties as a user writes them, such as backlash=2deg, and sets of them by name."""

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Any, Final

from ..errors import UnitError, UnknownNameError, describe_choices
from ..units import parse_quantity
from .bench_limb import GearedRobot
from .limb_flaws import ForceSensor, LimbFlaws
from .plant_rules import PlantError

DIMENSIONS: Final[dict[str, str]] = {
    "backlash": "angle",
    "friction": "ratio",
    "damping": "ratio",
    "payload": "mass",
    "control_rate": "frequency",
    "physics_rate": "frequency",
    "speed_noise": "angular speed",
    "wrench_noise": "force",
    "model_error": "ratio",
}
"""Property -> its dimension; what is not here is a whole number or yes or no."""
WHOLE: Final = ("encoder_counts", "delay")
SWITCHES: Final = ("upright", "motor_limits", "joint_limits")
RANDOM: Final = ("speed_noise", "wrench_noise", "model_error")
"""What needs a seed."""
USUAL: Final = LimbFlaws()
SET: Final = ("ideal", "nominal")
"""Names of sets of flaws."""
YES_NO: Final = {
    "yes": True,
    "true": True,
    "on": True,
    "1": True,
    "no": False,
    "false": False,
    "off": False,
    "0": False,
}


def named_flaws(name: str, robot: GearedRobot) -> LimbFlaws:
    """A set of flaws by name: "ideal", with friction alone, or "nominal", as the robot's file has its motors, with a sample of delay.

    Raises:
        UnknownNameError: If there is no such set.
    """
    if name not in SET:
        raise UnknownNameError("set of flaws", name, SET)
    rate = robot.motor.control_rate
    flaws = LimbFlaws() if rate is None else LimbFlaws(control_rate=rate)
    if name == "ideal":
        return flaws
    return flaws.with_changes(backlash=robot.motor.backlash, encoder_counts=robot.motor.encoder_counts, delay=1)


def read_flaw(text: str) -> tuple[str, Any]:
    """Key and SI value of a text such as "backlash=2deg".

    Raises:
        PlantError: If there is no such property, or its value cannot be read.
    """
    key, equals, said = (part.strip() for part in text.partition("="))
    known = (*DIMENSIONS, *WHOLE, *SWITCHES)
    if key not in known:
        raise PlantError(key, said, f"no such property; there are {describe_choices(key, known)}")
    if not equals or not said:
        raise PlantError(key, said, "needs a value, as in backlash=2deg")
    if key in WHOLE:
        if not said.isdecimal():
            raise PlantError(key, said, "must be a whole number, 0 or more")
        return key, int(said)
    if key in SWITCHES:
        if said.lower() not in YES_NO:
            raise PlantError(key, said, "must be yes or no")
        return key, YES_NO[said.lower()]
    try:
        return key, parse_quantity(said, DIMENSIONS[key])
    except UnitError as error:
        raise PlantError(key, said, f"{error.problem}; {error.allowed}") from None


def read_flaws(base: LimbFlaws, texts: Iterable[str], seed: int | None = None, *, drawn: bool = False) -> LimbFlaws:
    """`base` with the properties of `texts`, all at once, so that rates may depend on each other.

    Args:
        base: What is not changed.
        texts: Such as "backlash=2deg".
        seed: Of what is left to chance; None: nothing is, unless there is noise, a model error or `drawn`, then 0.
        drawn: Whether chance is wanted.

    Raises:
        PlantError: If one of them cannot be.
    """
    changes = dict(read_flaw(text) for text in texts)
    if seed is None and (drawn or any(changes.get(key) for key in RANDOM)):
        seed = 0
    return base.with_changes(**changes, seed=seed)


def plant_words(flaws: LimbFlaws, *, rate: bool = True) -> str:
    """What is not ideal about a plant, in one line; its control rate first, if `rate`."""
    told = [f"{flaws.control_rate:g} Hz"] if rate else []
    told += [] if flaws.physics_rate == USUAL.physics_rate else [f"physics {flaws.physics_rate:g} Hz"]
    for key, words in (
        ("backlash", f"backlash {math.degrees(flaws.backlash):.4g} deg"),
        ("encoder_counts", f"{flaws.encoder_counts} counts"),
        ("delay", f"delay {flaws.delay}"),
        ("payload", f"payload {flaws.payload:g} kg"),
        ("speed_noise", f"speed noise {flaws.speed_noise:g} rad/s"),
        ("wrench_noise", f"force noise {flaws.wrench_noise:g} N"),
        ("model_error", f"model error {100 * flaws.model_error:g} %"),
    ):
        if getattr(flaws, key):
            told.append(words)
    told += [f"{key} x {getattr(flaws, key):g}" for key in ("friction", "damping") if getattr(flaws, key) != 1.0]
    told += ["upright"] if flaws.upright else []
    told += [] if flaws.motor_limits else ["motors without limits"]
    told += ["joint stops"] if flaws.joint_limits else []
    for sensor, place in ((flaws.wrist, "wrist"), (flaws.base, "mount")):
        if sensor is not None:
            ideal = "ideal " if replace(sensor, seed=0) == ForceSensor() else ""
            told.append(f"{ideal}force sensor at the {place}")
    told += [] if flaws.seed is None else [f"seed {flaws.seed}"]
    return ", ".join(told) or "as its file says"
