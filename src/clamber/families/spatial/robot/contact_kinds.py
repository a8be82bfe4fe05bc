"""Kinds of contacts as files state them, with the numbers of a data sheet: those that come with Clamber, and those that limbs name."""

import math
from dataclasses import fields
from pathlib import Path
from typing import Annotated, Any, Final, Literal

from pydantic import Field

from ....errors import UnknownNameError, describe_choices
from ....files import Document, check_schema, data_names, find_data, read_toml
from ....specs import Name, build_spec, spec
from ....types import Json
from ....units import (
    ConeAngle,
    NonNegativeLength,
    NonNegativeRatio,
    PositiveForce,
    PositiveLength,
    PositivePressure,
    PositiveRatio,
    PositiveTorque,
)
from .contacts import Contact, Form, Strength

SCHEMA: Final = "clamber-contact-1"
DATA: Final = Path(__file__).parent.parent / "data" / "contacts"
CAPTURE: Final = 0.01
"""How far beside a hold end effectors attach whose files do not say it, chosen: spines, jaws and lips of this size reach so far [m]."""
CENTRING: Final = 0.03
"""From how far jaws and hooks draw themselves to a hold's place whose files do not say it, chosen: as far as they reach around what they
enclose, a capture of 20 mm beside a patch of 10 mm [m]."""
Title = Annotated[str, Field(max_length=200)]


@spec
class ContactKind:
    """What a limb holds on with."""

    kind: str
    name: Name
    title: Title
    friction: NonNegativeRatio
    """Coefficient mu [-]: tangential force per normal force, of what pulls per normal force above the pull-off force."""

    def bears(self) -> Strength:
        """Exactly what it bears."""
        raise NotImplementedError

    def _strength(self, form: Form, **more: Any) -> Strength:
        """A body of some form: what has no other value in `more` is as the data sheet has it by the same name."""
        stated = {one.name: getattr(self, one.name) for one in fields(Strength) if hasattr(self, one.name)}
        return Strength(**(stated | more), form=form)

    def _pad(self, half1: float, half2: float, ankle: bool, **more: Any) -> Strength:
        """A body that pushes, or pulls, all over a rectangle half as long as these [m]; within an ankle it bears no moments."""
        return self._strength("cone" if ankle else "pad", halves=(half1, half2), moments=not ankle, **more)

    def contact(self) -> Contact:
        """What statics takes of it: a polytope in that."""
        return self.bears().contact(self.kind)


@spec
class PointFoot(ContactKind):
    """A foot that touches in a point and pushes."""

    kind: Literal["foot"]

    def bears(self) -> Strength:
        """Exactly what it bears."""
        return self._strength("cone")


@spec
class AreaFoot(ContactKind):
    """A flat foot that pushes all over a rectangle; with an ankle that turns freely, no moments but friction's cone."""

    kind: Literal["area"]
    length: PositiveLength
    """Along the end effector's x [m]."""
    width: PositiveLength
    """Along its y [m]."""
    tilt: ConeAngle
    """Largest angle between sole and surface: of the ankle, or that the sole gives way [rad]."""
    ankle: bool = False
    """Whether a passive joint lets the sole lie flat."""

    def bears(self) -> Strength:
        """Exactly what it bears."""
        return self._pad(self.length / 2, self.width / 2, self.ankle)


@spec
class Gripper(ContactKind):
    """A gripper closed around a hold, as a point that pushes and pulls."""

    kind: Literal["gripper"]
    pull: PositiveForce
    """Pull-off force along the normal [N]."""
    capture: PositiveLength = CAPTURE
    """It attaches beside a hold's patch by no more than this [m]."""
    centring: NonNegativeLength = CENTRING
    """As it shuts, it draws its tip to the hold's place from no further than this [m]; 0: it stays where it attaches."""
    jaws: NonNegativeLength = 0.0
    """Depth of its jaws: it takes what stands out, such as a peg, anywhere within them [m]; 0: it lies on its holds."""

    def bears(self) -> Strength:
        """Exactly what it bears."""
        return self._strength("cone")


@spec
class Clamp(ContactKind):
    """A clamp that holds an edge or a plate from both sides and bears moments of its own."""

    kind: Literal["clamp"]
    pull: PositiveForce
    """Pull-off force along the normal [N]."""
    press: PositiveForce
    """Largest force that pushes it on [N]."""
    bending: PositiveTorque
    """Largest moment across the normal [N m]."""
    twisting: PositiveTorque
    """Largest moment about the normal [N m]."""
    tilt: ConeAngle
    """Largest angle off the normal at which it closes [rad]."""
    capture: PositiveLength = CAPTURE
    """It attaches beside a hold's patch by no more than this [m]."""
    centring: NonNegativeLength = CENTRING
    """As it shuts, it draws its tip to the hold's place from no further than this [m]; 0: it stays where it attaches."""

    def bears(self) -> Strength:
        """Exactly what it bears."""
        return self._strength("cone", moments=True)


@spec
class Hook(ContactKind):
    """A hook over a bar: the normal points from the bar's bearing side into the hook's bed; its friction is that along the bar."""

    kind: Literal["hook"]
    opening: ConeAngle
    """Half angle of the forces across the bar that stay in the bed [rad]."""
    strength: PositiveForce
    """Largest force [N]."""
    tilt: ConeAngle
    """Largest angle of the end effector's z from the inward normal at which it hangs safely [rad]."""
    capture: PositiveLength = CAPTURE
    """It attaches beside a hold's patch by no more than this [m]."""
    centring: NonNegativeLength = CENTRING
    """As it shuts, it draws its tip to the hold's place from no further than this, across its bar [m]; 0: it stays where it attaches."""

    def bears(self) -> Strength:
        """Exactly what it bears."""
        return self._strength("hook", pull=self.strength, angle=self.opening, bar=True)


@spec
class Magnet(ContactKind):
    """A magnet on steel: pulls all over its pole face, less across a gap (paint, rust) and when it stands tilted."""

    kind: Literal["magnet"]
    pull: PositiveForce
    """Pull-off force without a gap [N]."""
    radius: PositiveLength
    """Of the pole face: the lever of the moment that peels it off is that of the square in it [m]."""
    gap: NonNegativeLength = 0.0
    """Between pole face and steel [m]."""
    quarter_gap: PositiveLength
    """Gap across which a quarter of the pull is left: the pull falls by the square of `gap / quarter_gap + 1` [m]."""
    tilt: ConeAngle
    """Largest angle between pole face and steel: of the ankle, or at which it still closes [rad]."""
    half_tilt: ConeAngle | None = None
    """Angle at which half of the pull is left, without an ankle [rad]; None: tilt costs nothing."""
    ankle: bool = False
    """Whether a passive joint lets the face lie flat."""
    capture: PositiveLength = CAPTURE
    """It attaches beside a hold's patch by no more than this [m]."""

    def bears(self) -> Strength:
        """Exactly what it bears."""
        pull = self.pull / (1.0 + self.gap / self.quarter_gap) ** 2
        loss = 0.0 if self.ankle or self.half_tilt is None else 0.5 / self.half_tilt
        side = self.radius * math.sqrt(0.5)
        return self._pad(side, side, self.ankle, pull=pull, tilt_loss=loss)


@spec
class Suction(ContactKind):
    """A suction cup: its pull is the vacuum over its area, less a safety factor."""

    kind: Literal["suction"]
    vacuum: PositivePressure
    """Below the pressure around it [Pa]."""
    diameter: PositiveLength
    """Of the area that is sucked on [m]."""
    safety: PositiveRatio
    """Factor that the pull is divided by [-]."""
    tilt: ConeAngle
    """Largest angle between lip and surface: of the ankle, or that the lip seals [rad]."""
    ankle: bool = False
    """Whether a passive joint lets the lip lie flat."""
    capture: PositiveLength = CAPTURE
    """It attaches beside a hold's patch by no more than this [m]."""

    def bears(self) -> Strength:
        """Exactly what it bears."""
        side = self.diameter / 2 * math.sqrt(0.5)
        pull = self.vacuum * math.pi / 4 * self.diameter**2 / self.safety
        return self._pad(side, side, self.ankle, pull=pull)


@spec
class Spine(ContactKind):
    """Spines that hook into roughness when they are drawn along the end effector's x; else, and sidewards, they rub."""

    kind: Literal["spine"]
    angle: ConeAngle
    """Of the drawing force out of the surface at which they come off [rad]."""
    strength: PositiveForce
    """Largest drawing force of all spines of the foot [N]."""
    tilt: ConeAngle
    """Largest angle of the end effector's z from the inward normal [rad]."""
    capture: PositiveLength = CAPTURE
    """It attaches beside a hold's patch by no more than this [m]."""

    def bears(self) -> Strength:
        """Exactly what it bears."""
        return self._strength("spine", pull=self.strength)


KINDS: Final[dict[str, type[ContactKind]]] = {
    "foot": PointFoot,
    "area": AreaFoot,
    "gripper": Gripper,
    "clamp": Clamp,
    "hook": Hook,
    "magnet": Magnet,
    "suction": Suction,
    "spine": Spine,
}
"""Each by its word in files."""


def build_contact(document: Document) -> ContactKind:
    """The contact that a document describes; `contact()` of it is what statics takes.

    Raises:
        SpecError: If it names no kind that there is, or a key or value of it is wrong.
    """
    check_schema(document, SCHEMA)
    kind = document.data.get("kind")
    if kind not in KINDS:
        raise document.problem("kind", f"must be {describe_choices(str(kind), tuple(KINDS))}")
    return build_spec(KINDS[str(kind)], document, without=("schema",))


def contact_names() -> tuple[str, ...]:
    """Names of the contacts that come with Clamber."""
    return data_names(DATA)


def read_contact(name_or_path: str, folder: Path | None = None) -> Document:
    """The document of a contact, by its shipped name or from the user's file (a path, relative to `folder`).

    Raises:
        UnknownNameError: If no contact has that name.
        FileError: If the file cannot be read.
    """
    path, label = find_data("contact", name_or_path, (DATA,), folder)
    return read_toml(path, label)


def stated_contacts(document: Document) -> Json:
    """Documents of the contacts that a robot's limbs name, by these names; of one that the document states itself, that.

    A stored document has no say in which files are read: what it does not state itself must come with Clamber.

    Raises:
        SpecError: If there is no such contact.
        FileError: If a file can't be read.
    """
    limbs = document.data.get("limb")
    found: Json = dict(document.section("contacts", document.label).data) if "contacts" in document.data else {}
    for k, limb in enumerate(limbs if isinstance(limbs, list) else ()):
        named = limb.get("contact") if isinstance(limb, dict) else None
        if isinstance(named, str) and named not in found:
            if "contacts" in document.data and not document.overrides and named not in contact_names():
                allowed = f"must be one of 'contacts', or come with Clamber: {describe_choices(named, contact_names())}"
                raise document.problem(f"limb.{k}.contact", allowed)
            try:
                found[named] = read_contact(named, document.folder).data
            except UnknownNameError as error:
                raise document.problem(f"limb.{k}.contact", str(error)) from None
    return found
