"""Models that tests import, as small as what they show allows."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from clamber.families.spatial.robot.robot import SpatialRobot, build_robot
from clamber.files import Document


@dataclass(frozen=True)
class Case:
    """A model file's name and text, and the robot file that goes with it."""

    file: str
    text: str
    robot: dict[str, Any] = field(default_factory=dict)


def document_of(folder: Path, case: Case, **changed: Any) -> Document:
    """The robot's document, its model beside it."""
    (folder / case.file).write_text(case.text, encoding="utf-8")
    data = {"schema": "clamber-robot-1", "family": "spatial", "name": "tested", "title": "Tested", "model": case.file}
    return Document("robot.toml", data | case.robot | changed, (), folder)


def robot_of(folder: Path, case: Case, base: str | None = None) -> SpatialRobot:
    """The robot of a case, with another base if it is named."""
    return build_robot(document_of(folder, case, **({} if base is None else {"base": base})))


FOUR_JOINTS = Case(
    "four.xml",
    """<mujoco model="four"><compiler angle="radian"/><option gravity="0 0 -9"/>
<default><joint limited="true" range="-1 1.2" actuatorfrcrange="-5 5"/><geom contype="1"/></default>
<worldbody><geom type="plane" size="1 1 0.1"/>
<body name="pelvis" pos="0.1 0.2 1" euler="0.3 -0.2 0.5"><freejoint/>
  <geom type="box" size=".1 .15 .05" mass="2" pos="0.01 0 0.02"/>
  <body name="waist" pos="0 0 0.1"><joint name="waist" axis="0 0 1"/><geom type="sphere" size=".05" mass="0.7" pos="0 .02 .03"/>
    <body name="ball" pos="0.05 0.1 0.05" euler="0.1 0.2 0.3">
      <joint name="a1" axis="1 0 0"/><joint name="a2" axis="0 1 0.2" pos="0 0.01 0"/>
      <geom type="capsule" fromto="0 0 0 0.2 0 0" size=".02" mass="0.4"/>
      <body name="slide" pos="0.2 0 0"><joint name="a3" type="slide" axis="1 0 0.1" range="0.01 0.1" ref="0.03"/>
        <geom type="capsule" fromto="0 0 0 0.1 0 0" size=".015" mass="0.2"/><site name="hand" pos="0.1 0.01 0" euler="0.4 0 0"/></body>
    </body>
    <body name="arm" pos="0.05 -0.1 0.05"><joint name="b1" axis="0 1 1" ref="0.3"/>
      <geom type="capsule" fromto="0 0 0 0.2 0 0" size=".02" mass="0.4"/>
      <body name="arm2" pos="0.2 0 0"><joint name="b2" axis="0 1 0"/><joint name="b3" axis="0 0 1"/>
      <geom type="capsule" fromto="0 0 0 0.2 0 0" size=".02" mass="0.3"/><site name="fist" pos="0.2 0 0"/></body></body>
  </body>
  <body name="leg" pos="0 0 -0.1"><joint name="c1" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0 0 -0.2" size=".02" mass="0.6"/>
    <site name="foot" pos="0 0 -0.2"/></body>
</body></worldbody></mujoco>""",
    {
        "base": "pelvis",
        "trunk": {"waist": "0.4 rad"},
        "limb": [
            {"name": "left", "tip": "hand", "contact": "gripper"},
            {"name": "right", "tip": "fist", "contact": "gripper"},
            {"name": "leg", "tip": "foot", "contact": "foot"},
        ],
    },
)
"""Two joints on one link, a slide, references, a waist that two limbs share, limbs of three and one joints, a turned base."""

LOOP = Case(
    "loop.xml",
    """<mujoco model="loop"><compiler angle="radian" autolimits="true"/>
<default><joint axis="0 1 0" range="-1 1" actuatorfrcrange="-5 5"/></default>
<worldbody><body name="base"><freejoint/><geom type="box" size=".1 .1 .1" mass="1"/>
  <body name="l1" pos="0.1 0 0"><joint name="l1"/><geom type="capsule" fromto="0 0 0 0 0 -.2" size=".01" mass=".1"/>
    <body name="l2" pos="0 0 -0.2"><joint name="l2"/><geom type="capsule" fromto="0 0 0 .1 0 -.2" size=".01" mass=".1"/>
      <site name="foot" pos="0.1 0 -0.2"/></body></body>
  <body name="r1" pos="0.2 0 0"><joint name="r1"/><geom type="capsule" fromto="0 0 0 0 0 -.2" size=".01" mass=".1"/>
    <body name="r2" pos="0 0 -0.2"><joint name="r2"/><geom type="capsule" fromto="0 0 0 0 0 -.2" size=".01" mass=".1"/>
      <site name="end" pos="0 0 -0.2"/></body></body>
</body></worldbody>
<equality><connect name="five-bar" site1="foot" site2="end"/></equality></mujoco>""",
    {
        "base": "base",
        "limb": [{"name": "leg", "tip": "foot", "contact": "foot"}, {"name": "rod", "tip": "end", "contact": "foot"}],
    },
)


def _link(name: str, mass: float, rest: str = "") -> str:
    terms = {"ixx": 0.002, "iyy": 0.004, "izz": 0.003, "ixy": 0.0002, "ixz": 0.0004, "iyz": 0.0001}
    inertia = " ".join(f'{key}="{value * mass}"' for key, value in terms.items())
    origin = '<origin xyz="0.03 -0.02 0.1" rpy="0.3 0.2 0.1"/>'
    return f'<link name="{name}"><inertial>{origin}<mass value="{mass}"/><inertia {inertia}/></inertial>{rest}</link>'


def _joint(name: str, kind: str, parent: str, child: str, xyz: str, axis: str = "0 1 0", rest: str = "") -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin xyz="{xyz}" rpy="0.2 -0.1 0.4"/>'
        f'<axis xyz="{axis}"/><limit lower="-0.9" upper="1.1" effort="7" velocity="2"/>{rest}</joint>'
    )


_MESH = '<collision><geometry><mesh filename="package://nowhere/{}.{}"/></geometry></collision>'
TWO_ARMS = Case(
    "arms.urdf",
    "<robot name='arms'>"
    + "".join(
        _link(name, mass, _MESH.format(name, "stl" if mass < 1 else "dae"))
        for name, mass in (
            ("pelvis", 3.0),
            ("chest", 2.0),
            ("l1", 0.5),
            ("l2", 0.4),
            ("lf", 0.05),
            ("r1", 0.5),
            ("r2", 0.4),
            ("g", 1.1),
            ("g2", 0.2),
        )
    )
    + '<link name="lhand"/><link name="rhand"/><link name="shin_tip"/>'
    + _joint("spine", "revolute", "pelvis", "chest", "0 0 0.2", "0 0 1")
    + _joint("l1", "revolute", "chest", "l1", "0 0.2 0.1", "1 1 0")
    + _joint("l2", "prismatic", "l1", "l2", "0.2 0 0", "1 0 0.3")
    + _joint("lfinger", "revolute", "l2", "lf", "0.1 0 0", rest='<mimic joint="l1" multiplier="2" offset="0.25"/>')
    + _joint("lfix", "fixed", "l2", "lhand", "0.1 0.02 0")
    + _joint("r1", "continuous", "chest", "r1", "0 -0.2 0.1", "1 -1 0")
    + _joint("r2", "revolute", "r1", "r2", "0.2 0 0")
    + _joint("rfix", "fixed", "r2", "rhand", "0.1 0.02 0")
    + _joint("g1", "revolute", "pelvis", "g", "0 0 -0.1")
    + _joint("g2", "revolute", "g", "g2", "0 0 -0.3")
    + _joint("gfix", "fixed", "g2", "shin_tip", "0 0 -0.3")
    + "</robot>",
    {
        "base": "pelvis",
        "trunk": {"spine": "0.3 rad", "lfinger": "0.25 rad"},
        "limb": [
            {"name": "left", "tip": "lhand", "contact": "gripper", "offset": ["1 cm", "2 cm", "-3 cm"]},
            {"name": "right", "tip": "rhand", "contact": "gripper", "limits": {"r1": ["-2 rad", "2 rad"]}},
            {"name": "leg", "tip": "shin_tip", "contact": "foot"},
        ],
    },
)
"""Turned inertias, fixed, sliding, endless and coupled joints, missing meshes, a spine that two limbs share."""
