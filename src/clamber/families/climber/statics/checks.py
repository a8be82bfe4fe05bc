"""The checks of a limbed climber's stance: order, unit and meaning of each margin (positive holds, negative fails)."""

from typing import Final

from ....planning.problem.check import Check

LIMBED_CHECKS: Final[tuple[Check, ...]] = (
    Check("reach", "m", "reach limit less distance from port to hold, smallest over holding limbs"),
    Check(
        "joint", "rad", "distance of a joint from its nearer limit in the best allowed branch, smallest over holders"
    ),
    Check("support", "1", "holding limbs less the number that must hold"),
    Check("hangs", "1", "hangs still allowed"),
    Check("torque", "N m", "torque limit less torque, smallest over the joints that carry weight"),
    Check("power", "W", "power limit less electrical power of the joints that carry weight"),
    Check("clearance", "m", "distance of the body's origin from the nearest hold, less what the task asks for"),
    Check("swing", "m", "the same along the arc of a hang"),
    Check("keep_out", "m", "distance of body and limbs from the nearest keep-out region"),
    Check("limb_limb", "m", "gap between the links of two limbs"),
    Check("limb_body", "m", "gap between a limb's second link and the body"),
    Check("limb_peg", "m", "gap between a link and a hold that its limb does not use"),
    Check("hook", "N", "how far the forces can be spread so that every end effector and hold can take them"),
    Check("shared", "1", "0, or -1 when two limbs are on one hold"),
    Check(
        "stability",
        "m",
        "how far the body's origin lies inside the span of the holds that carry it, less what the task asks for",
    ),
    Check("holder_peg", "m", "gap between other holds and a limb that holds, its hook's way onto its hold with it"),
)
"""In the order in which a failing check is named as the reason."""

DEFAULT_HARD: Final = ("reach", "joint", "support", "hangs", "torque", "power", "clearance", "swing", "keep_out")
"""The checks that forbid an action unless the task says otherwise; the others only report."""
