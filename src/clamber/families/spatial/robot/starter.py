"""The robot file that an imported model starts from: every key with its meaning, and every guess marked as one."""

import os
from pathlib import Path
from typing import Final

import numpy as np

from ....errors import FileError
from ....tasks.imported import ImportedLimb, ImportedRobot
from ....toml_text import toml_value
from ....types import Floats, Json
from ....units import DEGREE, GRAVITY
from .finding import Chain, Found, find_limbs, limb_names
from .model import Model, read_model
from .robot import FAMILY, LIMB_ROOM, MAX_LIMBS, SCHEMA, STRETCH
from .tips import guess_nominal, guess_tip
from .tree import Joint, Posture, Tree, rooted_at

GUESS: Final = "guess"
NAMED: Final = 20
"""So many links are named, the others counted."""
ROOM: Final = 6 * DEGREE
"""That joints keep from their limits, where they can [rad]."""
THIN: Final = 0.02
"""Radius of links without a shape, as a part of their limb's length [-]."""
BRISK: Final = 1000.0
"""How fast a motor usually speeds its own rotor up [rad/s^2], by the torque of its joint, or by what would lift the whole robot at a limb's
length where its model states more. It is 90 (servos of the wall's climber) to 4 500 (knees of the quadruped) in the robots' files here."""
CONTACT: Final = "foot"
"""What pushes only is safe to guess."""


def import_robot(model_file: Path, target: Path, name: str) -> ImportedRobot:
    """The robot file of a model.

    Args:
        model_file: MJCF or URDF.
        target: Where the robot file goes; it names the model from there.
        name: Of the robot.

    Raises:
        FileError: If the model can't be read, is not physical, or has no limb.
    """
    model = read_model(model_file)
    found = find_limbs(model.tree)
    if not 1 <= len(found.limbs) <= MAX_LIMBS:
        links = [link.name for link in model.tree.links]
        many = f" and {len(links) - NAMED} more" if len(links) > NAMED else ""
        fixed = f"no joint moves one of its links, {', '.join(links[:NAMED])}{many}"
        looked = f"looked at chains to {'; '.join(found.looked)}" if found.looked else fixed
        told = f"has {len(found.limbs) or 'no'} limb{'s' if found.limbs else ''}: {looked}"
        allowed = (
            f"a robot has 1 to {MAX_LIMBS} limbs, chains of two joints or more that are not short beside the longest"
        )
        raise FileError(str(model_file), told, allowed)
    return _Writer(model, found, model_file, target, name).imported()


class _Writer:
    """Writes the file, and notes what it guesses."""

    def __init__(self, model: Model, found: Found, model_file: Path, target: Path, name: str) -> None:
        self.model, self.found, self.name = model, found, name
        self.tree: Tree = rooted_at(model.tree, found.base.name)
        self.path = Path(os.path.relpath(model_file.resolve(), target.resolve().parent)).as_posix()
        self.guessed: list[str] = []
        self.light = 0  # joints whose rotor's inertia is guessed
        self.limbs: list[ImportedLimb] = []
        self.lines: list[str] = []

    def imported(self) -> ImportedRobot:
        """All of it."""
        tree = self.tree
        notes = self.model.notes
        names = limb_names(self.found.limbs)
        self._head()
        for chain, name in zip(self.found.limbs, names, strict=True):
            self._limb(chain, name)
        if self.light:
            self.guessed.append(f"{self.light} joints: no inertia of rotors in the model; guessed by their torques")
        told = [*notes.repaired, *self.guessed]
        told_of = [*notes.dropped, *self.found.told]
        remarks = [
            f"#   {kind}: {line}" for kind, lines in (("repaired", told), ("dropped", told_of)) for line in lines
        ]
        head = [
            f"# A robot from {self.path}. Every line that says '{GUESS}' was guessed: look at it, then take the word away.",
            *(["# Of the model:", *remarks] if remarks else []),
        ]
        return ImportedRobot(
            name=self.name,
            mass=tree.mass,
            limbs=tuple(self.limbs),
            repaired=tuple(told),
            dropped=tuple(told_of),
            text="\n".join([*head, *self.lines]) + "\n",
        )

    def _state(self, key: str, value: object, comment: str) -> None:
        self.lines.append(f"{key} = {toml_value(value)}" + (f" # {comment}" if comment else ""))

    def _head(self) -> None:
        tree = self.tree
        base = self.found.base
        count = len(self.found.limbs)
        self._state("schema", SCHEMA, "")
        self._state("family", FAMILY, "")
        self._state("name", self.name, "")
        self._state(
            "title", f"{tree.name or self.name}: {count} limb{'s' if count > 1 else ''}, {tree.mass:.3g} kg", ""
        )
        self.lines.append("")
        self._state("model", self.path, "MJCF or URDF, from where this file lies")
        root = (
            "the root of the model"
            if base.parent is None
            else "the heaviest link at the model's root, a frame without mass"
        )
        self._state("base", base.name, f"{GUESS}: {root}")
        held = {joint.name: _position(joint, self._held(joint)) for joint in self.found.trunk}
        if held:
            self._state("trunk", held, f"{GUESS}: joints that no limb has alone are held here")
        self._state("torque_share", 1.0, "of each motor's largest torque; a plan that is to be carried out leaves some")
        narrow = [joint for chain in self.found.limbs for joint in chain.joints if joint.limits and not joint.sliding]
        narrow = [joint for joint in narrow if joint.limits and joint.limits[1] - joint.limits[0] <= 4 * ROOM]
        room = 0.0 if narrow else ROOM
        self.room = room
        self._state("joint_room", f"{room / DEGREE:g} deg", f"{GUESS}: what joints keep from their limits")
        self._state("stretch", STRETCH, f"{GUESS}: of a limb's full length that plans use, so that knees stay bent")
        self._state("limb_room", LIMB_ROOM, f"{GUESS}: what links of different limbs keep from each other")

    def _held(self, joint: Joint) -> float:
        """Where a joint of the trunk is held."""
        if joint.held is not None:
            return joint.held
        lower, upper = joint.limits or (-np.inf, np.inf)
        return float(np.clip(self.model.home.get(joint.name, 0.0), lower, upper))

    def _limb(self, chain: Chain, name: str) -> None:
        tree, joints = self.tree, chain.joints
        tip = guess_tip(self.model.tree, chain)
        limb: Json = {"name": name, "tip": tip.frame}
        comments = {"tip": f"{GUESS}: {tip.why}"}
        offset = np.round(tip.offset, 5) + 0.0
        if offset.any():
            limb["offset"] = [f"{1000 * value:.5g} mm" for value in offset]
        limb["out"] = [round(float(value), 6) + 0.0 for value in tip.out]
        comments["out"] = f"{GUESS}: out of the limb, in that frame"
        limb["contact"], comments["contact"] = (
            CONTACT,
            f"{GUESS}: pushes only; gripper, clamp, magnet and others hold on",
        )
        limits = {joint.name: (-np.pi, np.pi) for joint in joints if joint.limits is None}
        bounds = [joint.limits or limits[joint.name] for joint in joints]
        place = self._tip_at_rest(tip.frame, offset)
        inner = [
            (a, b) if joint.sliding else (a + self.room, b - self.room)
            for joint, (a, b) in zip(joints, bounds, strict=True)
        ]
        limb["nominal"], comments["nominal"] = self._nominal(chain, inner, place)
        if limits:
            limb["limits"] = {
                each: [_position(joint, value) for value in limits[each]]
                for joint in joints
                if (each := joint.name) in limits
            }
            comments["limits"] = f"{GUESS}: the model has none"
            self.guessed.append(
                f"joint{'s' if len(limits) > 1 else ''} {', '.join(limits)}: no limits in the model; a turn was guessed"
            )
        weak = [joint for joint in joints if joint.torque is None]
        if weak:
            limb["torques"] = {joint.name: self._load(joint, chain.length) for joint in weak}
            comments["torques"] = f"{GUESS}: the model states none; half of the weight at half of the limb's length"
            told = ", ".join(joint.name for joint in weak)
            self.guessed.append(
                f"joint{'s' if len(weak) > 1 else ''} {told}: no torque limit in the model, or 0; one was guessed"
            )
        light = [joint for joint in joints if not joint.rotor]
        if light:
            limb["rotors"] = {joint.name: self._rotor(joint, chain.length) for joint in light}
            comments["rotors"] = (
                f"{GUESS}: the model states none; what all of the torque speeds up by {BRISK:g} rad/s^2"
            )
            self.light += len(light)
        shaped = {shape.link for shape in tree.shapes}
        if not any(link.name in shaped for part in chain.parts for link in part.links):
            limb["radius"] = f"{1000 * THIN * chain.length:.3g} mm"
            comments["radius"] = f"{GUESS}: the model gives its links no shape that could be read"
            self.guessed.append(f"limb {name}: no shapes; a radius of {limb['radius']} was guessed")
        self.lines += ["", "[[limb]]"]
        self.lines += [
            f"{key} = {toml_value(value)}" + (f" # {comments[key]}" if key in comments else "")
            for key, value in limb.items()
        ]
        self.limbs.append(ImportedLimb(name=name, joints=tuple(joint.name for joint in joints), tip=tip.frame))

    def _tip_at_rest(self, frame: str, offset: Floats) -> Floats:
        """The tip with all joints at 0, model's frame [m]."""
        posture = Posture.of(self.tree)
        site = next((site for site in self.tree.sites if site.name == frame), None)
        return (posture.frame(self.tree.link(frame)) if site is None else posture.site(site)).at(offset)

    def _nominal(self, chain: Chain, bounds: list[tuple[float, float]], tip: Floats) -> tuple[list[str], str]:
        joints, home = chain.joints, self.model.home
        stated = [home.get(joint.name) for joint in joints]
        if any(stated) and all(
            value is not None and low <= value <= high for value, (low, high) in zip(stated, bounds, strict=True)
        ):
            return [
                _position(joint, value or 0.0, low, high)
                for joint, value, (low, high) in zip(joints, stated, bounds, strict=True)
            ], "the model's first keyframe"
        values = guess_nominal(self.tree, joints, bounds, tip)
        told = [
            _position(joint, value, low, high) for joint, value, (low, high) in zip(joints, values, bounds, strict=True)
        ]
        return told, f"{GUESS}: away from limits, where the tip moves every way"

    def _load(self, joint: Joint, length: float) -> str:
        """Half of the weight, or its torque at half of a limb's length, rounded up to two digits."""
        force = 0.5 * self.tree.mass * GRAVITY
        return f"{force:.2g} N" if joint.sliding else f"{force * length / 2:.2g} N m"

    def _rotor(self, joint: Joint, length: float) -> str:
        """What a motor of this torque usually turns, its own and its gear's inertia at the joint, rounded up to two digits."""
        weight = self.tree.mass * GRAVITY
        if joint.sliding:
            return f"{min(joint.torque or weight, weight) / (BRISK * length):.2g} kg"
        return f"{min(joint.torque or weight * length, weight * length) / BRISK:.2g} kg m^2"


def _position(joint: Joint, value: float, low: float = -np.inf, high: float = np.inf) -> str:
    """A position as a file says it, rounded within bounds: whole degrees, or millimetres of a slide."""
    unit, name = (1e-3, "mm") if joint.sliding else (DEGREE, "deg")
    for digits in (0, 1, 2, 4, 8):
        rounded = round(value / unit, digits)
        if low <= rounded * unit <= high and abs(rounded * unit - value) <= 1.0 * unit:
            return f"{rounded + 0.0:.{max(digits, 1)}f}".rstrip("0").rstrip(".") + f" {name}"
    return f"{value!r} {'m' if joint.sliding else 'rad'}"


IMPORTS: Final = dict.fromkeys((".urdf", ".xml", ".mjcf"), import_robot)
"""By suffix of the model file."""
