"""A limbed robot in space: its file names a model, the limbs of it, and what the model does not say."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final

import numpy as np
from pydantic import Field, StrictStr

from ....errors import describe_choices
from ....files import Document, check_schema
from ....notebook import Pictured
from ....regular_files import user_path
from ....specs import Name, Provenance, build_spec, collect_sources, spec
from ....types import Json
from ....units import Length, NonNegativeAngle, NonNegativeLength, PositiveAngularSpeed, Quantity
from .assembly import Choice, LimbChoice, axis_frame, chains_of
from .chains import Chains
from .contact_kinds import ContactKind, build_contact, stated_contacts
from .contacts import Contact, Strength
from .handling import Handling, Payload
from .model import read_model
from .readings import Inertia, Load, Position, Rate, check_dimension, positive, shown
from .tree import Frame, Joint, Tree, read_tree, rooted_at

SCHEMA: Final = "clamber-robot-1"
FAMILY: Final = "spatial"
MAX_LIMBS: Final = 8
"""Limb slots of a stance."""
STRETCH: Final = 0.98
"""Part of its full length that a limb is to be stretched to at most where nobody knows better [-]: a knee between links of one length stays
bent by 23 degrees, more than what is off under the usual noise takes away."""
LIMB_ROOM: Final = "10 mm"
"""That links of different limbs are to keep from each other where nobody knows better: twice what holds are off under the usual noise."""


Share = Annotated[float, Quantity("ratio", above=0.0, at_most=1.0)]
Direction = tuple[float, float, float]


@spec
class LimbSpec:
    """One limb: what it ends with, and what the model does not say of its joints."""

    name: Name
    """Unique within the robot."""
    tip: StrictStr
    """Site or link of the model at its end."""
    offset: tuple[Length, Length, Length] = (0.0, 0.0, 0.0)
    """From there to the tip, in that frame [m]."""
    out: Direction | None = None
    """Direction out of the limb, towards what it touches, in that frame; None: a site's z, of a link from the last joint to the tip."""
    contact: StrictStr | dict[str, Any]
    """What it holds on with: the name of a contact, the path of its file, or what such a file says as a table."""
    nominal: tuple[Position, ...] | None = None
    """Posture that searches begin at, from the base to the tip; None: the middle of the limits."""
    limits: Mapping[StrictStr, tuple[Position, Position]] = field(default_factory=dict)
    """Joint -> least and largest position, in place of the model's."""
    torques: Mapping[StrictStr, Load] = field(default_factory=dict)
    """Joint -> largest torque or force of its motor, in place of the model's."""
    speeds: Mapping[StrictStr, Rate] = field(default_factory=dict)
    """Joint -> speed of its motor without load, in place of the model's."""
    rotors: Mapping[StrictStr, Inertia] = field(default_factory=dict)
    """Joint -> inertia of its motor's rotor at the joint, gear ratio squared and all, or mass, in place of the model's."""
    radius: NonNegativeLength | None = None
    """Of its links' capsules [m]; None: as thick as their shapes."""


@spec
class RobotSpec:
    """A robot file of the family."""

    name: Name
    title: StrictStr
    model: StrictStr
    """MJCF or URDF file, from where this file lies."""
    base: StrictStr
    """Link that floats; its frame is the robot's."""
    trunk: Mapping[StrictStr, Position] = field(default_factory=dict)
    """Joint that no limb has -> position at which it is held; 0, or what the model couples it to, where it is not named."""
    speed: PositiveAngularSpeed | None = None
    """Of motors without load, where neither limb nor model state one for a turning joint; None: they turn as fast as they may."""
    torque_share: Share = 1.0
    """Part of each motor's largest torque that plans use; what carries them out may use all of it [-]."""
    joint_room: NonNegativeAngle = 0.0
    """Turning joints stay so far inside their limits [rad]."""
    stretch: Share = 1.0
    """Part of a limb's full length that stances ask for at most [-] (`statics.stretch`). Where a knee is all but straight, a millimetre
    decides to which side it gives way, and whether a hold is within reach at all."""
    limb_room: NonNegativeLength = 0.0
    """Links of different limbs keep so far apart [m]: holds are not where they are believed."""
    brake: Annotated[float, Quantity("ratio", at_least=0.0)] = 0.0
    """Torque with which the brake of a joint holds it, of its motor's largest [-]; 0: joints have none. It locks one that fails."""
    payload: Payload | None = None
    half: tuple[NonNegativeLength, NonNegativeLength, NonNegativeLength] | None = None
    """Half extents of the box that stands for the base's body [m]; None: as large as its shapes."""
    handling: Handling = Handling()
    """How it moves and takes holds."""
    limb: Annotated[tuple[LimbSpec, ...], Field(min_length=1, max_length=MAX_LIMBS)]


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class SpatialRobot(Pictured):
    """A robot as its file and its model describe it."""

    family: ClassVar[str] = FAMILY

    spec: RobotSpec
    tree: Tree = field(repr=False)
    """The model, with the base as its root."""
    choice: Choice = field(repr=False, compare=False)
    """Of limbs and held joints, made of spec and tree."""
    chains: Chains = field(repr=False, compare=False)
    """Made of tree and choice."""
    ends: tuple[ContactKind, ...] = field(repr=False)
    """What each limb holds on with, as its data sheet says."""
    model_path: Path | None = field(compare=False)
    """None: the robot comes from a stored plan, which holds what statics needs of the model."""
    sources: Mapping[str, Provenance]
    """Dotted key of the file -> the number as written and its source."""

    @property
    def name(self) -> str:
        """Short name."""
        return self.spec.name

    @property
    def title(self) -> str:
        """In one line."""
        return self.spec.title

    @property
    def limbs(self) -> tuple[LimbSpec, ...]:
        """As the file has them."""
        return self.spec.limb

    @property
    def limb_names(self) -> tuple[str, ...]:
        """Names of the limbs, in order."""
        return self.chains.limb_names

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """What the end of each limb can take, as statics needs it."""
        return tuple(map(_contact_of, self.ends))

    @property
    def strengths(self) -> tuple[Strength, ...]:
        """Exactly what the end of each limb bears."""
        return tuple(end.bears() for end in self.ends)


@lru_cache
def _contact_of(end: ContactKind) -> Contact:
    return end.contact()


def whole_document(document: Document) -> Document:
    """A robot's document with what it takes from the files of its model and its contacts, so that it can be built where those are not.

    Raises:
        SpecError: If it names no model, or a model or contact that there is not.
        FileError: If a file can't be read.
    """
    parts = document.data.get("parts")
    if parts is None:
        path = model_path(document)
        if not path.exists():
            raise document.problem("model", f"there is no {path}; paths count from where the robot's file lies")
        parts = _plain(read_model(path).tree)
    return replace(document, data=document.data | {"parts": parts, "contacts": stated_contacts(document)})


def model_path(document: Document) -> Path:
    """Where a robot's model file is.

    Raises:
        SpecError: If it names none.
    """
    said = document.data.get("model")
    if not isinstance(said, str) or not said:
        raise document.problem("model", "must be the path of an MJCF or URDF file, from where this file lies")
    path = user_path(said)
    return path if document.folder is None else document.folder / path


def build_robot(document: Document) -> SpatialRobot:
    """The robot of a document.

    Raises:
        SpecError: If the document breaks a rule of the format, or names what the model does not have.
        FileError: If the model can't be read.
    """
    check_schema(document, SCHEMA)
    whole = whole_document(document)
    robot = build_spec(RobotSpec, whole, without=("schema", "family", "parts", "contacts"))
    tree = read_tree(whole.section("parts", f"{document.label} [parts]"))
    path = None if "parts" in document.data and document.folder is None else model_path(document)
    return _built(robot, tree, whole, path)


def _plain(tree: Tree) -> Json:
    """A tree as plain data, without what its joints do not have."""
    made: Json = asdict(tree)
    for joint in made["joints"]:
        for key in ("rotor", "friction", "damping"):
            if not joint[key]:
                del joint[key]
    return made


def _built(robot: RobotSpec, tree: Tree, document: Document, path: Path | None) -> SpatialRobot:
    links = tuple(link.name for link in tree.links)
    if robot.base not in links:
        raise document.problem("base", f"the model has no such link; it has {describe_choices(robot.base, links)}")
    for index, limb in enumerate(robot.limb):
        if limb.name in [other.name for other in robot.limb[:index]]:
            raise document.problem(f"limb.{index}.name", "names of limbs must differ")
    tree = rooted_at(tree, robot.base)
    joints = {joint.name: joint for joint in tree.joints}
    for name, reading in robot.trunk.items():
        _check_joint(document, f"trunk.{name}", name, joints)
        check_dimension(document, f"trunk.{name}", joints[name], reading)
    fixed = {joint.name for joint in tree.joints if joint.held is not None} | set(robot.trunk)
    tips = {limb.name: _tip_link(document, limb, tree) for limb in robot.limb}
    paths = {
        name: [joint for link in tree.path(link_name) for joint in tree.joints_of(link)]
        for name, link_name in tips.items()
    }
    passed = [joint.name for path_ in paths.values() for joint in path_]
    own = {
        name: tuple(joint for joint in path_ if joint.name not in fixed and passed.count(joint.name) == 1)
        for name, path_ in paths.items()
    }
    limbs = tuple(_limb(document, robot, limb, own[limb.name], tree, tips[limb.name]) for limb in robot.limb)
    moving = {joint.name for limb in limbs for joint in limb.joints}
    held = {
        name: robot.trunk[name].value if name in robot.trunk else joint.held or 0.0
        for name, joint in joints.items()
        if name not in moving
    }
    payload = robot.payload or Payload(mass=0.0)
    choice = Choice(
        limbs=limbs,
        held=held,
        payload=payload.mass,
        payload_at=payload.at,
        half=robot.half,
        stretch=robot.stretch,
        limb_room=robot.limb_room,
    )
    chains = chains_of(robot.name, tree, choice)
    if not chains.base_mass >= 0.0 or chains.total_mass <= 0.0:
        raise document.problem("model", "must have links with a mass")
    return SpatialRobot(
        spec=robot,
        tree=tree,
        choice=choice,
        chains=chains,
        ends=tuple(_end(document, limb) for limb in robot.limb),
        model_path=path,
        sources=collect_sources(document.data),
    )


def _end(document: Document, limb: LimbSpec) -> ContactKind:
    """What a limb holds on with."""
    if isinstance(limb.contact, dict):
        return build_contact(Document(f"{document.label} [limb.{limb.name}.contact]", limb.contact))
    label = f"contact '{limb.contact}' of {document.label}"
    return build_contact(document.section("contacts", label).section(limb.contact, label))


def _tip_link(document: Document, limb: LimbSpec, tree: Tree) -> str:
    """The link that a limb's tip is on."""
    sites = {site.name: site.link for site in tree.sites}
    links = {link.name for link in tree.links}
    if limb.tip in sites:
        return sites[limb.tip]
    if limb.tip in links:
        return limb.tip
    known = describe_choices(limb.tip, (*sites, *(link.name for link in tree.links)))
    raise document.problem(f"limb.{limb.name}.tip", f"the model has no such site or link; it has {known}")


def _limb(
    document: Document, robot: RobotSpec, limb: LimbSpec, joints: tuple[Joint, ...], tree: Tree, tip_link: str
) -> LimbChoice:
    key = f"limb.{limb.name}"
    if not joints:
        told = f"no joint is this limb's alone between the base '{robot.base}' and it; name a site or link behind one"
        raise document.problem(f"{key}.tip", told)
    own = {joint.name: joint for joint in joints}
    stated = {"limits": limb.limits, "torques": limb.torques, "speeds": limb.speeds, "rotors": limb.rotors}
    for word, names in stated.items():
        for name in names:
            _check_joint(document, f"{key}.{word}.{name}", name, own)
    bounds = [_bounds(document, robot, limb, joint) for joint in joints]
    torque = [_torque(document, robot, limb, joint) for joint in joints]
    nominal = [(lower + upper) / 2 for lower, upper in bounds]
    if limb.nominal is not None:
        if len(limb.nominal) != len(joints):
            raise document.problem(f"{key}.nominal", f"must have {len(joints)} positions, of {', '.join(own)}")
        for joint, reading in zip(joints, limb.nominal, strict=True):
            check_dimension(document, f"{key}.nominal", joint, reading)
        nominal = [reading.value for reading in limb.nominal]
        for joint, value, (lower, upper) in zip(joints, nominal, bounds, strict=True):
            if not lower <= value <= upper:
                told = f"that of {joint.name} must be {shown(joint, lower)} to {shown(joint, upper)}"
                raise document.problem(f"{key}.nominal", told + ", its limits less 'joint_room'")
    return LimbChoice(
        name=limb.name,
        joints=tuple(replace(joint, rotor=_rotor(document, limb, joint)) for joint in joints),
        lower=tuple(lower for lower, _ in bounds),
        upper=tuple(upper for _, upper in bounds),
        torque=tuple(torque),
        speed=tuple(_speed(document, robot, limb, joint) for joint in joints),
        nominal=tuple(nominal),
        tip_link=tip_link,
        tip=_tip(document, limb, tree, joints[-1]),
        radius=limb.radius,
    )


def _bounds(document: Document, robot: RobotSpec, limb: LimbSpec, joint: Joint) -> tuple[float, float]:
    """Positions of a joint that may be used [rad] or [m]."""
    key = f"limb.{limb.name}.limits.{joint.name}"
    room = 0.0 if joint.sliding else robot.joint_room
    if joint.name in limb.limits:
        readings = limb.limits[joint.name]
        for reading in readings:
            check_dimension(document, key, joint, reading)
        lower, upper = (reading.value for reading in readings)
    elif joint.limits is not None:
        lower, upper = joint.limits
    else:
        raise document.problem(
            key, "must be given, as the model has no limits of this joint, such as ['-180 deg', '180 deg']"
        )
    if not lower + room < upper - room:
        told = "the least position must be below the largest" + (", both moved inwards by 'joint_room'" if room else "")
        raise document.problem(key, f"{told}; here {shown(joint, lower + room)} to {shown(joint, upper - room)}")
    return lower + room, upper - room


def _torque(document: Document, robot: RobotSpec, limb: LimbSpec, joint: Joint) -> float:
    """Torque [N m] or force [N] of a joint's motor that may be used."""
    key = f"limb.{limb.name}.torques.{joint.name}"
    torque = positive(document, key, joint, limb.torques.get(joint.name)) or joint.torque
    if torque is None:
        raise document.problem(key, "must be given, as the model states no torque of this joint, such as '10 N m'")
    return robot.torque_share * torque


def _speed(document: Document, robot: RobotSpec, limb: LimbSpec, joint: Joint) -> float:
    """Speed of a joint's motor without load [rad/s] or [m/s]; infinite where nothing states one."""
    key = f"limb.{limb.name}.speeds.{joint.name}"
    usual = None if joint.sliding else robot.speed
    return positive(document, key, joint, limb.speeds.get(joint.name)) or joint.speed or usual or math.inf


def _rotor(document: Document, limb: LimbSpec, joint: Joint) -> float:
    """Inertia [kg m^2] or mass [kg] of a joint's rotor; 0 where nothing states one."""
    key = f"limb.{limb.name}.rotors.{joint.name}"
    return positive(document, key, joint, limb.rotors.get(joint.name)) or joint.rotor


def _tip(document: Document, limb: LimbSpec, tree: Tree, last: Joint) -> Frame:
    """The tip in the frame of its link, z out of the limb."""
    site = next((site for site in tree.sites if site.name == limb.tip), None)
    link = tree.link(limb.tip if site is None else site.link)
    frame = Frame(np.zeros(3), np.eye(3)) if site is None else Frame(np.array(site.place), np.array(site.axes))
    place = frame.at(limb.offset)
    if limb.out is not None:
        out = np.array(limb.out)
        if not (math.isfinite(length := float(np.linalg.norm(out))) and length > 1e-9):
            raise document.problem(f"limb.{limb.name}.out", "must be a direction: three numbers that are not all 0")
        return Frame(place, frame.axes @ axis_frame(out / length))
    if site is not None:
        return Frame(place, frame.axes)
    at = Frame(np.array(link.place), np.array(link.axes))
    away = place - at.within(np.array(last.anchor))
    if not (length := float(np.linalg.norm(away))) > 1e-6:
        raise document.problem(f"limb.{limb.name}.out", "must be given, as the tip is on the last joint's axis")
    return Frame(place, axis_frame(away / length))


def _check_joint(document: Document, key: str, name: str, joints: Mapping[str, Joint]) -> None:
    if name not in joints:
        raise document.problem(key, f"no such joint; there are {describe_choices(name, tuple(joints))}")
