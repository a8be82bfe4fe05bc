"""A robot as MJCF: what MuJoCo writes of our model, with numbers to the last digit, where it writes six."""

import xml.etree.ElementTree as ET
from collections.abc import Iterable
from typing import Any, Final

from .lone_robot import LoneRobot

NAMING: Final = ("name", "joint", "tendon", "site", "site1", "site2", "body1", "body2", "geom")
"""Attributes that hold names."""


def mjcf_text(robot: LoneRobot) -> str:
    """The MJCF of a robot; names have "_" where ours have a blank, and frames are written into what they hold."""
    import mujoco

    root = ET.fromstring(robot.spec.to_xml())
    root.set("model", robot.name)
    root.insert(0, ET.Comment(f" {robot.title.replace('--', '-')} "))
    top = root.find("worldbody")
    assert top is not None
    _flatten(top)
    model = robot.model
    for body in top.iter("body"):
        number = model.body(body.get("name")).id
        _put(body, "pos", model.body_pos[number])
        _put(body, "quat", model.body_quat[number])
        own = {tag: body.findall(tag) for tag in ("joint", "freejoint", "geom", "site", "inertial")}
        for inertial in own["inertial"]:
            _put(inertial, "pos", model.body_ipos[number])
            _put(inertial, "quat", model.body_iquat[number])
            _put(inertial, "mass", (model.body_mass[number],))
            _put(inertial, "diaginertia", model.body_inertia[number])
        for joint in own["joint"]:
            _write_joint(joint, model, mujoco)
        first = model.body_geomadr[number]
        for k, geom in enumerate(own["geom"], start=first):
            _put(geom, "pos", model.geom_pos[k])
            _put(geom, "quat", model.geom_quat[k])
        for site in own["site"]:
            k = model.site(site.get("name")).id
            _put(site, "pos", model.site_pos[k])
            _put(site, "quat", model.site_quat[k])
    for motor in root.iter("general"):
        if motor.get("ctrlrange") is not None:
            _put(motor, "ctrlrange", model.actuator(motor.get("name")).ctrlrange)
    for element in root.iter():
        for key in NAMING:
            if (name := element.get(key)) is not None:
                element.set(key, plain_name(name))
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def plain_name(name: str) -> str:
    """A name of ours as other programs take it: without blanks."""
    return name.replace(" ", "_")


def numbers(values: Iterable[float]) -> str:
    """Numbers to the last digit, zero without a sign."""
    return " ".join(repr(float(value) + 0.0) for value in values)


def _put(element: ET.Element, key: str, values: Iterable[float]) -> None:
    element.set(key, numbers(values))


def _write_joint(joint: ET.Element, model: Any, mujoco: Any) -> None:
    number = model.joint(joint.get("name")).id
    if model.jnt_type[number] == mujoco.mjtJoint.mjJNT_FREE:
        return
    _put(joint, "pos", model.jnt_pos[number])
    _put(joint, "axis", model.jnt_axis[number])
    if model.jnt_limited[number]:
        _put(joint, "range", model.jnt_range[number])


def _flatten(element: ET.Element) -> None:
    """Put what frames hold in their place; the places and turns of the model already have them in."""
    for child in element:
        _flatten(child)
    flat: list[ET.Element] = []
    for child in element:
        flat += list(child) if child.tag == "frame" else [child]
    element[:] = flat
