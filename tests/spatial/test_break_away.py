"""Each kind of end effector holds without creep, and comes off at the strength of its data sheet, pushed, pulled and turned every way."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from clamber.families.spatial.execution.plant import Pose
from clamber.families.spatial.robot.contact_kinds import DATA
from clamber.families.spatial.robot.robot import build_robot
from clamber.families.spatial.sim.spatial_flaws import SpatialFlaws
from clamber.families.spatial.sim.spatial_model import TIP
from clamber.families.spatial.sim.spatial_plant import SpatialSim
from clamber.families.spatial.world.world import build_world
from clamber.files import Document, read_toml
from clamber.types import Floats

RIG = """<mujoco><worldbody><body name="base"><freejoint/><inertial pos="0 0 0" mass="10" diaginertia="1 1 1"/>
<body name="end"><joint name="turn" axis="0 0 1" range="-90 90" actuatorfrcrange="-9999 9999"/>
<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><geom size="1" mass="0"/><site name="tip" xyaxes="1 0 0 0 -1 0"/></body>
</body></worldbody></mujoco>"""
"""A weight whose centre is the tip of its one limb, which points down: what pushes it pushes the tip, without a lever."""
STIFF, DAMPED = 4000.0, 100.0
SETTLE, CREEP_OVER, RAMP = 0.5, 1.0, 4.0
"""Seconds in which the load comes, creep is measured, and the load grows from 90 to 110 %."""


def rig(folder: Path, contact: dict[str, Any], **hold: Any) -> SpatialSim:
    (folder / "rig.xml").write_text(RIG)
    limb = {"name": "one", "tip": "tip", "contact": contact}
    data = {"schema": "clamber-robot-1", "family": "spatial", "name": "rig", "title": "", "model": "rig.xml"}
    robot = build_robot(Document("rig", data | {"base": "base", "limb": [limb]}, folder=folder))
    up = [0, 0, 1]
    place = {"number": 1, "at": ["0 m"] * 3, "normal": up, **hold}
    guide = [{"at": ["0 m"] * 3, "normal": up}, {"at": ["1 m", "0 m", "0 m"]}]
    world = {"schema": "clamber-world-1", "name": "rig", "gravity": "none", "holds": [place], "guide": guide}
    plant = SpatialSim(robot, build_world(Document("world", world)), SpatialFlaws())
    plant.reset(Pose(np.eye(3), np.zeros(3)), np.zeros(1), [0])
    return plant


def load(plant: SpatialSim, seconds: float, start: Floats, end: Floats) -> Floats:
    """Put wrenches of the surface on the tip, from one evenly to another; the last one before it came off."""
    ticks = round(seconds / plant.period)
    wrench = start
    for tick in range(ticks):
        wrench = start + (end - start) * (tick + 1) / ticks
        angle, speed = plant.sense().joints
        plant.actuate(-STIFF * angle - DAMPED * speed)
        plant.push(-wrench)
        plant.step()
        if plant.truth().attached[0] < 0:
            break
    return wrench


def shipped(kind: str, **changed: Any) -> dict[str, Any]:
    return read_toml(DATA / f"{kind}.toml", kind).data | changed


STEEL = 400.0 / (1 + 0.1 / 0.6) ** 2
CUP = 60e3 * math.pi / 4 * 0.06**2 / 2
FACE, LIP = 0.025 * math.sqrt(0.5), 0.03 * math.sqrt(0.5)
SLOPE = math.tan(math.radians(20.0))
CASES = {  # contact; n, first and second tangent, moments that stay; direction of what grows; at how much it gives way
    "gripper pulled": (shipped("gripper"), [], [-1, 0, 0], 25.0),
    "gripper sheared": (shipped("gripper"), [], [0, 0.6, 0.8], 0.8 * 25),
    "gripper pressed and sheared": (shipped("gripper"), [30, 0, 0], [0, 0, 1], 0.8 * 55),
    "clamp pulled": (shipped("clamp"), [], [-1, 0, 0], 2000.0),
    "clamp pressed": (shipped("clamp"), [], [1, 0, 0], 4000.0),
    "clamp sheared": (shipped("clamp"), [], [0, 1, 0], 0.3 * 2000),
    "clamp bent": (shipped("clamp"), [], [0, 0, 0, 0, 0.6, 0.8], 200.0),
    "clamp twisted": (shipped("clamp"), [], [0, 0, 0, 1, 0, 0], 60.0),
    "hook loaded": (shipped("hook"), [], [1, 0, 0], 120.0),
    "hook drawn along its bar": (shipped("hook"), [100, 0, 0], [0, 1, 0], 20.0),
    "hook drawn out of its bed": (shipped("hook"), [50, 0, 0], [0, 0, 1], 50 * math.tan(math.radians(50.0))),
    "magnet pulled": (shipped("magnet"), [], [-1, 0, 0], STEEL),
    "magnet sheared": (shipped("magnet"), [], [0, 1, 0], 0.5 * STEEL),
    "magnet peeled": (shipped("magnet", ankle=False), [], [0, 0, 0, 0, 1, 0], FACE * STEEL),
    "magnet twisted": (shipped("magnet", ankle=False), [], [0, 0, 0, 1, 0, 0], 0.5 * 0.025 * STEEL),
    "cup pulled": (shipped("suction"), [], [-1, 0, 0], CUP),
    "cup sheared": (shipped("suction"), [], [0, 0, -1], 0.5 * CUP),
    "cup peeled": (shipped("suction", ankle=False), [], [0, 0, 0, 0, 0, 1], LIP * CUP),
    "spines drawn": (shipped("spine"), [], [0, 1, 0], 10.0),
    "spines drawn and pulled": (shipped("spine"), [0, 5, 0], [-1, 0, 0], 5 * SLOPE),
    "spines drawn aside": (shipped("spine"), [0, 5, 0], [0, 0, 1], 0.3 * 5 * SLOPE),
}


@pytest.mark.parametrize("case", CASES)
def test_an_end_effector_does_not_creep_and_gives_way_at_its_data_sheet(case: str, tmp_path: Path) -> None:
    """At 80 % of its strength it moves by at most 1 um/s; it comes off within 1 % of it."""
    contact, kept, grows, strength = CASES[case]
    plant = rig(tmp_path, contact)
    base, way = np.zeros(6), np.zeros(6)
    base[: len(kept)], way[: len(grows)] = np.array(kept), np.array(grows, float)
    # of the contact's frame (normal, then x and y) in the world
    base, way = (row.reshape(2, 3)[:, [1, 2, 0]].ravel() for row in (base, way))
    load(plant, SETTLE, 0 * base, base + 0.8 * strength * way)
    load(plant, SETTLE, base + 0.8 * strength * way, base + 0.8 * strength * way)
    before = plant.truth().tips[0]
    load(plant, CREEP_OVER, base + 0.8 * strength * way, base + 0.8 * strength * way)
    creep = np.linalg.norm(plant.truth().tips[0] - before) / CREEP_OVER
    assert creep <= 1e-6
    load(plant, SETTLE, base + 0.8 * strength * way, base + 0.9 * strength * way)
    last = load(plant, RAMP, base + 0.9 * strength * way, base + 1.1 * strength * way)
    assert plant.truth().attached[0] < 0
    assert float((last - base) @ way) / float(way @ way) == pytest.approx(strength, rel=0.01)


@pytest.mark.parametrize("kind", ["foot", "area"])
def test_a_foot_does_not_creep_and_slips_at_its_friction(kind: str, tmp_path: Path) -> None:
    """At 80 % of what friction bears it moves by at most 1 um/s; it slides within 1 % of it. The tip lies `TIP` above what it touches."""
    contact, normal = shipped(kind), 100.0
    plant = rig(tmp_path, contact)
    press = np.array([0.0, 0.0, normal, 0.0, 0.0, 0.0])
    most = contact["friction"]["value"] * normal * np.array([0.6, 0.8, 0.0, 0.8 * TIP, -0.6 * TIP, 0.0])
    load(plant, SETTLE, 0.0 * press, press)
    load(plant, SETTLE, press, press + 0.8 * most)
    load(plant, SETTLE, press + 0.8 * most, press + 0.8 * most)
    before = plant.truth().tips[0]
    load(plant, CREEP_OVER, press + 0.8 * most, press + 0.8 * most)
    assert np.linalg.norm(plant.truth().tips[0] - before) / CREEP_OVER <= 1e-6
    load(plant, SETTLE, press + 0.8 * most, press + 0.99 * most)
    before = plant.truth().tips[0]
    load(plant, SETTLE, press + 0.99 * most, press + 0.99 * most)
    assert np.linalg.norm(plant.truth().tips[0] - before) / SETTLE <= 1e-5
    load(plant, SETTLE, press + 0.99 * most, press + 1.01 * most)
    load(plant, SETTLE, press + 1.01 * most, press + 1.01 * most)
    assert np.linalg.norm(plant.truth().tips[0] - before) / SETTLE >= 1e-4


@pytest.mark.parametrize(
    ("kind", "drawn"), [("gripper", (1.0, 1.0)), ("clamp", (1.0, 1.0)), ("hook", (0.0, 1.0)), ("magnet", (0.0, 0.0))]
)
def test_what_encloses_draws_its_tip_to_its_hold(kind: str, drawn: tuple[float, float], tmp_path: Path) -> None:
    """Jaws come to the hold's own place and tell so once they have shut, hooks across their bars alone, magnets stay where they are."""
    plant = rig(tmp_path, shipped(kind), radius="5 mm")
    beside = np.array((0.006, 0.004, 0.0))
    plant.reset(Pose(np.eye(3), beside), np.zeros(1), [-1])
    plant.grip(0, True)
    for _ in range(round(1.0 / plant.period)):
        angle, speed = plant.sense().joints
        plant.actuate(-STIFF * angle - DAMPED * speed)
        plant.step()
        if plant.sense().closed[0]:
            break
    assert plant.truth().attached[0] == 0
    for _ in range(40):
        plant.step()
    assert plant.truth().tips[0, :2] == pytest.approx(beside[:2] * (1.0 - np.array(drawn)), abs=2e-4)
    assert not plant.truth().broken
