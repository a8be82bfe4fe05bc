"""The arm on the Delta-frame, as a robot file states it."""

from ....files import Document
from ....specs import spec
from ....units import Angle, Length, NonNegativeMass, PositiveAngularSpeed, PositiveLength


@spec
class Arm:
    """An arm of one turning and n pitching joints (Hoshino and others, equation 8).

    Joint 0 turns about the plate's normal. Joints 1 to n pitch in the arm's plane, upwards positive; with all at zero the arm points
    straight out. The tool point is the end of the last link.
    """

    links: tuple[PositiveLength, ...]
    """Lengths of the pitching links, L1 to Ln [m], shape (n,)."""
    masses: tuple[NonNegativeMass, ...]
    """Their masses, each at its middle [kg], shape (n,)."""
    out: Length
    """From the axis of joint 0 to that of joint 1, outwards, X1 [m]."""
    up: Length
    """From the plate to the axis of joint 1, Z1 [m]."""
    lowest: tuple[Angle, ...]
    """Lower ends of the joints' ranges [rad], shape (n + 1,)."""
    highest: tuple[Angle, ...]
    """Upper ends [rad], shape (n + 1,)."""
    fastest: tuple[PositiveAngularSpeed, ...]
    """Largest joint speeds [rad/s], shape (n + 1,)."""
    rest: tuple[Angle, ...]
    """Joint angles while the robot walks, unless a task says otherwise [rad], shape (n + 1,)."""

    @property
    def n_joints(self) -> int:
        """How many joints it has."""
        return len(self.links) + 1


def check_arm(arm: Arm, document: Document) -> None:
    """Raises `SpecError` if the lists of an arm do not belong together."""
    if not arm.links:
        raise document.problem("arm.links", "must name one link or more")
    if len(arm.masses) != len(arm.links):
        raise document.problem("arm.masses", f"must have {len(arm.links)} entries, one for each link")
    for key in ("lowest", "highest", "fastest", "rest"):
        if len(getattr(arm, key)) != arm.n_joints:
            raise document.problem(
                f"arm.{key}",
                f"must have {arm.n_joints} entries, one for each joint: the turning one and one for each link",
            )
    for joint, (low, high) in enumerate(zip(arm.lowest, arm.highest, strict=True)):
        if not low < high:
            raise document.problem(f"arm.lowest.{joint}", "must be less than its entry of highest")
        if not low <= arm.rest[joint] <= high:
            raise document.problem(f"arm.rest.{joint}", f"must be in the joint's range, {low:.6g} to {high:.6g} rad")
