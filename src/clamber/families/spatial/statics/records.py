"""The fixed-size records that the kernels of robots in space read and write. Plain data, SI and radians, no addresses but the seeds'."""

from collections.abc import Sequence

import numpy as np

from ....types import Records
from ..robot.chains import Chains
from ..robot.contacts import MOST_ROWS, Contact
from .stretch import farthest_tips, stretched

LIMBS = 8
"""Limb slots; a robot uses the first n."""
JOINTS = 7
"""Joint slots of a limb."""
CLEAR = 3.0
"""The last link of a limb keeps away from solids but for so many of its radii about the tip, which touches for it [-]."""
BESIDE = 1
"""So many first links of a limb lie beside those of others: they touch no other limb's, in plans and in the plant ..."""
FIXED = 2
"""... and so many, fixed to the base and beside it, do not touch that."""
FINEST = 0.01
"""Step at the least in which limbs on their way are looked at, per size of the robot [-]."""
UNKNOWNS = 6 * LIMBS
"""Components of wrench of all contacts at most."""
PROGRAMME_ROWS = LIMBS * (MOST_ROWS + 2 * JOINTS)
"""Rows of the linear programme at most: contacts, and each motor both ways round."""

ROBOT = np.dtype(
    [
        ("n_limbs", "i8"),
        ("n_joints", "i8", (LIMBS,)),
        ("sliding", "i8", (LIMBS, JOINTS)),  # 1: a slide, 0: a hinge
        ("offset", "f8", (LIMBS, JOINTS + 1, 3)),  # origin of frame k in frame k - 1; of the last, the tip
        ("rotation", "f8", (LIMBS, JOINTS + 1, 9)),  # axes of frame k in frame k - 1 with joint k at 0, row by row
        ("lower", "f8", (LIMBS, JOINTS)),
        ("upper", "f8", (LIMBS, JOINTS)),
        ("torque", "f8", (LIMBS, JOINTS)),
        ("nominal", "f8", (LIMBS, JOINTS)),
        ("mass", "f8", (LIMBS, JOINTS)),
        ("centre", "f8", (LIMBS, JOINTS, 3)),
        ("radius", "f8", (LIMBS, JOINTS)),
        ("base_mass", "f8"),
        ("base_centre", "f8", (3,)),
        ("base_half", "f8", (3,)),
        ("total_mass", "f8"),
        ("size", "f8"),  # length of the longest limb when stretched
        ("limb_room", "f8"),  # that links of different limbs keep from each other
        ("farthest", "f8", (LIMBS, JOINTS)),  # of a tip from a joint of its limb that a stance may ask for
        (
            "fine",
            "f8",
        ),  # step in which limbs on their way are looked at where they are close to something: the thinnest link's radius
        # Contact of each limb: row . (wrench / its frame) <= limit, with effective friction mu and pull (`contacts.Contact`)
        ("components", "i8", (LIMBS,)),  # 3: a force, 6: a force and a moment
        ("aligned", "i8", (LIMBS,)),  # 1: postures put the end effector's z along the inward normal
        ("n_rows", "i8", (LIMBS,)),
        ("row", "f8", (LIMBS, MOST_ROWS, 6)),
        ("row_friction", "f8", (LIMBS, MOST_ROWS, 6)),  # what a row has more, per mu
        ("limit", "f8", (LIMBS, MOST_ROWS, 3)),  # constant, per pull, per mu times pull
        ("slack", "f8", (LIMBS, MOST_ROWS, 2)),  # what s takes off a limit: per weight of the robot, constant
        ("margin", "i8", (LIMBS, MOST_ROWS)),  # 0: slip, 1: grip, 2: moment
        ("friction", "f8", (LIMBS,)),
        ("pull", "f8", (LIMBS,)),
        ("tilt", "f8", (LIMBS,)),  # largest angle of the end effector's z from the inward normal
        ("tilt_loss", "f8", (LIMBS,)),  # share of the pull that a radian of tilt costs
    ],
    align=True,
)
"""A robot and its contacts, as kernels read them (`robot_record`)."""

SEEDS = np.dtype(
    [
        ("cell", "f8", (LIMBS,)),
        ("low", "f8", (LIMBS, 3)),  # corner of the grid, frame of the limb's mount
        ("count", "i8", (LIMBS, 3)),
        ("turns", "i8", (LIMBS,)),  # directions told apart per cell, 1 or `TURNS`
        ("start", "i8", (LIMBS,)),  # index of the first seed
        ("n_seeds", "i8"),
        ("posture_at", "i8"),
        ("score_at", "i8"),
    ],
    align=True,
)
"""Where to begin searches of postures (`seeds.SeedTable`)."""

BODY = np.dtype(
    [
        ("rotation", "f8", (9,)),  # T_world_base, row by row
        ("place", "f8", (3,)),  # of the base frame [m]
        ("gravity", "f8", (3,)),  # world frame [m/s^2]
        (
            "wrench",
            "f8",
            (6,),
        ),  # of wind or a tool on the base: force [N], then moment about its origin [N m], world frame
    ],
    align=True,
)
"""Pose of the base, and what acts on it besides the contacts."""

CONTACT = np.dtype(
    [
        ("place", "f8", (3,)),  # of the tip, world frame [m]
        ("normal", "f8", (3,)),  # out of the surface, world frame
        ("along", "f8", (3,)),  # first tangent, such as a bar's direction, world frame; zero: the end effector's x
        ("strength", "f8"),  # largest pull [N]; inf: the end effector's alone
        ("friction", "f8"),  # inf: the end effector's alone
        ("bears", "i4"),  # 0: the tip is there and bears nothing
        ("moved", "i4"),  # 1: it was elsewhere before, so `jump_moved` holds
        ("known", "i8"),  # 1: the posture is known (`posture` of what is judged), and `error` is what it leaves
        ("error", "f8"),  # [m]
    ],
    align=True,
)
"""Where a limb's tip is and what is there."""

RULES = np.dtype(
    [
        ("need", "f8"),  # least s of the linear programme
        ("reach", "f8"),  # distance of tip and hold that counts as reached, per size of the robot
        ("joint_room", "f8"),
        ("jump", "f8"),  # largest change of a joint from the posture before [rad] or [m]
        ("jump_moved", "f8"),  # the same for a limb that moved
        ("hard", "i8"),  # bit i: check i ends the judging
        ("exact", "i8"),  # 1: every margin to its end, 0: as far as the verdict needs
    ],
    align=True,
)
"""What a stance is judged by."""

CHECKS_OF_STANCE = 11
"""Margins of a stance (`checks.STANCE_CHECKS`)."""

JUDGED = np.dtype(
    [
        ("posture", "f8", (LIMBS, JOINTS)),
        ("margins", "f8", (CHECKS_OF_STANCE,)),
        ("torque", "f8"),  # largest torque [N m], or force of a slide [N], of the solution
        # Of the linear programme: a lower bound where it holds, else an upper one; exact where rules ask for it
        ("s", "f8"),
        ("wrench", "f8", (LIMBS, 6)),  # of the contact on the limb, its own frame (normal, two tangents): force, moment
        ("frame", "f8", (LIMBS, 9)),  # normal and tangents of each contact, base frame, row by row
        ("origin", "f8", (LIMBS, JOINTS + 1, 3)),  # of every joint's frame and the tip, world frame
        ("centre", "f8", (3,)),  # of mass, world frame
        ("judged", "i4"),  # 1: `posture` means something
        ("pivots", "i4"),
    ],
    align=True,
)
"""What came of judging a stance."""

PATH_POINTS = 7
"""Of a lifted path that are solved."""
PATH_PARTS = 16
"""Of the way from one of them to the next, at most. Where a limb can only jump, as to the other of two postures for a place,
none is small enough, but where the path all but meets the singularity between them: there a limb goes through that."""
WORK = np.dtype(
    [
        ("posture", "f8", (LIMBS, JOINTS)),
        ("target", "f8", (LIMBS, 3)),  # of the tip, base frame
        ("normal", "f8", (LIMBS, 3)),  # out of the surface, base frame
        ("turn", "f8", (LIMBS, JOINTS, 9)),  # T_base_link, row by row
        ("origin", "f8", (LIMBS, JOINTS + 1, 3)),  # of every frame and the tip, base frame
        # `origin` of a limb at the start of its lifted path and at all points of it that were solved, and how many there are
        ("way", "f8", (PATH_POINTS * PATH_PARTS + 1, JOINTS + 1, 3)),
        ("n_way", "i8"),
        # `origin` where limbs on their way leave, where they arrive, and between; the same in the world frame, and the base's corners there
        ("places", "f8", (3, LIMBS, JOINTS + 1, 3)),
        ("world", "f8", (3, LIMBS, JOINTS + 1, 3)),
        ("corners", "f8", (3, 8, 3)),
        ("least", "f8", (3,)),  # gap on their way: between limbs, of limbs and the base, of either and solids
        ("axis", "f8", (LIMBS, JOINTS, 3)),
        ("jacobian", "f8", (LIMBS, JOINTS, 3)),  # motion of the tip per joint
        ("tip_turn", "f8", (LIMBS, 9)),  # T_base_end, row by row
        ("load", "f8", (LIMBS, JOINTS)),  # generalised gravity of the limb's own links
        ("lever", "f8", (LIMBS, JOINTS, 6)),  # share of a joint's torque limit per component of its contact's wrench
        ("moments", "f8", (4,)),  # mass, first moment of mass, base frame
        ("gravity", "f8", (3,)),  # base frame
        ("wrench", "f8", (6,)),  # on the base, base frame
        ("frame", "f8", (LIMBS, 9)),
        ("friction", "f8", (LIMBS,)),  # effective, of limb and hold
        ("pull", "f8", (LIMBS,)),
        ("bears", "i8", (LIMBS,)),
        ("step", "f8", (JOINTS,)),
        ("normal_matrix", "f8", (5, 5)),
        ("task", "f8", (5,)),
        ("task_jacobian", "f8", (JOINTS, 5)),
        # The linear programme: max s with sum_k columns[k, i] z_k + s <= bound[i]
        ("balance", "f8", (6, UNKNOWNS + 1)),
        ("pivot", "i8", (6,)),  # unknown that a row of `balance` was solved for
        ("free", "i8", (UNKNOWNS,)),  # place of an unknown among the free ones, or -1 - row
        ("columns", "f8", (UNKNOWNS, PROGRAMME_ROWS)),
        ("bound", "f8", (PROGRAMME_ROWS,)),
        ("residual", "f8", (PROGRAMME_ROWS,)),
        ("inverse", "f8", (UNKNOWNS, UNKNOWNS)),  # of the basis, transposed
        ("dual", "f8", (UNKNOWNS,)),
        ("basis", "i8", (UNKNOWNS,)),
        ("point", "f8", (UNKNOWNS,)),  # of the lower bound
        ("price", "f8", (UNKNOWNS,)),
        ("entering", "f8", (UNKNOWNS,)),
        ("solution", "f8", (UNKNOWNS,)),
        ("gram", "f8", (6, 6)),  # of the equations, factored
        ("six", "f8", (6,)),
        ("full", "f8", (6,)),
    ],
    align=True,
)
"""Scratch of one thread."""


def robot_record(chains: Chains, contacts: Sequence[Contact]) -> Records:
    """A robot with the contact of each limb as an array of one record of `ROBOT`."""
    record = np.zeros(1, ROBOT)
    row = record[0]
    n = len(chains.limb_names)
    most = chains.lower.shape[1]
    assert n <= LIMBS and most <= JOINTS and len(contacts) == n
    row["n_limbs"] = n
    row["n_joints"][:n] = chains.n_joints
    for name in ("sliding", "lower", "upper", "torque", "nominal", "mass", "centre", "radius"):
        row[name][:n, :most] = getattr(chains, name)
    row["offset"][:n, : most + 1] = chains.offset
    row["rotation"][:n, : most + 1] = chains.rotation.reshape(n, most + 1, 9)
    for name in ("base_mass", "base_centre", "base_half", "total_mass"):
        row[name] = getattr(chains, name)
    row["size"] = max(stretched(chains, limb) for limb in range(n))
    row["limb_room"] = chains.limb_room
    thinnest = min(chains.radius[limb, BESIDE : chains.n_joints[limb]].min(initial=np.inf) for limb in range(n))
    row["fine"] = max(min(thinnest, row["size"]), FINEST * row["size"])
    for limb, contact in enumerate(contacts):
        rows = contact.rows
        row["farthest"][limb, : chains.n_joints[limb]] = farthest_tips(chains, limb)
        row["components"][limb] = contact.components
        row["aligned"][limb] = contact.aligned and chains.n_joints[limb] >= 5
        row["n_rows"][limb] = len(rows)
        row["row"][limb, : len(rows)] = [each.coefficients for each in rows]
        row["row_friction"][limb, : len(rows)] = [each.per_friction for each in rows]
        row["limit"][limb, : len(rows)] = [each.limit for each in rows]
        row["slack"][limb, : len(rows)] = [each.slack for each in rows]
        row["margin"][limb, : len(rows)] = [each.margin for each in rows]
        row["friction"][limb], row["pull"][limb] = contact.friction, contact.pull
        row["tilt"][limb], row["tilt_loss"][limb] = contact.tilt, contact.tilt_loss
    return record
