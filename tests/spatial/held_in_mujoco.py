"""Whether a stance stays in MuJoCo: the robot's own model file on breakable contacts, with the torques that statics found.

Nothing of the statics is asked but the stance, its posture and the wrenches that it chose. Kinematics, weights and motion are MuJoCo's;
a contact lets go as soon as the force in it leaves the exact body of its kind, worked out here from the numbers of the data sheet, not
the polytope inscribed in it. Run as a script it holds many stances: `python tests/spatial/held_in_mujoco.py --stances 2000`.
"""

import argparse
import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from scipy.optimize import nnls

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from clamber.families.spatial.robot.contact_kinds import (
    AreaFoot,
    Clamp,
    ContactKind,
    Hook,
    Spine,
    build_contact,
    read_contact,
)
from clamber.families.spatial.robot.robot import SpatialRobot
from clamber.families.spatial.statics.judging import Statics
from clamber.tasks.robots import load_robot
from clamber.types import Floats
from spatial_machines import random_stances

SECONDS = 2.0
STEP = 0.002
STIFFNESS = 5.0
"""Of the joints, in torque limits per radian: a limit's worth of torque for 11 deg."""
DAMPING = 0.2
"""In torque limits times a second per radian: what is overloaded by 2 % sags by 0.1 rad/s."""
ROTOR = 0.002
"""Inertia behind each gear, in torque limits times a second squared per radian: with it springs are damped critically. MuJoCo finds
constraint forces by masses alone; damping that takes more of a step than inertia does would make contacts soft."""
SETTLED = 0.1
"""Contacts do not let go before [s]: a stiff spring stands for each, which has no force yet when a stance is set up."""
MOVED = 0.01
"""Motion of the base that counts as not held, per size of the robot."""
NEAR = 0.02
"""Stances so near a limit are not asked about: their verdict may fall either way."""
INSIDE = 1e-9


@dataclass(frozen=True)
class Machine:
    """A shipped robot with a contact, and how strong holds are, in shares of its weight."""

    robot: str
    contact: str
    strength: tuple[float, float] = (0.05, 0.6)


MACHINES = {
    "gripper climber": Machine("gripper-climber", "gripper", (0.02, 0.25)),
    "quadruped": Machine("quadruped", "foot"),
    "hexapod": Machine("hexapod", "foot"),
    "magnet quadruped": Machine("magnet-quadruped", "magnet", (0.02, 0.3)),
    "cups": Machine("magnet-quadruped", "suction", (0.02, 0.3)),
    "spines": Machine("gripper-climber", "spine"),
    "clamp triped": Machine("clamp-triped", "clamp", (0.2, 2.0)),
    "flat feet": Machine("clamp-triped", "area"),
    "inchworm": Machine("inchworm", "clamp", (0.5, 4.0)),
    "hooks": Machine("gripper-climber", "hook", (0.2, 3.0)),
}


def exact_body(kind: ContactKind) -> Callable[[Floats, float, float], bool]:
    """Whether a kind bears a wrench (normal, two tangents: force, then moment) at some friction and pull, by its data sheet."""

    def cone(w: Floats, mu: float, pull: float) -> bool:
        return bool(w[0] >= -pull - INSIDE and math.hypot(w[1], w[2]) <= mu * (w[0] + pull) + INSIDE)

    if isinstance(kind, Clamp):
        clamp = kind
        return lambda w, mu, pull: (
            cone(w, mu, pull)
            and bool(w[0] <= clamp.press and abs(w[3]) <= clamp.twisting and math.hypot(w[4], w[5]) <= clamp.bending)
        )
    if isinstance(kind, Hook):
        side = math.tan(kind.opening)
        return lambda w, mu, pull: bool(
            abs(w[1]) <= mu * w[0] and abs(w[2]) <= side * w[0] and np.linalg.norm(w[:3]) <= pull
        )
    if isinstance(kind, Spine):
        hold = math.tan(kind.angle)

        def spines(w: Floats, mu: float, pull: float) -> bool:
            if w[1] <= 0.0:
                return cone(w, mu, 0.0)
            return bool(w[0] >= -hold * w[1] and w[1] <= pull and abs(w[2]) <= mu * (w[0] + hold * w[1]))

        return spines
    if isinstance(kind, AreaFoot) and not kind.ankle:
        turns = np.linspace(0.0, math.tau, 65)[:-1]
        corners = [(x * kind.length / 2, y * kind.width / 2) for x in (1, -1) for y in (1, -1)]

        def sole(w: Floats, mu: float, pull: float) -> bool:
            """Single forces at the corners, each within its cone, make every pressure and friction on the rectangle."""
            rays = np.array(
                [
                    (1.0, a := mu * math.cos(t), b := mu * math.sin(t), x * b - y * a, y, -x)
                    for x, y in corners
                    for t in turns
                ]
            ).T
            rays[3:] /= kind.length
            wanted = w / [1, 1, 1, kind.length, kind.length, kind.length]
            return bool(nnls(rays, wanted)[1] <= 1e-6 * max(1.0, float(np.linalg.norm(wanted))))

        return sole
    return cone


@dataclass
class Held:
    """What became of a stance."""

    stayed: bool
    why: str = ""


class Bench:
    """A robot's own model on equality constraints that stand for its contacts."""

    def __init__(self, robot: SpatialRobot, kind: ContactKind) -> None:
        assert robot.model_path is not None
        spec: Any = mujoco.MjSpec.from_file(str(robot.model_path))
        for geom in spec.geoms:
            geom.contype = geom.conaffinity = 0
        contact = kind.contact()
        self.full = contact.components == 6
        for limb in robot.limbs:
            equality = spec.add_equality()
            equality.type = mujoco.mjtEq.mjEQ_WELD if self.full else mujoco.mjtEq.mjEQ_CONNECT
            equality.objtype = mujoco.mjtObj.mjOBJ_BODY
            equality.name1 = spec.site(limb.tip).parent.name
            equality.solref, equality.solimp = (2.5 * STEP, 1.0), (0.9999, 0.9999, 0.001, 0.5, 2.0)
        self.model: Any = spec.compile()
        self.data: Any = mujoco.MjData(self.model)
        model = self.model
        model.opt.timestep, model.opt.integrator = STEP, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        self.bears_wrench, self.contact, self.robot = exact_body(kind), contact, robot
        chains = robot.chains
        self.sites = [model.site(limb.tip).id for limb in robot.limbs]
        self.bodies = [int(model.site_bodyid[site]) for site in self.sites]
        self.positions = [[int(model.joint(name).qposadr[0]) for name in names] for names in chains.joint_names]
        self.dofs = [[int(model.joint(name).dofadr[0]) for name in names] for names in chains.joint_names]
        self.limits = np.zeros(model.nv)
        for limb, dofs in enumerate(self.dofs):
            self.limits[dofs] = chains.torque[limb, : len(dofs)]
        model.dof_damping[6:], model.dof_armature[6:] = DAMPING * self.limits[6:], ROTOR * self.limits[6:]
        self.size = float(sum(np.linalg.norm(chains.offset[0, k]) for k in range(1, int(chains.n_joints[0]) + 1)))

    def place(self, body: np.void, contacts: Any, posture: Floats) -> None:
        """Set a stance up and tie the tips that bear to where they are."""
        model, data = self.model, self.data
        mujoco.mj_resetData(model, data)
        model.opt.gravity[:] = body["gravity"]
        data.qpos[:3] = body["place"]
        mujoco.mju_mat2Quat(data.qpos[3:7], np.ascontiguousarray(body["rotation"]))
        for limb, places in enumerate(self.positions):
            data.qpos[places] = posture[limb, : len(places)]
        mujoco.mj_forward(model, data)
        for limb, (site, link) in enumerate(zip(self.sites, self.bodies, strict=True)):
            tip = data.site_xpos[site].copy()
            assert np.linalg.norm(tip - contacts["place"][limb]) < 2e-4 * self.size, "MuJoCo has the tip elsewhere"
            within = data.xmat[link].reshape(3, 3).T @ (tip - data.xpos[link])
            row = model.eq_data[limb]
            if self.full:
                row[:3], row[3:6], row[6:10] = tip, within, data.xquat[link] * [1, -1, -1, -1]
                row[10] = 1.0
            else:
                row[:3], row[3:6] = within, tip
            data.eq_active[limb] = contacts["bears"][limb]

    def axes(self, limb: int, normal: Floats) -> Floats:
        """Normal and tangents of a contact, the first along the end effector's x, as rows."""
        end = self.data.site_xmat[self.sites[limb]].reshape(3, 3)
        ahead = end[:, 0] if abs(end[:, 0] @ normal) <= 0.9 else end[:, 1]
        ahead = ahead - (ahead @ normal) * normal
        ahead = ahead / np.linalg.norm(ahead)
        return np.array([normal, ahead, np.cross(normal, ahead)])

    def torques(self, wrenches: Floats) -> Floats:
        """Joint torques that bear the weight where contacts push with some wrenches (world frame, about the tips), shape (nv,)."""
        model, data = self.model, self.data
        taken = np.zeros(model.nv)
        moving, turning = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        for site, wrench in zip(self.sites, wrenches, strict=True):
            mujoco.mj_jacSite(model, data, moving, turning, site)
            taken += moving.T @ wrench[:3] + turning.T @ wrench[3:]
        made: Floats = data.qfrc_bias - taken
        return made

    def hold(self, body: np.void, contacts: Any, judged: np.void) -> Held:
        """Hold a judged stance for `SECONDS`."""
        model, data = self.model, self.data
        self.place(body, contacts, judged["posture"])
        turn = body["rotation"].reshape(3, 3)
        bearing = [limb for limb in range(len(self.sites)) if contacts["bears"][limb]]
        axes = [self.axes(limb, contacts["normal"][limb]) for limb in range(len(self.sites))]
        wrenches = np.zeros((len(self.sites), 6))
        for limb in bearing:
            frame = judged["frame"][limb].reshape(3, 3) @ turn.T
            wrenches[limb, :3] = judged["wrench"][limb, :3] @ frame
            wrenches[limb, 3:] = judged["wrench"][limb, 3:] @ frame
        feed = self.torques(wrenches)
        weight = float(model.body_mass.sum() * np.linalg.norm(body["gravity"]))
        balanced = float(np.abs(feed[:6]).max())
        assert judged["s"] < -0.9 or balanced < 1e-4 * weight * max(1.0, self.size), (
            f"MuJoCo's weight is off by {balanced} N"
        )
        feed[:6] = 0.0
        start, spring = data.qpos.copy(), STIFFNESS * self.limits
        tied = [(limb, self.bodies[limb], self.sites[limb]) for limb in bearing]
        mu = np.minimum(self.contact.friction, contacts["friction"])
        pull = np.minimum(self.contact.pull, contacts["strength"])
        for step in range(round(SECONDS / STEP)):
            torque = feed[6:] + spring[6:] * (start[7:] - data.qpos[7:])
            data.qfrc_applied[6:] = np.clip(torque, -self.limits[6:], self.limits[6:])
            mujoco.mj_step(model, data)
            if step * STEP < SETTLED:
                continue
            mujoco.mj_rnePostConstraint(model, data)
            centre = data.subtree_com[int(model.body_rootid[self.bodies[0]])]
            for limb, link, site in tied:
                felt = data.cfrc_ext[link]
                moment = felt[:3] + np.cross(centre - data.site_xpos[site], felt[3:])
                wrench = np.concatenate((axes[limb] @ felt[3:], axes[limb] @ moment))
                if not self.bears_wrench(wrench, float(mu[limb]), float(pull[limb])):
                    return Held(False, f"{self.robot.limb_names[limb]} lets go")
            moved = float(np.linalg.norm(data.qpos[:3] - start[:3]))
            if not moved < MOVED * self.size:
                return Held(False, "moves")
        return Held(True)


@dataclass(frozen=True)
class Tally:
    """How verdicts and holds of a machine agree."""

    asked: int
    stood: int
    """Of statics' verdicts."""
    wrong: tuple[tuple[float, str], ...]
    """Share that is left of all limits, and what became of the stance."""


def tally(machine: Machine, n: int, seed: int = 11) -> Tally:
    """Hold `n` random stances of a machine that lie outside `NEAR` of every limit."""
    loaded: Any = load_robot(machine.robot)
    robot: SpatialRobot = loaded
    kind = build_contact(read_contact(machine.contact))
    statics, bench = Statics(robot.chains, [kind.contact()] * len(robot.limbs)), Bench(robot, kind)
    rng = np.random.default_rng(seed)
    asked, stood, wrong = 0, 0, []
    while asked < n:
        bodies, contacts = random_stances(statics, robot.chains, 64, rng)
        contacts["friction"] = rng.uniform(0.3, 1.0, contacts.shape)
        contacts["strength"] = rng.uniform(*machine.strength, contacts.shape) * 9.81 * robot.chains.total_mass
        contacts["bears"] = rng.uniform(size=contacts.shape) < 0.9
        judged, _ = statics.judge(bodies, contacts)
        for body, where, found in zip(bodies, contacts, judged, strict=True):
            if (
                asked == n
                or not found["judged"]
                or abs(found["s"]) < NEAR
                or not np.isfinite(found["s"])
                or found["s"] < -0.9
            ):
                continue
            asked += 1
            stood += found["s"] > 0.0
            held = bench.hold(body, where, found)
            if held.stayed != (found["s"] > 0.0):
                wrong.append((float(found["s"]), held.why or "stays"))
    return Tally(asked, int(stood), tuple(wrong))


def main() -> None:
    """Hold many stances of every machine and print how often statics and MuJoCo agree."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--stances", type=int, default=2000, help="of all machines together")
    parser.add_argument("--seed", type=int, default=11)
    parser.add_argument("machines", nargs="*", default=list(MACHINES))
    asked = parser.parse_args()
    total, wrong = 0, 0
    for name in asked.machines:
        made = tally(MACHINES[name], asked.stances // len(asked.machines), asked.seed)
        total, wrong = total + made.asked, wrong + len(made.wrong)
        told = "".join(f"; s {s:+.3f}: {why}" for s, why in made.wrong)
        print(f"{name}: {made.asked - len(made.wrong)} of {made.asked} agree, {made.stood} stand{told}", flush=True)
    print(f"all: {total - wrong} of {total} agree, {100.0 * (total - wrong) / total:.2f} %")


if __name__ == "__main__":
    main()
