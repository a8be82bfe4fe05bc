"""The checks of a stance in space: order, unit and meaning of each margin (positive holds, negative fails)."""

from typing import Final

from ....planning.problem.check import Check

STANCE_CHECKS: Final[tuple[Check, ...]] = (
    Check(
        "reach",
        "m",
        "distance that counts as reached, less what is left between tip and hold, or what a limb is stretched too far",
    ),
    Check("joint", "rad", "distance of a joint from its nearer limit, less the room that is asked for"),
    Check("tilt", "rad", "tilt that a contact bears, less the angle of end effector and surface; over limbs that bear"),
    Check("jump", "rad", "largest change of a joint that is allowed, less the change from the posture before"),
    Check("limb_limb", "m", "gap between the links of two limbs, less the room that is asked for"),
    Check("limb_body", "m", "gap between links and the base's box"),
    Check("equilibrium", "1", "share of all limits that the best distribution of forces leaves free, less the need"),
    Check("torque", "N m", "motor limit less torque, smallest over the joints; a force [N] for slides"),
    Check("slip", "N", "tangential force that a contact could take besides, smallest over contacts"),
    Check("grip", "N", "normal force left until a contact comes off or is overloaded, smallest over contacts"),
    Check("moment", "N m", "moment that a contact could take besides, smallest over contacts that bear moments"),
)
"""In the order in which they are judged; a failing one is named as the reason."""

STANCE_CHECK: Final = {check.name: number for number, check in enumerate(STANCE_CHECKS)}
REACH: Final = 0
JOINT: Final = 1
TILT: Final = 2
JUMP: Final = 3
LIMB_LIMB: Final = 4
LIMB_BODY: Final = 5
EQUILIBRIUM: Final = 6
TORQUE: Final = 7
SLIP: Final = 8
GRIP: Final = 9
MOMENT: Final = 10
