"""A robot in space that works out where it is: from encoders, IMU and contacts, with a map of holds that its touches correct."""

from typing import Final

import numpy as np

from ....compiled import Handle, ready
from ....control.whole_body.tree import State, Tree
from ....types import Floats, Ints
from ..control.base_filter import LEAST, BaseFilter, FilterSettings, Followed
from ..control.base_filter_kernels import believe, tell
from ..robot.parts import Motors
from ..robot.robot import SpatialRobot
from ..world.solids import frame_about
from ..world.world import World
from .plant import Pose, SpatialSensed

FIRM: Final = 0.03
"""A motor that gives this part of its torque pushes its joint's play to one side [-]."""
IDENTITY: Final = np.eye(3)
SPEED_BAND: Final = 120.0
"""Of the tracking filter that makes speeds of the angles of coarse encoders [rad/s]."""


class EstimatedBase:
    """A `Belief` by a contact-aided invariant filter.

    Args:
        robot: The robot.
        world: As believed.
        tree: The robot's, as believed.
        period: Between ticks [s].
        late: By which sensors tell what was, as their data sheets say [s]; beliefs are of now.
        coarse: Whether encoders are too coarse to tell speeds.
        play: Whole play of each turning joint, as its data sheet says [rad]: its output lies to the side that its motor pushes from.
        settings: Of the filter.
    """

    def __init__(
        self,
        robot: SpatialRobot,
        world: World,
        tree: Tree,
        period: float,
        *,
        late: float = 0.0,
        coarse: bool = False,
        play: float = 0.0,
        settings: FilterSettings = FilterSettings(),  # noqa: B008  # frozen
    ) -> None:
        self._tree, self._period, self._late = tree, period, late
        limbs = tree.limbs
        directed = np.array([end.bears().moments for end in robot.ends], np.int32)
        tracking = (float(np.exp(-SPEED_BAND * period)) if coarse else -1.0, period)
        self.filter: Final = BaseFilter(limbs, tracking, directed, np.array(world.gravity), settings)
        self.places: Final = world.places.copy()
        """Where holds are, as believed, corrected by touch [m], shape (holds, 3)."""
        self._map, self._normals = world.places.copy(), world.normals.copy()
        self._bears = [end.bears() for end in robot.ends]
        self._spreads = np.full(len(world.holds), settings.hold)
        self._on = np.full(limbs, -1, np.int32)
        self._number = -1
        self._given: tuple[SpatialSensed, Ints, State] | None = None
        motors = Motors.of(robot)
        self._body = Followed.of(tree, FIRM * motors.torque, np.where(motors.sliding, 0.0, play / 2.0))

    def begin(self, pose: Pose, sensed: SpatialSensed) -> None:
        """See `Belief`."""
        self.filter.begin(pose.rotation, pose.position)
        self._on[:] = -1
        self._body.own.joints[:] = sensed.joints[0]
        self._body.own.speed[:] = self._body.pushed[:] = 0.0
        self._number = int(sensed.number[0])

    def update(self, sensed: SpatialSensed, holds: Ints, state: State) -> Pose | None:
        """See `Belief`."""
        before, self._number = self._number, sensed.number.item(0)
        given = self._given
        if given is None or not (given[0] is sensed and given[1] is holds and given[2] is state):
            self._take_hold(sensed, holds, state)
        if self._believe((self._number - before) * self._period, self._late):
            return None
        self._tell(self._late)
        rotation, position = state.rotation.copy(), state.position.copy()
        for limb in np.flatnonzero(holds != self._on).tolist():
            self._change(limb, int(holds[limb]))
        self._tell(self._late)
        turn = state.rotation @ rotation.T
        return Pose(turn, state.position - turn @ position)

    def _take_hold(self, sensed: SpatialSensed, holds: Ints, state: State) -> None:
        """Have kernels work on the arrays that there are."""
        self._given = sensed, holds, state
        handle = Handle(
            sensed, self._tree, self._body, self.filter.believed, self.filter.packed, holds, self._on, state
        )
        self._believe = ready(believe, handle, self._period, self._late)
        self._tell = ready(tell, handle, self._late)

    def _change(self, limb: int, hold: int) -> None:
        """A limb takes a hold, or leaves one: what was felt of that stays in the map."""
        before = self._on[limb]
        if before >= 0:
            self.places[before] = self.filter.believed.places[limb]
            self._spreads[before] = max(self.filter.spread(limb), LEAST)
            self.filter.let_go(limb)
        if hold >= 0:
            work, variance = self._body.work, float(self._body.variances[limb])
            self.filter.hold_on(limb, work.tip[limb], work.tip_turn[limb], variance)
            if self._centred(limb, hold):
                self.filter.take_place(limb, self._map[hold], self._centres(limb, hold))
            else:
                self.filter.take_height(limb, self.places[hold], self._normals[hold], float(self._spreads[hold]) ** 2)
        self._on[limb] = hold

    def _centred(self, limb: int, hold: int) -> bool:
        """Whether a limb's end effector, which has just closed, has drawn its tip to the hold, and to no other by its looks."""
        if not self._bears[limb].centring:
            return False
        away = self.places - self.filter.believed.places[limb]
        return int(np.argmin(np.einsum("ij,ij->i", away, away))) == hold

    def _centres(self, limb: int, hold: int) -> Floats:
        """Axes along which an end effector centres itself on a hold: all, or those across its bar or within its jaws, shape (n, 3)."""
        strength = self._bears[limb]
        if strength.jaws:
            return frame_about(self._normals[hold])[:2]
        if not strength.bar:
            return IDENTITY
        normal, along = self._normals[hold], self.filter.believed.directions[limb, :, 0]
        across: Floats = np.cross(normal, along)
        return np.stack((normal, across / np.linalg.norm(across)))
