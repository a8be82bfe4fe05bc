"""Robots: what they are made of, as plain data; kinematics, mechanisms and shapes."""

from .library import load_robot as load_robot
from .library import robot_names as robot_names
from .limbed import LimbedRobot as LimbedRobot
from .walker import WalkerRobot as WalkerRobot
