"""Where a walker stands, as its cooperative motion needs it: which frame's feet are planted, and what bounds the plate's pose by them."""

from dataclasses import dataclass, field
from typing import Final, Literal

import numpy as np

from .....errors import StatedError
from .....types import Floats, Records
from ...robot import FRAMES, WalkerRobot
from .arm_moment import arm_moment
from .planted import heading_of, turn_of

Support = Literal["delta", "y", "both"]
SUPPORTS: Final[tuple[Support, ...]] = ("delta", "y", "both")
"""Which feet stand; the place of each is its code in the record."""
SUPPORT_WORDS: Final[dict[Support, str]] = {"delta": "Delta-frame", "y": "Y-frame", "both": "both frames"}
MOST_EDGES: Final = 6
ACTUATOR, GUARD, LEG, BALANCE = 0, 3, 4, 10
"""First row of each kind of bound: three actuators, the singularity, six legs (Delta-frame first), the support's edges."""
N_ROWS: Final = BALANCE + MOST_EDGES
ROW_NAMES: Final = (
    *(f"length of actuator {i}" for i in range(3)),
    "room to the singularity's guard",
    *(f"length of leg {i} of the {frame}-frame" for frame in ("Delta", "Y") for i in range(3)),
    *(f"balance over edge {i} of the support" for i in range(MOST_EDGES)),
)
ROW_UNITS: Final = tuple("1" if row == GUARD else "m" for row in range(N_ROWS))

PLANTED_FEET: Final = np.dtype(
    [
        ("attachments", "f8", (2, 3, 2)),  # of the actuators, each in its frame [m]
        ("feet", "f8", (2, 3, 2)),  # each in its frame [m]
        ("heights", "f8", (2, 3)),  # of the ground under each foot [m]
        ("support", "i4"),
        ("n_edges", "i4"),
        ("anchor", "f8", (3,)),  # middle of the standing feet, world [m]
        ("heading", "f8"),  # of the standing frame [rad]
        ("offset", "f8", (2,)),  # of the Y-frame in the Delta-frame while the mechanism does not move [m]
        ("twist", "f8"),  # likewise its angle [rad]
        ("guard", "f8"),
        ("mass_frames", "f8"),
        ("share_y", "f8"),
        ("mass_height", "f8"),
        ("mass_arm", "f8"),  # payload included
        ("moment_out", "f8"),  # of the arm's first moment (arm_moment.py) [kg m]
        ("moment_up", "f8"),
        ("edges", "f8", (MOST_EDGES, 3)),  # inwards normal and offset: the margin is n.p - c
    ],
    align=True,
)
"""What the kernels of `plate_bounds` read."""


class LimitError(StatedError):
    """A stance that the robot cannot have: names what it breaks, by how much, and what is allowed."""

    says = "the {what} is {value:.6g}; {allowed}"
    what: str
    value: float
    allowed: str


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PlantedFeet:
    """Standing feet, and the Y-frame in the Delta-frame."""

    robot: WalkerRobot
    support: Support
    pose: Floats
    """x, y, z [m], alpha, beta, gamma [rad] of the plate in the world at which the feet were planted, shape (6,)."""
    offset: tuple[float, float] = (0.0, 0.0)
    """Of the Y-frame's origin in the Delta-frame at that pose [m]."""
    twist: float = 0.0
    """Likewise its angle [rad]."""
    heights: Floats = field(default_factory=lambda: np.zeros((2, 3)))
    """Height of the ground under each foot, Delta-frame first [m], shape (2, 3)."""
    payload: float = 0.0
    """Carried at the tool point [kg]."""

    def __post_init__(self) -> None:
        if self.support not in SUPPORTS:
            raise LimitError("support", float("nan"), f"it is {self.support!r}, and must be one of {SUPPORTS}")
        if not self.payload >= 0.0:
            raise LimitError("payload [kg]", self.payload, "must be 0 or more")
        if np.shape(self.pose) != (6,) or not np.isfinite(self.pose).all():
            raise LimitError("pose", float("nan"), "must be six finite numbers: x, y, z, alpha, beta, gamma")

    def standing(self) -> tuple[int, ...]:
        """Indices of the frames that stand, in `FRAMES`."""
        return (0, 1) if self.support == "both" else (FRAMES.index(self.support),)

    def feet_on_ground(self) -> Floats:
        """Places of all feet with the plate at `pose`, each on the ground at its height, world [m], shape (2, 3, 3)."""
        turn = turn_of(self.pose[3:6])
        over = self.robot.feet_in_plate(np.array((*self.offset, self.twist))) @ turn[:, :2].T + self.pose[:3]
        lengths = (over[..., 2] - self.heights) / turn[2, 2]
        out: Floats = over - lengths[..., None] * turn[:, 2]
        return out

    def record(self) -> Records:
        """One record of `PLANTED_FEET`, shape (1,)."""
        robot, out = self.robot, np.zeros(1, PLANTED_FEET)
        root = out[0]
        root["attachments"], root["feet"] = robot.attachments(), robot.feet()
        root["heights"] = self.heights
        root["support"] = SUPPORTS.index(self.support)
        frame = self.standing()[0]
        feet = self.feet_on_ground()
        root["anchor"] = feet[frame].mean(axis=0)
        root["heading"] = heading_of(self.pose[3:6]) + (self.twist if frame == 1 else 0.0)
        root["offset"], root["twist"] = self.offset, self.twist
        root["guard"] = robot.mechanism.guard
        root["mass_frames"], root["mass_height"] = robot.mass.frames, robot.mass.height
        root["share_y"] = 1.0 - robot.mass.share_delta
        moment = arm_moment(robot, self.payload)
        root["mass_arm"], root["moment_out"], root["moment_up"] = moment.mass, moment.out, moment.up
        edges = support_edges(feet[list(self.standing())].reshape(-1, 3)[:, :2])
        root["edges"][: len(edges)], root["n_edges"] = edges, len(edges)
        return out


def support_edges(points: Floats) -> Floats:
    """Edges of the hull of points as inwards unit normals and offsets, n.p - c the distance inside [m], shape (edges, 3)."""
    from scipy.spatial import ConvexHull

    equations = ConvexHull(points).equations
    out: Floats = np.column_stack([-equations[:, :2], equations[:, 2]])
    return out
