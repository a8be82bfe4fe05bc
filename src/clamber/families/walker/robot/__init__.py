"""Two-frame walkers: what their files state, and what follows from it by geometry."""

from .geometry import Followed as Followed
from .geometry import PoseError as PoseError
from .geometry import TwoFrames as TwoFrames
from .mechanism import Mechanism as Mechanism
from .robot import FRAME_TITLES as FRAME_TITLES
from .robot import FRAMES as FRAMES
from .robot import LEG_NAMES as LEG_NAMES
from .robot import Arm as Arm
from .robot import Legs as Legs
from .robot import Mass as Mass
from .robot import WalkerRobot as WalkerRobot
from .robot import build_walker as build_walker
