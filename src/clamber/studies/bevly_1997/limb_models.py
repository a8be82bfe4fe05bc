"""Figure 3.9: the simple model, equation 3.28, beside the limb in MuJoCo: every joint of LIBRA driven by itself."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from ...limb_bench.bench_limb import load_geared
from ...limb_bench.pictures.study import JointCurves, draw_joint_curves
from ...sim.bench_limb import BenchLimb
from ...sim.limb_flaws import LimbFlaws
from ...sim.plants import plant_maker
from ...types import Floats
from ...units import DEGREE
from ..result import Cells, Compared, Figure, StudyResult, Table
from . import MILLI
from .limb_entries import IDEAL

JOINTS: Final = tuple((limb, joint) for joint in (0, 1) for limb in (0, 1, 2))
"""Limb and joint of LIBRA's joints 1 to 6: the shoulders of legs 1 to 3, then their elbows."""
MEAN: Final = 1.0
"""Speed that the offset torque holds in the end [rad/s]."""
SWING: Final = 0.5
"""Amplitude of the speed about it [rad/s]."""
FREQUENCY: Final = 1.0
"""Of the sinusoid [Hz]."""
SECONDS: Final = 3.0
CLOSE: Final = 0.05
"""RMS difference of speed over mean speed up to which we call the match fair [-]."""
WORN: Final = LimbFlaws(backlash=2.0 * DEGREE, encoder_counts=400)
"""As the robot is: play, and speeds by difference of encoder counts."""


@dataclass(frozen=True, slots=True, eq=False)
class JointDrive:
    """One joint under a sinusoid with an offset, on three plants."""

    number: int
    """As in Table 3.1."""
    name: str
    links: float
    """Inertia of the links beyond the joint, limb stretched, over that of motor and gear [-]."""
    time: Floats
    """Shape (ticks,) [s]."""
    torque: Floats
    """Shape (ticks,) [N m]."""
    curves: dict[str, Floats]
    """Plant -> angle from the start and speed, shape (2, ticks) [rad], [rad/s]."""
    partner: float
    """Furthest that the limb's other joint moved in MuJoCo [rad]."""

    def difference(self, plant: str) -> float:
        """RMS difference of speed from the simple model's, over its mean [-]."""
        simple = self.curves[SIMPLE][1]
        return float(np.sqrt(np.mean((self.curves[plant][1] - simple) ** 2)) / simple.mean())

    def angle_difference(self, plant: str) -> float:
        """Largest difference of angle from the simple model's [rad]."""
        return float(np.abs(self.curves[plant][0] - self.curves[SIMPLE][0]).max())


SIMPLE: Final = "simple model"
LIMB: Final = "limb in MuJoCo"
LIKE_ROBOT: Final = "with play and encoders"


def drive_joint(number: int) -> JointDrive:
    """Drive one joint of LIBRA from rest at its lower limit; the limb's other joint has no torque and starts stretched.

    Args:
        number: As in Table 3.1, from 1.
    """
    which, joint = JOINTS[number - 1]
    robot, make_limb = load_geared("libra")
    limb = make_limb(robot, str(which + 1), upright=False)
    chain = limb.chain
    record = chain.joints[joint]
    q = np.zeros(chain.n)
    links = float(chain.inertia(q)[joint, joint] / record["rotor"]) - 1.0
    q[joint] = record["lower"]
    turn = math.tau * FREQUENCY
    swing = SWING * math.hypot(float(record["damping"]), float(record["rotor"]) * turn)
    time = np.arange(round(SECONDS * IDEAL.control_rate)) / IDEAL.control_rate
    torque = float(record["friction"] + MEAN * record["damping"]) + swing * np.sin(turn * time)
    simple = _follow("ode", limb, q, joint, torque, IDEAL)
    in_mujoco = _follow("mujoco", limb, q, joint, torque, IDEAL)
    worn = _follow("mujoco", limb, q, joint, torque, WORN)
    curves = {SIMPLE: simple[:, joint], LIMB: in_mujoco[:, joint], LIKE_ROBOT: worn[:, joint]}
    partner = float(np.abs(in_mujoco[0, 1 - joint]).max())
    return JointDrive(number, chain.joint_names[joint], links, time, torque, curves, partner)


def _follow(plant: str, limb: BenchLimb, q: Floats, joint: int, torque: Floats, flaws: LimbFlaws) -> Floats:
    """Angles from the start and speeds of both joints by the encoders, shape (2, n, ticks)."""
    stage = plant_maker(plant)(limb.chain, flaws, gears=limb.gears)
    stage.reset(q)
    out = np.empty((2, limb.chain.n, len(torque)))
    command = np.zeros((1, limb.chain.n))
    for k, value in enumerate(torque):
        out[:, :, k] = stage.sense().states[0]
        command[0, joint] = value
        stage.actuate(command)
        stage.step()
    out[0] -= q[:, None]
    return out


def compare_models() -> StudyResult:
    """All six joints on the simple model, on the limb in MuJoCo, and on that with play and encoders."""
    drives = [drive_joint(number) for number in range(1, len(JOINTS) + 1)]
    forward = all(float(d.curves[plant][1, 1:].min()) > 0.0 for d in drives for plant in (SIMPLE, LIMB))
    close = all(d.difference(plant) < CLOSE for d in drives for plant in (LIMB, LIKE_ROBOT))
    return StudyResult(
        claim="Figure 3.9, section 3.4.2: driven by a sinusoidal torque with an offset that keeps its speed positive, each joint moves "
        "much as the simple model 3.28 says: the geared motors' inertia dominates the limb.",
        verdict="holds" if close and forward else "differs",
        compared=(
            *(
                Compared(f"joint {d.number}: RMS difference of speed over its mean [-]", d.difference(LIMB))
                for d in drives
            ),
            *(Compared(f"joint {d.number}, play and encoders: the same [-]", d.difference(LIKE_ROBOT)) for d in drives),
            *(
                Compared(f"joint {d.number}: largest difference of angle [deg]", d.angle_difference(LIMB) / DEGREE)
                for d in drives
            ),
            *(Compared(f"joint {d.number}: links' inertia over motor's and gear's [-]", d.links) for d in drives),
            Compared("furthest that a joint without torque moved [deg]", max(d.partner for d in drives) / DEGREE),
            Compared("all speeds stay positive", str(forward)),
        ),
        deviations=DEVIATIONS,
        table=Table(COLUMNS, tuple(_row(d) for d in drives)),
        figures=(
            Figure(
                "speeds",
                "Speed of all six joints: simple model, limb in MuJoCo, and that with play and encoders.",
                lambda path: _draw(drives, 1, path),
            ),
            Figure("differences", "Speed less that of the simple model.", lambda path: _draw_differences(drives, path)),
            Figure("angles", "Angle of all six joints from the start.", lambda path: _draw(drives, 0, path)),
        ),
    )


COLUMNS: Final = (
    *("joint", "name", "least torque [N m]", "largest torque [N m]", "mean speed [rad/s]", "RMS difference [rad/s]"),
    *("of the mean [-]", "with play and encoders [-]", "largest angle difference [deg]", "angle at the end [deg]"),
    *("links' inertia [-]", "other joint moved [deg]"),
)


def _row(d: JointDrive) -> Cells:
    angle, speed = d.curves[SIMPLE]
    mean = float(speed.mean())
    return (
        *(d.number, d.name, float(d.torque.min()), float(d.torque.max()), mean, d.difference(LIMB) * mean),
        *(d.difference(LIMB), d.difference(LIKE_ROBOT), d.angle_difference(LIMB) / DEGREE),
        *(float(angle[-1]) / DEGREE, d.links, d.partner / DEGREE),
    )


def _draw(drives: Sequence[JointDrive], which: int, path: Path) -> None:
    """Angles (0) or speeds (1)."""
    panels = [
        JointCurves(
            f"joint {d.number}: {d.name}",
            f"RMS {d.difference(LIMB):.2%} of the mean"
            if which
            else f"{d.angle_difference(LIMB) / DEGREE:.2f} deg at most",
            d.time,
            {plant: curve[1] if which else curve[0] / DEGREE for plant, curve in d.curves.items()},
        )
        for d in drives
    ]
    quantity = "speed [rad/s]" if which else "angle from the start [deg]"
    draw_joint_curves(panels, quantity, f"{'Speed' if which else 'Angle'} under a sinusoid with an offset", path)


def _draw_differences(drives: Sequence[JointDrive], path: Path) -> None:
    panels = [
        JointCurves(
            f"joint {d.number}: {d.name}",
            f"links' inertia {d.links:.1%} of the joint's",
            d.time,
            {plant: (curve[1] - d.curves[SIMPLE][1]) * MILLI for plant, curve in d.curves.items()},
        )
        for d in drives
    ]
    draw_joint_curves(panels, "difference [mrad/s]", "Speed less that of the simple model", path)


DEVIATIONS: Final = (
    "Our real system is the limb in MuJoCo. Inertia, damping and friction of its joints are those of Table 3.1 by construction, so this "
    "cannot say how well they fit the robot; what it tests is the simplification: no inertia of the links, no joint moving another.",
    "The links' masses are ours, 0.30 and 0.15 kg; the joint that is not driven has no torque and is held by its friction alone. It "
    "starts at zero, the limb stretched, where the links weigh most in the shoulder.",
    "The torques are not printed; ours are Coulomb friction plus the damping at 1 rad/s, and 1 Hz with the amplitude that swings the "
    "speed by 0.5 rad/s; 3 s from rest at the joint's lower limit stay within its limits.",
    'We call a match "fairly well" up to 5 % of the mean speed (RMS). With play and encoders: 2 deg, 400 counts a motor turn, 200 Hz.',
    "Equation 3.28 is printed with the signs of damping and friction reversed; they are put right.",
)
