"""A log identified: every joint that it has, with what the robot's file says of it where a robot is named."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final

from ....control.chain import Chain
from ....control.identification.joint import Drivetrain, IdentifiedJoint, identify_joint
from ....control.identification.joint_fit import LinkLoad, link_loads
from ....control.identification.samples import motion_of
from ....errors import ClamberError, UnitError, UnknownNameError, describe_choices
from ....execution.log import Log, LogError
from ....execution.log_roles import LimbSamples, samples_of
from ....json_form import Jsonable
from ....tasks.robots import load_robot
from ....toml_text import toml_value
from ....units import parse_quantity
from ..control.limb_chain import chain_of_limb, chosen_limb
from ..robot.robot import Joint, LimbedRobot

CLEAR: Final = 5.0
"""An offset of so many standard errors"""
PULL_PART: Final = 0.1
"""and this part of the friction is spoken of."""
UNITS_OF_FILE: Final = {"inertia": "inertia", "damping": "damping", "friction": "friction"}
"""Parameter -> key of a joint in a robot's file."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Known:
    """What the user states of motors and amplifiers; None where the robot's file is to say it."""

    torque_constant: float | None = None
    """Before the gear [N m/A]."""
    gear: float | None = None
    """Motor turns per joint turn [-]."""
    gain: float | None = None
    """Of the amplifier [A/V], for a log with voltages and no currents."""

    @classmethod
    def read(cls, torque_constant: str | None, gear: float | None, gain: str | None) -> "Known":
        """From texts with units.

        Raises:
            UnitError: If a text is no such quantity, or a number is not more than 0.
        """
        constant = None if torque_constant is None else parse_quantity(torque_constant, "torque constant")
        amplifier = None if gain is None else parse_quantity(gain, "amplifier gain")
        for value, what in ((constant, "torque constant"), (gear, "gear"), (amplifier, "amplifier gain")):
            if value is not None and not 0.0 < value < math.inf:
                raise UnitError(value, f"is no {what}", "state a finite number over 0")
        return cls(torque_constant=constant, gear=gear, gain=amplifier)

    def over(self, drivetrain: Drivetrain) -> Drivetrain:
        """A drivetrain with what is stated here."""
        return replace(
            drivetrain,
            torque_constant=self.torque_constant or drivetrain.torque_constant,
            gear=self.gear or drivetrain.gear,
            amplifier_gain=self.gain or drivetrain.amplifier_gain,
        )


@dataclass(frozen=True, slots=True, eq=False)
class Identification(Jsonable):
    """What a log tells of the joints of a limb."""

    log: str
    """The file."""
    robot: str | None
    limb: str | None
    joints: tuple[IdentifiedJoint, ...]
    notes: tuple[str, ...]
    """What had to be assumed."""

    @property
    def complete(self) -> bool:
        """Whether any joint's parameters were found at all."""
        return any(estimate.value is not None for joint in self.joints for estimate in joint.estimates)

    def toml(self) -> str:
        """Lines for a robot's file, a section a joint, each number with its unit and source; what is not known is left out."""
        lines = []
        for joint in self.joints:
            place = joint.samples.name.split()[-1]
            lines.append(f"[limbs.{place}] # {joint.samples.name}")
            shared = []
            for estimate in joint.estimates:
                if estimate.value is None or estimate.error is None:
                    continue
                value = float(f"{estimate.value:.6g}")
                source = f"identified from {self.log}: {estimate.method}, standard error {estimate.error:.2g}"
                entry = toml_value({"value": value, "unit": estimate.unit, "source": source})
                if estimate.name in UNITS_OF_FILE:
                    lines.append(f"{UNITS_OF_FILE[estimate.name]} = {entry}")
                elif estimate.name in ("amplifier gain", "backlash"):
                    shared.append(f"# [motor] {estimate.name.replace(' ', '_')} = {entry}")
            lines += [*shared, ""]
        return "\n".join(lines)


def identify_log(
    log: Log,
    *,
    robot: str | None = None,
    limb: str | None = None,
    mapping: Mapping[str, str] | None = None,
    joints: tuple[str, ...] = (),
    known: Known | None = None,
    upright: bool = False,
    seed: int = 0,
) -> Identification:
    """Identify every joint that a log has an angle of.

    Args:
        log: As read.
        robot: A climber's name or file; None: as the log's notes say, if they do.
        limb: Its limb; None: as the notes say, or the one whose joints the log names.
        mapping: Column -> what it is (`log_roles.samples_of`).
        joints: Only these of the log's; all if empty.
        known: Of the motors, before what the robot's file says.
        upright: Whether weight acts on the links; so it does where the log's notes say so.
        seed: Of the bootstrap.

    Raises:
        LogError: If the log cannot be used.
        UnknownNameError: If there is no such robot or limb.
    """
    found = samples_of(log, mapping)
    known = known or Known()
    robot = robot or log.notes.get("robot")
    upright = upright or log.notes.get("upright") == "yes"
    notes = list(found.notes)
    chain, stated = None, {}
    name = None
    if robot is not None:
        spec, name = _limb_of(robot, limb or log.notes.get("limb"), found)
        chain = chain_of_limb(spec, name, upright=upright)
        stated = _drivetrains(spec, name, chain)
        robot = spec.name
    elif upright or limb is not None:
        raise ClamberError("identify: --upright and --limb need a robot: state --robot")
    evened = tuple(samples.evened() for samples in found.joints)
    motions = [motion_of(samples) for samples in evened]
    links: list[LinkLoad | None] = [None] * len(evened)
    by_name = {samples.name: k for k, samples in enumerate(evened)}
    if chain is not None:
        missing = [joint for joint in chain.joint_names if joint not in by_name]
        if missing:
            notes.append(
                f"the log has no angle of {missing[0]}: the links' torques are not taken off, inertia includes them"
            )
        else:
            places = [by_name[joint] for joint in chain.joint_names]
            behind = [evened[k].angle if (out := evened[k].output_angle) is None else out for k in places]
            loads = link_loads(chain, behind, [motions[k].speed for k in places])
            for k, at_joint in zip(places, loads, strict=True):
                links[k] = at_joint
    else:
        notes.append("no robot is named: inertia includes the links', as far as they move along")
    for joint in joints:
        if joint not in by_name:
            raise LogError(
                log.label, f"{joint} angle", None, None, f"no such joint; there are {describe_choices(joint, by_name)}"
            )
    found_joints = []
    for samples, motion, load in zip(evened, motions, links, strict=True):
        drivetrain = known.over(stated.get(samples.name, Drivetrain()))
        if joints and samples.name not in joints:
            continue
        found_joints.append(identify_joint(samples, motion, load, drivetrain, seed))
    notes += [note for joint in found_joints if (note := _pull_note(joint, upright=upright))]
    notes += [note for joint in found_joints for note in _impossible(joint)]
    return Identification(log.label, robot, name, tuple(found_joints), tuple(notes))


def _impossible(joint: IdentifiedJoint) -> Iterator[str]:
    """What no joint can have: the log does not tell it, or the joint is none."""
    for estimate in joint.estimates:
        if estimate.name in UNITS_OF_FILE and estimate.value is not None and estimate.value < 0.0:
            yield (
                f"WARNING: {joint.samples.name}: its {estimate.name} came out below 0, which cannot be: these are not its torques, "
                "or the log moves it too little; do not use its numbers"
            )


def _pull_note(joint: IdentifiedJoint, *, upright: bool) -> str | None:
    """What to think of where something pulls a joint one way, by more than noise and a good part of its friction."""
    pull, friction = joint.estimates[3], joint.estimates[2]
    if pull.value is None or pull.error is None or friction.value is None:
        return None
    if abs(pull.value) < max(CLEAR * pull.error, PULL_PART * abs(friction.value)):
        return None
    why = (
        "friction that differs by direction, or a sensor's zero"
        if upright
        else "weight (state --upright), or a sensor's zero"
    )
    return f"{joint.samples.name} is pulled one way by {pull.value:.2g} N m: {why}"


def _limb_of(robot: str, limb: str | None, found: LimbSamples) -> tuple[LimbedRobot, str]:
    loaded = load_robot(robot)
    if not isinstance(loaded, LimbedRobot):
        raise ClamberError(f"{robot}: logs are identified for robots of the family 'limbed'")
    if limb is None:
        words = {word for joint in found.joints for word in joint.name.split()}
        named = [name for name in loaded.limb_names if name in words]
        if len(named) != 1:
            raise UnknownNameError(f"limb of {loaded.name} (state --limb)", "", loaded.limb_names)
        return loaded, named[0]
    return loaded, chosen_limb(loaded, limb)


def _drivetrains(robot: LimbedRobot, limb: str, chain: Chain) -> dict[str, Drivetrain]:
    spec, motor = robot.limbs[robot.limb_index(limb)], robot.motor
    out = {}
    joints: tuple[Joint, ...] = (spec.shoulder, spec.elbow)
    for name, joint in zip(chain.joint_names, joints, strict=True):
        said = {
            "inertia": joint.inertia,
            "damping": joint.damping,
            "friction": joint.friction,
            "backlash": motor.backlash,
        }
        if motor.amplifier_gain is not None:
            said["amplifier gain"] = motor.amplifier_gain
        out[name] = Drivetrain(
            torque_constant=motor.torque_constant, gear=joint.gear, amplifier_gain=motor.amplifier_gain, stated=said
        )
    return out
