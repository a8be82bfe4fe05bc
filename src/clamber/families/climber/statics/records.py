"""The fixed-size records that kernels read and write: limb, rules, hold, goal, stance. Plain data, SI and radians."""

import numpy as np

from ....compiled import carray, inlined, pointer
from ..robot.kinematics import SOLUTION

LIMBS = 8
"""Limb slots of a stance; a robot uses the first n."""
LIMB = np.dtype(
    [
        ("port_x", "f8"),
        ("port_y", "f8"),
        ("c_port", "f8"),
        ("s_port", "f8"),
        ("l1", "f8"),
        ("l2", "f8"),  # the effective second link, hook offset included
        ("per_product", "f8"),  # 1 / (2 l1 l2)
        ("length", "f8"),
        ("c_hook", "f8"),  # from the effective second link to the grab direction
        ("s_hook", "f8"),
        ("c_centre1", "f8"),  # centre of the shoulder's range
        ("s_centre1", "f8"),
        ("half1", "f8"),
        ("c_centre2", "f8"),  # centre of the elbow's range, plus the effective second link's beta
        ("s_centre2", "f8"),
        ("half2", "f8"),
        ("limit1", "f8"),
        ("limit2", "f8"),
        ("heat1", "f8"),  # R / (N k_t)^2: power per torque squared
        ("heat2", "f8"),
        ("c_cone", "f8"),  # cosine and sine of the end effector's cone; c_cone = -2 means any direction
        ("s_cone", "f8"),
        ("pull", "f8"),  # least along the grab direction, with a cone; 0: any
        ("strength", "f8"),  # of the end effector; inf: any force
    ],
    align=True,
)

PARAMS = np.dtype(
    [
        ("x0", "f8"),
        ("y0", "f8"),
        ("a0", "f8"),
        ("tick", "f8"),
        ("tick_angle", "f8"),
        ("turn_ticks", "i8"),
        ("weight", "f8"),
        ("reach_offset", "f8"),
        ("holding_offset", "f8"),
        ("clearance", "f8"),
        ("inside", "f8"),
        ("max_power", "f8"),
        ("max_swing", "f8"),  # pi: any
        ("link_radius", "f8"),
        ("body_margin", "f8"),
        ("hook_width", "f8"),  # 0: hooks are points
        ("hook_ahead", "f8"),
        ("hook_way", "f8"),
        ("hook_room", "f8"),
        ("grid_x", "f8"),
        ("grid_y", "f8"),
        ("grid_cell", "f8"),
        ("centre_x", "f8"),
        ("centre_y", "f8"),
        ("centre_angle", "f8"),
        ("grid_nx", "i8"),
        ("grid_ny", "i8"),
        ("seed", "u8"),
        ("n_limbs", "i4"),
        ("n_goals", "i4"),
        ("force_rule", "i4"),
        ("atomic", "i4"),
        ("max_hangs", "i4"),
        ("min_supports", "i4"),
        ("idle", "i4"),
        ("offset_while_holding", "i4"),
        ("replace", "i4"),
        ("kept", "i4"),
        ("circles", "i4"),  # some goal asks for turns about the centre
        ("turning", "i4"),  # 1 or -1 where all that ask for turns ask for them that way round, else 0
        ("allowed", "i4"),  # bits 0 to 5: body moves, 6: releases, 7: grabs; what `candidates` lists
        ("hard", "i4"),
        ("seen", "i4"),
        ("shares", "i4"),  # two limbs may be on one hold
        ("mirrored", "i4"),  # the task is its own mirror image (`actions.limbed_symmetry`)
        ("mirror_x", "i8"),  # ticks of a place and of its image add up to this
        ("mirror_angle", "i8"),
        # The relaxed problem (`actions.relaxed`), where one was made
        ("angles", "i4"),  # angles of a turn
        ("angles_kept", "i4"),  # entries per state: one per angle, or 1 where rotation is free
        ("laps_least", "i4"),
        ("laps_most", "i4"),  # number of laps told apart
        ("places_x", "i8"),  # first place, in steps from the start
        ("places_y", "i8"),
        ("places_nx", "i8"),
        ("places_ny", "i8"),
        ("opposed", "i4", (LIMBS,)),  # bit j of entry i: limbs i and j count as one on each side
        ("kinds", "i4", (LIMBS,)),  # how each feature adds up over a plan: 0 the last, 1 the sum, 2 the largest
        # Addresses and lengths of the arrays: a kernel is handed one pointer, not the ninety words of a tuple of arrays
        ("limbs_at", "i8"),
        ("holds_at", "i8"),
        ("cells_at", "i8"),
        ("cell_start_at", "i8"),
        ("goals_at", "i8"),
        ("vertices_at", "i8"),
        ("keep_out_at", "i8"),
        ("hull_at", "i8"),
        ("work_at", "i8"),
        ("limb_image_at", "i8"),
        ("hold_image_at", "i8"),
        ("grip_starts_at", "i8"),
        ("grip_holds_at", "i8"),
        ("state_base_at", "i8"),
        ("left_at", "i8"),
        ("n_grip_holds", "i8"),
        ("n_state_base", "i8"),
        ("n_left", "i8"),
        ("n_holds", "i8"),
        ("n_vertices", "i8"),
        ("fences", "i8"),  # number of keep-out polygons
        ("n_hull", "i8"),
        ("n_work", "i8"),
    ],
    align=True,
)
"""What the limbed climber's kernels read: rules, robot, and where its arrays lie. Its type chooses the family while compiling."""

HOLD = np.dtype(
    [
        ("x", "f8"),
        ("y", "f8"),
        ("radius", "f8"),
        ("dir_x", "f8"),
        ("dir_y", "f8"),
        ("c_cone", "f8"),  # -2: any direction
        ("s_cone", "f8"),
        ("strength", "f8"),  # inf: any force
        ("limbs", "i4"),  # bit i: limb i may use it
        ("number", "i4"),
    ],
    align=True,
)

GOAL = np.dtype(
    [
        ("x_min", "f8"),
        ("x_max", "f8"),
        ("y_min", "f8"),
        ("y_max", "f8"),
        ("a_mid", "f8"),
        ("a_half", "f8"),  # at least pi: any angle
        ("turns", "f8"),  # [rad], signed; 0: none asked
        ("radius", "f8"),
        ("before", "f8"),  # way from the start to the goal before this one, along the goals [m]
        ("way", "f8"),  # way from the goal before to this one [m]
        ("after", "f8"),  # fewest body steps from this goal's box through those of the later goals
        ("rise_after", "f8"),  # of them, fewest steps up
        ("vertex", "i8"),
        ("n_vertices", "i8"),
        ("hangs", "i4"),  # whether the robot may hang on the way to it
        ("hold", "i4", (LIMBS,)),  # index of the hold that limb must hold; -1: any
    ],
    align=True,
)

STANCE = np.dtype(
    [
        ("ix", "i8"),
        ("iy", "i8"),
        ("ia", "i8"),
        ("elbows", "i8", (4,)),  # assignments still open (`statics.elbows`); read where branches are kept
        ("hold", "i4", (LIMBS,)),  # index into the holds; -1: free
        ("left", "i4", (LIMBS,)),  # the hold it held last
        ("branch", "i4", (LIMBS,)),  # branch taken
        ("in_use", "i4"),
        ("hangs", "i4"),
        ("stage", "i4"),
        ("laps", "i4"),
        ("count", "i4"),
        ("carriers", "i4"),  # bit i: limb i carries
        ("push_pull", "i4"),
        ("resolved", "i4"),  # index of the hold that the last action took; -1: none
        ("x", "f8"),
        ("y", "f8"),
        ("angle", "f8"),
        ("c", "f8"),
        ("s", "f8"),
        ("turned", "f8"),  # angle of the hang in the last action [rad]
        ("bearing", "f8"),  # direction of the origin from the task's centre [rad]; 0 if no goal asks for turns
        ("power", "f8"),
        ("torque", "f8"),  # largest |torque| [N m]
        ("foot", "f8", (LIMBS, 2)),  # a free limb's tip, body frame [m]
        ("force", "f8", (LIMBS, 2)),  # force of the hold on the limb [N]
        ("torques", "f8", (LIMBS, 2)),
        ("solved", "f8", (LIMBS, SOLUTION)),
    ],
    align=True,
)


@inlined
def limbs(p):
    """Records of `LIMB`, one per limb."""
    return carray(pointer(p.limbs_at), p.n_limbs, LIMB)


@inlined
def holds(p):
    """Records of `HOLD`."""
    return carray(pointer(p.holds_at), p.n_holds, HOLD)


@inlined
def cells(p):
    """Indices of the holds, cell by cell of the grid."""
    return carray(pointer(p.cells_at), p.n_holds, np.int32)


@inlined
def cell_start(p):
    """Where each cell starts in `cells`, and the end."""
    return carray(pointer(p.cell_start_at), p.grid_nx * p.grid_ny + 1, np.int32)


@inlined
def goals(p):
    """Records of `GOAL`, in order."""
    return carray(pointer(p.goals_at), p.n_goals, GOAL)


@inlined
def vertices(p):
    """Corners of keep-outs and goal regions, shape (n, 2) [m]."""
    return carray(pointer(p.vertices_at), (p.n_vertices, 2), np.float64)


@inlined
def keep_out(p):
    """First vertex of each keep-out polygon, and the end."""
    return carray(pointer(p.keep_out_at), p.fences + 1, np.int64)


@inlined
def hull(p):
    """Convex outline of the ports, body frame, shape (n, 2) [m]."""
    return carray(pointer(p.hull_at), (p.n_hull, 2), np.float64)


@inlined
def work(p):
    """Scratch of one thread."""
    return carray(pointer(p.work_at), p.n_work, np.float64)
