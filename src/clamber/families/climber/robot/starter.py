"""A climber to start from: equal limbs with grippers at the corners of a regular body, every number made up."""

import math
from typing import Any, Final

from ....types import Json
from .robot import MAX_LIMBS, SCHEMA

PORT_RADIUS: Final = 11.3
"""From the middle of the body to the ports [cm]."""
MADE_UP: Final = "made up"


def starter_robot(name: str, n_limbs: int = 4) -> Json:
    """The document of a climber with `n_limbs` limbs, all alike, a limb on the right above the middle first, then anticlockwise.

    Args:
        name: What it is called.
        n_limbs: 2 to `MAX_LIMBS`.
    """
    assert 2 <= n_limbs <= MAX_LIMBS
    return {
        "schema": SCHEMA,
        "family": "limbed",
        "name": name,
        "title": f"Climber with {n_limbs} limbs",
        "weight": _made_up(20, "N"),
        "link_radius": _made_up(8, "mm"),
        "body_margin": _made_up(10, "mm"),
        "motor": {
            "torque_limit": _made_up(5, "N m"),
            "torque_constant": _made_up(0.02, "N m/A"),
            "resistance": _made_up(2, "ohm"),
            "no_load_speed": _made_up(4, "rad/s"),
            "encoder_counts": _made_up(1000),
            "backlash": _made_up(0.5, "deg"),
            "control_rate": _made_up(500, "Hz"),
        },
        "limbs": [_limb(index, 180.0 / n_limbs + 360.0 * index / n_limbs) for index in range(n_limbs)],
    }


def _limb(index: int, angle: float) -> Json:
    """A limb whose port is in a direction of the body frame [deg], stretched outwards."""
    x, y = (PORT_RADIUS * of(math.radians(angle)) for of in (math.cos, math.sin))
    return {
        "name": f"limb-{index + 1}",
        "port_x": _made_up(round(x, 2) + 0.0, "cm"),
        "port_y": _made_up(round(y, 2) + 0.0, "cm"),
        "port_angle": _made_up(round(angle, 6), "deg"),
        "l1": _made_up(14, "cm"),
        "l2": _made_up(12, "cm"),
        "link_masses": [_made_up(0.12, "kg"), _made_up(0.08, "kg")],
        "shoulder": _joint(2 * index + 1, 110),
        "elbow": _joint(2 * index + 2, 140),
        "end": {
            "kind": "gripper",
            "offset": _made_up(2, "cm"),
            "friction": _made_up(0.5),
        },
    }


def _joint(number: int, range_: float) -> Json:
    return {
        "number": number,
        "lower": _made_up(-range_, "deg"),
        "upper": _made_up(range_, "deg"),
        "gear": _made_up(200),
        "inertia": _made_up(0.05, "kg m^2"),
        "damping": _made_up(0.2, "N m s/rad"),
        "friction": _made_up(0.1, "N m"),
    }


def _made_up(value: float, unit: str | None = None) -> dict[str, Any]:
    return {"value": value, **({} if unit is None else {"unit": unit}), "source": MADE_UP}
