"""One joint identified: from which signal its torque is, every parameter, how well the model fits."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from operator import attrgetter
from typing import Annotated, Final

import numpy as np

from ...json_form import HIDDEN, Count, Jsonable, Key
from ...types import Floats
from .amplifier import amplifier_gain
from .backlash import backlash
from .constant_torque import RoughEstimates, rough_estimates
from .estimate import Estimate
from .joint_fit import NAMES, NEEDS, UNITS, JointFit, fit_joint
from .links import LinkLoad
from .motion import Motion
from .samples import JointSamples

NO_TORQUE: Final = "torque, or current with the motor's torque constant and gear"


@dataclass(frozen=True, slots=True, kw_only=True)
class Drivetrain:
    """What is known beforehand of a joint's motor; None where it is not."""

    torque_constant: float | None = None
    """Motor torque per current, before the gear [N m/A]."""
    gear: float | None = None
    """Motor turns per joint turn; None: as if there were no gear [-]."""
    amplifier_gain: float | None = None
    """Taken where a log has voltages and no currents [A/V]."""
    stated: Mapping[str, float] = field(default_factory=dict)
    """Parameter -> what the robot's file says."""

    @property
    def torque_per_current(self) -> float | None:
        """k_t N at the joint [N m/A]."""
        return None if self.torque_constant is None else self.torque_constant * (self.gear or 1.0)


@dataclass(frozen=True, slots=True, eq=False)
class IdentifiedJoint(Jsonable):
    """What a log tells of one joint."""

    samples: Annotated[
        JointSamples,
        Key("joint", get=attrgetter("name"), kind=str),
        Key("rows", get=lambda samples: samples.time.size, kind=Count),
        Key("seconds", get=lambda samples: samples.time[-1] - samples.time[0], kind=float),
    ]
    """Evenly spaced."""
    motion: Annotated[Motion, HIDDEN]
    torque: Annotated[Floats | None, HIDDEN]
    """Of the motor at the joint, at every sample [N m]."""
    links: Annotated[LinkLoad | None, HIDDEN]
    """What the links ask of the joint, where a robot is named."""
    torque_from: str
    fit: Annotated[
        JointFit | None,
        Key("lag", get=attrgetter("lag"), kind=float, meaning="Of the torque behind the angles [s]."),
        Key(
            "residual_torque",
            get=attrgetter("residual"),
            kind=float,
            meaning="Root mean square of what the fit leaves [N m].",
        ),
    ]
    rough: Annotated[RoughEstimates, Key("constant_torque", after="estimates")]
    estimates: tuple[Estimate, ...]
    """Inertia, damping, friction, offset, amplifier gain, backlash."""


def identify_joint(
    samples: JointSamples, motion: Motion, links: LinkLoad | None, drivetrain: Drivetrain, seed: int = 0
) -> IdentifiedJoint:
    """Everything that evenly spaced samples of one joint tell.

    Args:
        samples: Of the joint.
        motion: Of the same samples.
        links: What the limb's links ask of the joint; None where that is not known: inertia then includes theirs.
        drivetrain: What is known beforehand.
        seed: Of the bootstrap.
    """
    gain = amplifier_gain(samples, motion, drivetrain.torque_per_current, seed)
    torque, source = _torque(samples, drivetrain)
    fit, rough = None, RoughEstimates(None, None, None, ())
    if torque is None:
        moved = tuple(Estimate(name, unit, needs=NO_TORQUE) for name, unit in zip(NAMES, UNITS, strict=True))
    elif not motion.moves:
        moved = tuple(Estimate(name, unit, needs=need) for name, unit, need in zip(NAMES, UNITS, NEEDS, strict=True))
    else:
        fit = fit_joint(samples, motion, torque, links, seed)
        rough = rough_estimates(samples, motion, torque)
        moved = fit.estimates
    estimates = tuple(
        replace(estimate, stated=drivetrain.stated.get(estimate.name))
        for estimate in (*moved, gain, backlash(samples, motion.speed, seed))
    )
    return IdentifiedJoint(samples, motion, torque, links, source, fit, rough, estimates)


def _torque(samples: JointSamples, drivetrain: Drivetrain) -> tuple[Floats | None, str]:
    """The motor's torque at the joint, from the best of what was measured, and from what."""
    if samples.torque is not None:
        return samples.torque, "torque"
    scale, gain = drivetrain.torque_per_current, drivetrain.amplifier_gain
    if samples.current is not None and scale is not None:
        return scale * samples.current, "current"
    if samples.command is not None and scale is not None and gain is not None:
        return scale * gain * np.asarray(samples.command), f"command, with {gain:g} A/V taken as given"
    return None, "nothing"
