"""Joint trajectories and contact sequences of plans of robots in space."""

from typing import Final

import numpy as np

from ...exports.joint_trajectory import BODY, JointTrajectory, Trajectories, resting
from ...planning.problem.problem import Replay
from ...types import Floats, Ints, Json
from .planning.task import SpatialTask
from .robot.kinematics import Posed, centre_of_mass, joint_torques, link_frames, posed, quaternions

SECONDS: Final = 1.0
"""Between two stances of a plan, whose model has no time [s]."""
SCHEMA: Final = "clamber-contacts-1"
FRAMES: Final = (
    "SI units, world frame; orientations are quaternions w, x, y, z of the base; wrenches are those on the robot, "
    "moments about the tip"
)
"""What the numbers are, in the file itself."""


def spatial_stances(task: SpatialTask, replay: Replay) -> JointTrajectory:
    """Joints of the limbs; efforts are the torques that hold each stance."""
    chains = task.robot.chains
    at = posed(chains, replay.stances)
    wrenches = np.array(replay.stances["wrench"][:, : len(chains.limb_names)])
    torques = joint_torques(chains, link_frames(chains, at), wrenches, np.array(task.world.gravity))
    used = chains.used
    names = tuple(name for limb in chains.joint_names for name in limb)
    sliding = tuple(bool(slides) for slides in chains.sliding[used])
    time = SECONDS * np.arange(len(replay.stances), dtype=np.float64)
    return resting(names, sliding, time, at.q[:, used], torques[:, used])


def contact_sequence(task: SpatialTask, replay: Replay) -> Json:
    """Stances and contacts of a plan.

    A limb that takes another hold at step k leaves the old one after stance k - 1 and is on the new one in stance k; in between it
    swings over `lift` metres.
    """
    chains = task.robot.chains
    world = task.world
    body = posed(chains, replay.stances)
    centres = centre_of_mass(chains, body, link_frames(chains, body))
    held = np.array(replay.stances["hold"][:, : len(chains.limb_names)])
    wrenches = np.array(replay.stances["wrench"][:, : len(chains.limb_names)])
    return {
        "schema": SCHEMA,
        "frames": FRAMES,
        "task": task.name,
        "robot": task.robot.name,
        "world": world.name,
        "mass": chains.total_mass,
        "gravity": list(world.gravity),
        "lift": task.rules.lift,
        "limbs": [
            {"name": name, "joints": list(joints)}
            for name, joints in zip(chains.limb_names, chains.joint_names, strict=True)
        ],
        "stances": [
            _stance(task, Posed(body.place[k], body.turn[k], body.q[k]), centres[k], held[k], wrenches[k])
            for k in range(len(held))
        ],
        "contacts": _intervals(task, held),
    }


def _stance(task: SpatialTask, at: Posed, centre: Floats, held: Ints, wrenches: Floats) -> Json:
    chains = task.robot.chains
    return {
        "position": at.place.tolist(),
        "orientation": quaternions(at.turn).tolist(),
        "centre_of_mass": centre.tolist(),
        "joints": {
            name: float(at.q[limb, k]) for limb, names in enumerate(chains.joint_names) for k, name in enumerate(names)
        },
        "contacts": {
            name: {"hold": int(held[limb]) + 1, "wrench": wrenches[limb].tolist()}
            for limb, name in enumerate(chains.limb_names)
        },
    }


def _intervals(task: SpatialTask, held: Ints) -> list[Json]:
    """When each limb is on each of its holds, by numbers of stances, both with them."""
    found: list[Json] = []
    normals = task.world.normals
    for limb, name in enumerate(task.robot.chains.limb_names):
        changes = np.flatnonzero(np.diff(held[:, limb])) + 1
        for first, last in zip((0, *changes), (*(changes - 1), len(held) - 1), strict=True):
            index = int(held[first, limb])
            hold = task.world.holds[index]
            found.append(
                {
                    "limb": name,
                    "hold": hold.number,
                    "first_stance": int(first),
                    "last_stance": int(last),
                    "place": list(hold.at),
                    "normal": normals[index].tolist(),
                }
            )
    return sorted(found, key=lambda interval: (interval["first_stance"], interval["last_stance"]))


TRAJECTORIES: Final = Trajectories(spatial_stances, BODY.note, BODY.run, contact_sequence)
