"""What limbs weigh: the torques that their links' own weight takes, and the robot's mass and centre."""

from ....compiled import kernel


@kernel
def limb_weight(robot, limb, work):
    """Generalised gravity of each joint of a limb (`load`), its mass added to `moments`; after `limb_frames`, gravity in the base frame.

    A motor holds the limb still with the torque `-load`, less what its contact does.
    """
    mass, mx, my, mz = 0.0, 0.0, 0.0, 0.0
    gx, gy, gz = work.gravity[0], work.gravity[1], work.gravity[2]
    turn = work.turn[limb]
    origin = work.origin[limb]
    axis = work.axis[limb]
    centre = robot.centre[limb]
    for k in range(robot.n_joints[limb] - 1, -1, -1):
        m = robot.mass[limb, k]
        cx, cy, cz = centre[k, 0], centre[k, 1], centre[k, 2]
        link = turn[k]
        mass += m
        mx += m * (origin[k, 0] + link[0] * cx + link[1] * cy + link[2] * cz)
        my += m * (origin[k, 1] + link[3] * cx + link[4] * cy + link[5] * cz)
        mz += m * (origin[k, 2] + link[6] * cx + link[7] * cy + link[8] * cz)
        a, b, c = axis[k, 0], axis[k, 1], axis[k, 2]
        if robot.sliding[limb, k] == 0:
            rx, ry, rz = mx - mass * origin[k, 0], my - mass * origin[k, 1], mz - mass * origin[k, 2]
            work.load[limb, k] = (b * rz - c * ry) * gx + (c * rx - a * rz) * gy + (a * ry - b * rx) * gz
        else:
            work.load[limb, k] = mass * (a * gx + b * gy + c * gz)
    work.moments[0] += mass
    work.moments[1] += mx
    work.moments[2] += my
    work.moments[3] += mz


@kernel
def base_weight(robot, work):
    """Begin `moments` with the base's mass."""
    work.moments[0] = robot.base_mass
    for a in range(3):
        work.moments[1 + a] = robot.base_mass * robot.base_centre[a]
