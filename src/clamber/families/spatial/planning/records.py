"""Records of stances, goals and problems in space, as kernels read them."""

from typing import Final

import numpy as np

from ..statics.records import JOINTS, LIMBS

AXES: Final = 6
"""Of a pose: along, across, height, yaw, pitch, roll."""
ALONG, ACROSS, HEIGHT, YAW, PITCH, ROLL = range(AXES)
STANCE: Final = np.dtype(
    [
        ("pose", "i8", (AXES,)),  # steps of each axis from the start
        ("hold", "i4", (LIMBS,)),  # index of each limb's hold, -1 where the robot has no such limb
        ("stage", "i4"),  # goals met
        ("count", "i4"),  # actions so far
        ("postured", "i4"),  # whether `q` is the posture of the stance
        ("x", "f8"),  # along the guide [m]
        ("y", "f8"),  # across it [m]
        ("angle", "f8"),  # yaw [rad]
        ("torque", "f8"),  # largest joint torque [N m]
        ("share", "f8"),  # of every strength and torque that is left unused [-]
        ("place", "f8", (3,)),  # base frame's origin, world frame [m]
        ("turn", "f8", (9,)),  # base frame's axes as columns, world frame, row by row
        ("q", "f8", (LIMBS, JOINTS)),  # joint positions [rad] or [m]
        (
            "wrench",
            "f8",
            (LIMBS, 6),
        ),  # of each contact on the robot, world frame: force [N], moment about the tip [N m]
    ],
    align=True,
)
KNOWN: Final = np.dtype(
    [
        ("pose", "i8", (AXES,)),
        ("limb", "i8"),  # its number from 1, 0 where nothing is kept, and above 16 bits the hold
        ("error", "f8"),  # that the posture leaves [m]
        ("posture", "f8", (JOINTS,)),
    ],
    align=True,
)
"""The posture of a limb for a pose and a hold, kept because it depends on them alone."""
LIFTED: Final = np.dtype(
    [
        ("pose", "i8", (AXES,)),
        ("hold", "i4", (LIMBS,)),
        ("verdict", "i4", (LIMBS,)),  # first check of forces that is violated while the limb bears nothing, -1: none
        ("known", "i4"),  # a bit for each limb whose verdict is kept
    ],
    align=True,
)
"""Whether each limb of a stance may be lifted, kept because it depends on pose and holds alone."""
GOAL: Final = np.dtype(
    [
        ("along_min", "f8"),
        ("along_max", "f8"),
        ("across_min", "f8"),
        ("across_max", "f8"),  # [m]
        ("yaw_min", "f8"),
        ("yaw_width", "f8"),  # least yaw and how far on from there [rad]; width 7: any
        ("way", "f8"),  # from the start through the goals before to this one, each entered where it is nearest [m]
    ],
    align=True,
)
HOLD: Final = np.dtype(
    [
        ("place", "f8", (3,)),  # world frame [m]
        ("normal", "f8", (3,)),  # out of the surface
        ("friction", "f8"),  # largest coefficient; infinite: the end effector's own
        ("strength", "f8"),  # largest force [N]; infinite: any
        ("along", "f8"),
        ("across", "f8"),
        ("height", "f8"),  # on the guide [m]
    ],
    align=True,
)
PARAMS: Final = np.dtype(
    [
        ("along", "f8"),
        ("across", "f8"),
        ("height", "f8"),
        ("yaw", "f8"),
        ("pitch", "f8"),
        ("roll", "f8"),  # of the start
        ("length", "f8"),
        ("rise", "f8"),
        ("angle", "f8"),
        ("tilt", "f8"),  # of a step
        ("follow_along", "f8"),
        ("follow_across", "f8"),
        ("follow_grain", "f8"),  # the grid of the fitted surface
        ("lift", "f8"),
        ("clearance", "f8"),
        ("base", "f8"),
        ("reach", "f8"),
        ("heights", "i8"),
        ("tilts", "i8"),
        ("far", "i8"),
        ("nearest", "i8"),
        ("turns", "i8"),
        ("n_limbs", "i4"),
        ("hard", "i4"),
        ("kinds", "i4", (8,)),
        ("n_goals", "i8"),
        ("n_holds", "i8"),
        ("n_frames", "i8"),
        ("n_solids", "i8"),
        ("n_rows", "i8"),
        ("n_columns", "i8"),
        ("region_low", "i8", (AXES,)),
        ("region_count", "i8", (AXES,)),  # box of poses that tables of the bound are for
        ("n_region", "i8"),
        ("n_poses", "i8"),
        ("region_at", "i8"),
        ("left_at", "i8"),
        ("robot_at", "i8"),
        ("seeds_at", "i8"),
        ("rules_at", "i8"),
        ("goals_at", "i8"),
        ("holds_at", "i8"),
        ("frames_at", "i8"),
        ("follow_at", "i8"),
        ("solids_at", "i8"),
        ("spans_at", "i8"),
        ("tips_at", "i8"),
        ("work_at", "i8"),
        ("work_body_at", "i8"),
        ("work_contacts_at", "i8"),
        ("work_judged_at", "i8"),
        ("work_statics_at", "i8"),
        ("work_known_at", "i8"),
        ("n_work_known", "i8"),
        ("work_lifted_at", "i8"),
        ("n_work_lifted", "i8"),
    ],
    align=True,
)
"""A task in space as its kernels read it: numbers, then addresses of its arrays."""
