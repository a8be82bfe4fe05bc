"""How stiff, heavy and damped a walker's parts are: what no paper prints and its robot file does not state. All of it is assumed."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Servo:
    """A motor that holds its place like a spring and a damper."""

    stiffness: float
    """[N/m] or [N m/rad]."""
    damping: float
    """[N s/m] or [N m s/rad]."""
    armature: float = 0.0
    """What the motor's own inertia is worth at its output [kg] or [kg m^2]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WalkerBuild:
    """The parts that the dynamics need and the file does not have."""

    actuator: Servo = Servo(stiffness=1e6, damping=1e4)  # frozen
    """Of the three that slide the frames."""
    leg: Servo = Servo(stiffness=5e5, damping=2e4, armature=20.0)  # frozen
    joint: Servo = Servo(stiffness=1e5, damping=5e3, armature=5.0)  # frozen
    """Of the arm."""
    foot_stiffness: float = 3e4
    """Of a foot, to the sides: legs that are normal to a plate that tilts change the distance of their feet [N/m]. Physics steps of 2 ms
    carry up to 5e4; with 1e5 feet hum until they slip."""
    foot_damping: float = 1e3
    """To the sides [N s/m]; with three feet down the robot's sway along the ground is damped at a half of critical."""
    foot_radius: float = 0.005
    """Of the ball that a foot is, where its file says that feet are points [m]."""
    foot_mass: float = 0.5
    """Taken out of the frame's [kg]."""
    leg_mass: float = 0.5
    """Of the moving part, taken out of the frame's [kg]."""
    frame_height: float = 0.1
    """Frames have the inertia of discs of this height on the circle of their feet [m]."""
