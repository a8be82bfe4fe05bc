"""What a watch of a robot in space works with, as kernels: readings side by side, and torques and forces that nothing explains."""

import math

from ....compiled import kernel, opened
from ....control.whole_body.programme import HOLDS
from ....control.whole_body.tree import FREE


@kernel
def gather(handle, touch, fresh):
    """The readings of a tick side by side.

    Args:
        handle: Holds what the sensors say, of which in a reading that is no newer the switches become those before; torques commanded
            since the reading before, shape (n,); what each limb does, shape (limbs,); the limb of each joint, shape (n,);
            `sensor_watch.Room`, filled; and what `unexplained` needs besides.
        touch: A tip that feels less touches nothing [N].
        fresh: Whether the reading is newer than those before.
    """
    sensed, torques, does, owner, room, _ = opened(handle)
    n = torques.size
    for k in range(n):
        room.values[k] = sensed.joints[0, k]
        room.speeds[k] = sensed.joints[1, k]
        room.commands[k] = torques[k]
        room.values[n + k] = sensed.torques[k]
        limb = owner[k]
        force = 0.0
        for a in range(3):
            force += sensed.wrenches[limb, a] ** 2
        room.free[k] = does[limb] != HOLDS and force < touch * touch
        if not room.free[k]:  # what it bears may take all of its torque, and then it stands still
            room.driven[k] = 0.0
    for a in range(3):
        room.values[2 * n + a] = sensed.gyro[a]
        room.values[2 * n + 3 + a] = sensed.accelerometer[a]
    at = 2 * n + 6
    for limb in range(does.size):
        for a in range(6):
            room.values[at + 6 * limb + a] = sensed.wrenches[limb, a]
        if fresh:
            room.closed[limb], room.shutting[limb] = sensed.closed[limb], sensed.shutting[limb]
        else:
            sensed.closed[limb], sensed.shutting[limb] = room.closed[limb], room.shutting[limb]
    for k in range(n, room.speeds.size):
        room.speeds[k] = 0.0


@kernel
def give_back(sensed, room):
    """What is believed of the readings of a tick, into them."""
    n = sensed.torques.size
    for k in range(n):
        sensed.joints[0, k], sensed.joints[1, k] = room.values[k], room.speeds[k]
        sensed.torques[k] = room.values[n + k]
    for a in range(3):
        sensed.gyro[a] = room.values[2 * n + a]
        sensed.accelerometer[a] = room.values[2 * n + 3 + a]
    at = 2 * n + 6
    for limb in range(sensed.closed.size):
        for a in range(6):
            sensed.wrenches[limb, a] = room.values[at + 6 * limb + a]


@kernel
def count_repeats(handle, units):
    """Looks on end at which each reading of a unit of three axes had repeated itself to the last bit while both others changed.

    Args:
        handle: As in `gather`; `before` and `repeats` of its `sensor_watch.Room` are changed.
        units: First reading of each unit, shape (units,).

    Returns:
        The reading that has done so for longest.
    """
    room, worst = opened(handle)[4], 0
    for unit in range(units.size):
        first = units[unit]
        for a in range(first, first + 3):
            alone = room.values[a] == room.before[a] and room.values[a] != 0.0
            for b in range(first, first + 3):
                alone = alone and (b == a or room.values[b] != room.before[b])
            room.repeats[a] = room.repeats[a] + 1 if alone else 0
            if room.repeats[a] > room.repeats[worst]:
                worst = a
    for c in range(room.values.size):
        room.before[c] = room.values[c]
    return worst


@kernel
def unexplained(handle, mass, share):
    """What the motors' torques are beyond the weights and the tips' wrenches, and the forces beyond the whole weight, smoothed.

    At rest tau = g - J^T w: a motor that gives less than it is told leaves the rest at its own joint, a wrench that is off leaves some at
    all joints of its limb.

    Args:
        handle: As in `gather`; besides it holds the robot's tree, its state and dynamics as believed, the motors' limits, and
            `sensor_watch.Rests`, changed.
        mass: Of the robot [kg].
        share: Of what is new in the smoothed values [-].

    Returns:
        How far the forces are off [N], and the joint whose torque is by the largest part of its limit.
    """
    sensed, torques, _, _, _, (tree, state, dynamics, limits, rests) = opened(handle)
    n, limbs = torques.size, sensed.closed.size
    rest, tips, push, gravity = rests.torques, rests.tips, rests.push, tree.gravity
    for b in range(3):
        felt = 0.0
        for a in range(3):
            felt += state.rotation[b, a] * sensed.accelerometer[a]
        push[b] += share * (mass * (felt + gravity[b]) - push[b])
        tips[b] += share * (mass * gravity[b] - tips[b])
    for k in range(n):
        rest[k] += share * (torques[k] - dynamics.weight[FREE + k] - rest[k])
    for limb in range(limbs):
        for part in range(2):
            for b in range(3):
                total = 0.0
                for a in range(3):
                    total += dynamics.tip_turn[limb, b, a] * sensed.wrenches[limb, 3 * part + a]
                if part == 0:
                    tips[b] += share * total
                for k in range(n):
                    rest[k] += share * dynamics.jacobian[limb, 3 * part + b, FREE + k] * total
    off, worst = 0.0, 0
    for b in range(3):
        off += (tips[b] - push[b]) ** 2
    for k in range(1, n):
        if abs(rest[k]) * limits[worst] > abs(rest[worst]) * limits[k]:
            worst = k
    return math.sqrt(off), worst


@kernel
def count_wandered(handle, holds, far):
    """How many pairs of tips on their holds have moved by more than `far` [m] against each other since both had come there, as believed.

    Args:
        handle: As in `unexplained`; `came` and `lay` of its `sensor_watch.Room` are changed.
        holds: Index of the hold that each limb is on, as believed; shape (limbs,).
        far: The distance.
    """
    does, room, tips = opened(handle)[2], opened(handle)[4], opened(handle)[5][2].tip
    count = 0
    for i in range(does.size):
        for k in range(i + 1, does.size):
            came, lay = room.came[i, k], room.lay[i, k]
            if does[i] != HOLDS or does[k] != HOLDS or holds[i] < 0 or holds[k] < 0:
                came[0] = -1  # a limb that is off its hold meanwhile may come to another place of it
                continue
            square = 0.0
            for a in range(3):
                between = tips[i, a] - tips[k, a]
                if came[0] != holds[i] or came[1] != holds[k]:
                    lay[a] = between
                square += (between - lay[a]) ** 2
            came[0], came[1] = holds[i], holds[k]
            count += math.sqrt(square) > far
    return count
