"""Kinds of contacts as files state them, with the numbers of a data sheet, and the contact that statics makes of each."""

import math
from typing import Annotated, Any, Final, Literal, TypeAlias

from pydantic import Field

from ....errors import describe_choices
from ....files import Document, check_schema
from ....specs import Name, build_spec, spec
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
from .contacts import Contact, Strength, at_most, cone, hook_rows, moments, padded, spine_rows

SCHEMA: Final = "clamber-contact-1"
CAPTURE: Final = 0.01
"""How far beside a hold end effectors attach whose files do not say it, chosen: spines, jaws and lips of this size reach so far [m]."""
CENTRING: Final = 0.03
"""From how far jaws and hooks draw themselves to a hold's place whose files do not say it, chosen: as far as they reach around what they
enclose, a capture of 20 mm beside a patch of 10 mm [m]."""
Title = Annotated[str, Field(max_length=200)]


@spec
class PointFoot:
    """A foot that touches in a point and pushes."""

    kind: Literal["foot"]
    name: Name
    title: Title
    friction: NonNegativeRatio
    """Coefficient of friction [-]."""

    def contact(self) -> Contact:
        """What it can take: a friction cone."""
        return Contact(kind=self.kind, rows=cone(), friction=self.friction)

    def bears(self) -> Strength:
        """Exactly what it bears."""
        return Strength(form="cone", friction=self.friction)


@spec
class AreaFoot:
    """A flat foot that pushes all over a rectangle; with an ankle that turns freely, no moments but friction's cone."""

    kind: Literal["area"]
    name: Name
    title: Title
    friction: NonNegativeRatio
    """Coefficient of friction [-]."""
    length: PositiveLength
    """Along the end effector's x [m]."""
    width: PositiveLength
    """Along its y [m]."""
    tilt: ConeAngle
    """Largest angle between sole and surface: of the ankle, or that the sole gives way [rad]."""
    ankle: bool = False
    """Whether a passive joint lets the sole lie flat."""

    def contact(self) -> Contact:
        """What it can take."""
        return padded(self.kind, self.friction, 0.0, (self.length / 2, self.width / 2), self.ankle, self.tilt)

    def bears(self) -> Strength:
        """Exactly what it bears."""
        return Strength(
            form="cone" if self.ankle else "pad",
            friction=self.friction,
            halves=(self.length / 2, self.width / 2),
            moments=not self.ankle,
            tilt=self.tilt,
        )


@spec
class Gripper:
    """A gripper closed around a hold, as a point that pushes and pulls."""

    kind: Literal["gripper"]
    name: Name
    title: Title
    friction: NonNegativeRatio
    """Tangential force per normal force above the pull-off force [-]."""
    pull: PositiveForce
    """Pull-off force along the normal [N]."""
    capture: PositiveLength = CAPTURE
    """It attaches beside a hold's patch by no more than this [m]."""
    centring: NonNegativeLength = CENTRING
    """As it shuts, it draws its tip to the hold's place from no further than this [m]; 0: it stays where it attaches."""
    jaws: NonNegativeLength = 0.0
    """Depth of its jaws: it takes what stands out, such as a peg, anywhere within them [m]; 0: it lies on its holds."""

    def contact(self) -> Contact:
        """What it can take: a friction cone whose apex lies at the pull-off force."""
        return Contact(kind=self.kind, rows=cone(), friction=self.friction, pull=self.pull)

    def bears(self) -> Strength:
        """Exactly what it bears."""
        return Strength(
            form="cone",
            friction=self.friction,
            pull=self.pull,
            capture=self.capture,
            centring=self.centring,
            jaws=self.jaws,
        )


@spec
class Clamp:
    """A clamp that holds an edge or a plate from both sides and bears moments of its own."""

    kind: Literal["clamp"]
    name: Name
    title: Title
    friction: NonNegativeRatio
    """Tangential force per normal force above the pull-off force [-]."""
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

    def contact(self) -> Contact:
        """What it can take: forces and moments apart from each other."""
        rows = (*cone(), *at_most(self.press), *moments(self.bending, self.twisting))
        return Contact(
            kind=self.kind,
            rows=rows,
            friction=self.friction,
            pull=self.pull,
            components=6,
            aligned=True,
            tilt=self.tilt,
        )

    def bears(self) -> Strength:
        """Exactly what it bears."""
        return Strength(
            form="cone",
            friction=self.friction,
            pull=self.pull,
            press=self.press,
            bending=self.bending,
            twisting=self.twisting,
            moments=True,
            capture=self.capture,
            centring=self.centring,
            tilt=self.tilt,
        )


@spec
class Hook:
    """A hook over a bar: the normal points from the bar's bearing side into the hook's bed."""

    kind: Literal["hook"]
    name: Name
    title: Title
    friction: NonNegativeRatio
    """Coefficient of friction along the bar [-]."""
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

    def contact(self) -> Contact:
        """What it can take."""
        rows = hook_rows(self.opening, self.friction)
        return Contact(
            kind=self.kind, rows=rows, friction=self.friction, pull=self.strength, aligned=True, tilt=self.tilt
        )

    def bears(self) -> Strength:
        """Exactly what it bears."""
        return Strength(
            form="hook",
            friction=self.friction,
            pull=self.strength,
            angle=self.opening,
            capture=self.capture,
            centring=self.centring,
            bar=True,
            tilt=self.tilt,
        )


@spec
class Magnet:
    """A magnet on steel: pulls all over its pole face, less across a gap (paint, rust) and when it stands tilted."""

    kind: Literal["magnet"]
    name: Name
    title: Title
    friction: NonNegativeRatio
    """Shear force per pull: coefficient of friction against steel [-]."""
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

    def contact(self) -> Contact:
        """What it can take."""
        side = self.radius * math.sqrt(0.5)
        return padded(self.kind, self.friction, self._pull, (side, side), self.ankle, self.tilt, self._loss)

    @property
    def _pull(self) -> float:
        return self.pull / (1.0 + self.gap / self.quarter_gap) ** 2

    @property
    def _loss(self) -> float:
        return 0.0 if self.ankle or self.half_tilt is None else 0.5 / self.half_tilt

    def bears(self) -> Strength:
        """Exactly what it bears."""
        return _strength(self, self._pull, self.radius * math.sqrt(0.5), self._loss)


@spec
class Suction:
    """A suction cup: its pull is the vacuum over its area, less a safety factor."""

    kind: Literal["suction"]
    name: Name
    title: Title
    friction: NonNegativeRatio
    """Coefficient of friction [-]."""
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

    def contact(self) -> Contact:
        """What it can take."""
        side = self.diameter / 2 * math.sqrt(0.5)
        return padded(self.kind, self.friction, self._pull, (side, side), self.ankle, self.tilt)

    @property
    def _pull(self) -> float:
        return self.vacuum * math.pi / 4 * self.diameter**2 / self.safety

    def bears(self) -> Strength:
        """Exactly what it bears."""
        return _strength(self, self._pull, self.diameter / 2 * math.sqrt(0.5))


@spec
class Spine:
    """Spines that hook into roughness when they are drawn along the end effector's x."""

    kind: Literal["spine"]
    name: Name
    title: Title
    friction: NonNegativeRatio
    """Coefficient of friction when they are not drawn, and sidewards [-]."""
    angle: ConeAngle
    """Of the drawing force out of the surface at which they come off [rad]."""
    strength: PositiveForce
    """Largest drawing force of all spines of the foot [N]."""
    tilt: ConeAngle
    """Largest angle of the end effector's z from the inward normal [rad]."""
    capture: PositiveLength = CAPTURE
    """It attaches beside a hold's patch by no more than this [m]."""

    def contact(self) -> Contact:
        """What it can take."""
        return Contact(
            kind=self.kind, rows=spine_rows(self.angle), friction=self.friction, pull=self.strength, tilt=self.tilt
        )

    def bears(self) -> Strength:
        """Exactly what it bears."""
        return Strength(
            form="spine",
            friction=self.friction,
            pull=self.strength,
            angle=self.angle,
            capture=self.capture,
            tilt=self.tilt,
        )


ContactKind: TypeAlias = PointFoot | AreaFoot | Gripper | Clamp | Hook | Magnet | Suction | Spine
KINDS: Final[dict[str, type[Any]]] = {
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
    built: ContactKind = build_spec(KINDS[str(kind)], document, without=("schema",))
    return built


def _strength(kind: Magnet | Suction, pull: float, side: float, loss: float = 0.0) -> Strength:
    """Of a face that pulls all over the square in it, half as wide as `side` [m]."""
    return Strength(
        form="cone" if kind.ankle else "pad",
        friction=kind.friction,
        pull=pull,
        halves=(side, side),
        moments=not kind.ankle,
        capture=kind.capture,
        tilt=kind.tilt,
        tilt_loss=loss,
    )
