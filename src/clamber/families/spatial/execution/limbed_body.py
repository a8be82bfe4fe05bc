"""A robot in space under a law of its whole body: a tick, and what its limbs hold on to as it believes."""

import math
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from ....compiled import Handle, ready
from ....control.whole_body.programme import FREE_LIMB, HOLDS, SWINGS, Gains
from ....control.whole_body.tree import FREE
from ....execution.run_report import FallenError
from ....types import Floats, Ints
from ..control.believed_tree import believed_tree, joint_limits
from ..control.laws import USUAL, body_law
from ..control.task_kernels import bear_loads, count_open, find_resting
from ..robot.contacts import MOST_ROWS
from ..robot.robot import SpatialRobot
from ..world.world import World
from .belief import Belief
from .centred_loads import LoadCentre, contact_rows
from .course import Standing
from .plant import Pose, SpatialPlant, SpatialSensed
from .sensor_watch import Guard, SensorWatch
from .settings import Pace, usual_gains

OPEN: Final = 3
"""Ticks after which a switch is believed that says that an end effector has come off."""
FELT: Final = 3
"""Readings in a row by which a foot feels its ground."""
SURE: Final = 1.5
"""With what a foot is pressed on that has felt its ground, of the force by which it feels it [-]."""
LIFTED: Final = 0.05
"""A foot that stands and feels nothing for that part of a shift of load is in the air [-]."""
NESTED: Final = 0.9
"""Of friction and pull that contacts are relied on for: the planner keeps its need within this, and the contacts bear more [-]."""


class Limbs(NamedTuple):
    """What limbs hold on to and feel, as believed, shape (limbs,) each unless said otherwise; a NamedTuple, as kernels take it."""

    holds: Ints
    """Index of the hold that each holds on to; -1: none."""
    resting: Ints
    """The same of those whose tips stay there."""
    pushing: npt.NDArray[np.bool_]
    """Whether it stands by friction alone."""
    loads: Floats
    """Wrenches that contacts are to bear, world frame, shape (limbs, 6)."""
    felt: Ints
    """Readings in a row above `touch`."""
    met: Floats
    """Tick of the last of them."""
    open: Ints
    """Ticks for which a limb that is to hold on has not."""
    sought: Floats
    """How deep feet in the air have felt for their ground [m]; NaN: they are not in the air."""
    lean: Floats
    """How far the centre of mass is from where it is believed to be, as tips have told, base frame [m], shape (3,)."""


class LostHoldError(Exception):
    """A limb that held on has come off.

    Args:
        limb: Which.
        hold: Index of the hold that it held on to.
        gone: Whether the hold is not to be taken again.
    """

    def __init__(self, limb: int, hold: int, *, gone: bool = False) -> None:
        super().__init__(limb, hold)
        self.limb, self.hold, self.gone = limb, hold, gone


class LimbedBody:
    """A robot that holds on with its limbs and moves as it is told to.

    Args:
        robot: The robot.
        world: As believed.
        plant: What moves.
        belief: Where it believes to be.
        pace: How quickly it moves.
        lift: Height of swinging tips over their holds [m].
        gains: Of its law; None: the usual ones for its size.
        law: Its name, of `BODY_LAWS`.
    """

    def __init__(
        self,
        robot: SpatialRobot,
        world: World,
        plant: SpatialPlant,
        belief: Belief,
        pace: Pace,
        lift: float,
        gains: Gains | None = None,
        law: str = USUAL,
    ) -> None:
        self.robot, self.world, self.plant, self.belief = robot, world, plant, belief
        self.pace, self.lift = pace, lift
        tree = believed_tree(robot, world.gravity)
        self.law = body_law(law)(tree, joint_limits(robot), gains or usual_gains(robot), MOST_ROWS)
        self._friction = self.law.limits.friction.copy()
        limbs = tree.limbs
        self.sensed = SpatialSensed.of(robot.chains)
        self.watch: Final = SensorWatch(robot, self.law, plant.period)
        self._guard: Guard | None = None
        self._bears = [end.bears() for end in robot.ends]
        self._limbs = of = Limbs(
            holds=np.full(limbs, -1, np.int32),
            resting=np.full(limbs, -1, np.int32),
            pushing=np.array([not self.attaches(limb) for limb in range(limbs)]),
            loads=np.zeros((limbs, 6)),
            felt=np.zeros(limbs, np.int64),
            met=np.full(limbs, -math.inf),
            open=np.zeros(limbs, np.int64),
            sought=np.full(limbs, math.nan),
            lean=np.zeros(3),
        )
        self.holds, self.loads, self.lean = of.holds, of.loads, of.lean
        """As `Limbs` has them."""
        self._felt, self._met, self._open, self._sought = of.felt, of.met, of.open, of.sought
        self.peaks: Floats = np.zeros(2)
        """Largest so far: `off` [m], and share of a motor's torque that was asked for [-]."""
        self._take_hold()
        self.places: Floats = np.zeros((limbs, 3))
        """Where the tips of limbs hold on, as believed [m], shape (limbs, 3)."""
        self.off = 0.0
        """How far it is from where it is to be, as believed [m]."""
        self.fading = -1
        """The limb whose load fades before it lets go; -1: none."""
        self.ticks = 0
        self._pressed = np.zeros((limbs, 3))
        """Normals that limbs press against, shape (limbs, 3)."""
        self.locked: dict[int, float] = {}
        """Joint that is locked -> where [rad] or [m]."""
        self._presses = False
        self._push = np.zeros(limbs)
        self._aimed = np.zeros((limbs, 3))
        """Where tips are to be that press, deep as that may be [m], shape (limbs, 3)."""

    @property
    def time(self) -> float:
        """Since the start [s]."""
        return self.ticks * self.plant.period

    @property
    def tips(self) -> Floats:
        """Where the tips are, as believed [m], shape (limbs, 3)."""
        return self.law.dynamics.tip

    def joints_of(self, limb: int) -> tuple[int, int]:
        """First joint of a limb, and the one behind its last."""
        ends = np.cumsum(self.robot.chains.n_joints)
        return int(ends[limb] - self.robot.chains.n_joints[limb]), int(ends[limb])

    def attaches(self, limb: int) -> bool:
        """Whether a limb's end effector attaches, in place of only pushing."""
        return self._bears[limb].capture > 0.0

    def start(self, at: Standing) -> None:
        """Put the robot on its holds."""
        self.plant.reset(at.pose, at.joints, at.holds)
        self.sensed = self.plant.sense()
        self.belief.begin(at.pose, self.sensed)
        self._believe()
        self.law.look()
        aims = self.law.aims
        aims.rotation[:], aims.position[:] = at.pose.rotation, at.pose.position
        aims.posture[:], aims.base_integral[:] = at.joints, 0.0
        self.loads[:] = at.loads
        for limb, hold in enumerate(at.holds.tolist()):
            if self.attaches(limb):
                self.plant.grip(limb, True)
            self.hold_on(limb, hold)

    def hold_on(self, limb: int, hold: int) -> None:
        """From now on a limb holds on to a hold where its tip is."""
        self.relax(limb)
        self._open[limb], self._sought[limb] = 0, math.nan
        aims, dynamics = self.law.aims, self.law.dynamics
        turn = dynamics.tip_turn[limb]
        aims.frame[limb], rows, limits = contact_rows(self.robot, self.world, limb, hold, turn, NESTED)
        aims.components[limb], aims.n_rows[limb] = self.robot.contacts[limb].components, len(rows)
        aims.rows[limb, : len(rows)], aims.limits[limb, : len(rows)] = rows, limits
        aims.does[limb], aims.cap[limb] = HOLDS, math.inf
        self._bear_friction(limb, False)
        self.holds[limb], self.places[limb] = hold, dynamics.tip[limb]

    def let_go(self, limb: int) -> None:
        """From now on a limb bears nothing."""
        self.relax(limb)
        self.law.aims.does[limb], self.holds[limb] = FREE_LIMB, -1
        self._bear_friction(limb, True)
        self.loads[limb], self._sought[limb] = 0.0, math.nan

    def _bear_friction(self, limb: int, bears: bool) -> None:
        """Have the law know what a limb's gears rub, or not while it holds on: that damps gears whose load passes through 0."""
        mine = slice(*self.joints_of(limb))
        self.law.limits.friction[mine] = self._friction[mine] if bears else 0.0

    def swing(self, limb: int, path: tuple[Floats, Floats, Floats], points: Floats | None) -> None:
        """Where a limb's tip is to be, with velocity and acceleration, and which way its end effector is to point."""
        aims = self.law.aims
        aims.does[limb] = SWINGS
        aims.tip[limb], aims.tip_velocity[limb], aims.tip_acceleration[limb] = path
        self._aimed[limb] = path[0]
        on = self._presses and not self._in_air(limb)
        if self._limbs.pushing[limb]:
            self._push[limb] = SURE * self.pace.touch if on else 0.0
        if on:
            # The spring of `_press` alone presses: the limb's inertia would push along a stretched limb, and slide it
            normal = self._pressed[limb]
            aims.tip[limb] += float((self.tips[limb] - path[0]) @ normal) * normal
            aims.tip_velocity[limb] -= float(path[1] @ normal) * normal
        aims.points[limb] = 0.0 if points is None else points

    def press(self, limb: int, normal: Floats, force: float = 0.0) -> None:
        """From now on a swinging limb presses against a surface, until it holds on or is to relax.

        Args:
            limb: Which.
            normal: Of the surface.
            force: With which it presses, besides what it misses of its aim makes [N].
        """
        self._pressed[limb], self._push[limb], self._presses = normal, force, True

    def relax(self, limb: int) -> None:
        """From now on a limb presses against nothing."""
        self._pressed[limb] = self._push[limb] = 0.0
        self._presses = bool(self._pressed.any())

    def tick(self) -> None:
        """Let a control period pass.

        Raises:
            LostHoldError: If an end effector that is attached has come off.
            FallenError: If the body is not where it is to be by far.
            FaultError: If a sensor, a motor or the link has failed.
            PlantStoppedError: If the plant takes no more commands.
        """
        law = self.law
        self.sensed = self.plant.sense()
        for joint, place in self.locked.items():
            self.sensed.joints[:, joint], self.sensed.torques[joint] = (place, 0.0), 0.0
        self.watch.see(self.sensed, self.holds)
        self._believe()
        if self._guard is not None:
            self._hold_posture(self._guard)
            return
        if self.watch.sliding is not None:
            self._catch_slide(self.watch.sliding)
        self.off = self._bear_loads(self.pace.touch, self.fading, self.pace.stand, self.ticks)
        self._press(law.tick())
        self.plant.actuate(law.torques)
        self.plant.step()
        self.ticks += 1
        open_ones = self._count_open(self.fading, self.off)
        if self.off > self.pace.lost:
            raise FallenError(f"the body is {1e3 * self.off:.0f} mm from where it is to be")
        if open_ones:
            self._feel_holds()

    def _catch_slide(self, limb: int) -> None:
        """A foot that has slid stands where it is now; one that slides again is lifted, if the others can bear the robot.

        Raises:
            LostHoldError: If it is lifted: it is to go elsewhere.
        """
        watch, state, hold = self.watch, self.law.state, int(self.holds[limb])
        watch.sliding, others = None, self.holds.copy()
        others[[limb] if self.fading < 0 else [limb, self.fading]] = -1
        pose = Pose(state.rotation, state.position)
        watch.slid[limb] += 1
        if watch.slid[limb] > 1 and LoadCentre(self.robot, self.world).bears(pose, state.joints, others, NESTED):
            self.let_go(limb)
            raise LostHoldError(limb, hold, gone=True)
        self.hold_on(limb, hold)
        watch.forget_place(limb)

    def lock(self, joint: int) -> None:
        """From now on the brake of a joint that has failed holds it, what its sensors say is not heard, and the robot stays as it is.

        The tick in which that was noticed comes to its end.
        """
        self.plant.brake(joint)
        self.plant.step()
        self.ticks += 1
        self.watch.leave_out(joint)
        limits, place = self.law.limits, float(self.law.state.joints[joint])
        self.locked[joint] = limits.lower[joint] = limits.upper[joint] = place
        self.stop()
        self.law.aims.tip[:], self.law.aims.tip_velocity[:], self.law.aims.tip_acceleration[:] = self.tips, 0.0, 0.0

    def brace(self) -> None:
        """From now on the robot holds its posture, joint by joint: something of it has failed."""
        self._guard = self.watch.guard(self.sensed)

    def _hold_posture(self, guard: Guard) -> None:
        """What is left of a tick of a robot that has stopped; one that its link does not reach holds its posture by itself."""
        if self.watch.monitor.linked:
            guard.hold(self.sensed, self.law.torques)
            self.plant.actuate(self.law.torques)
        self.plant.step()
        self.ticks += 1

    def _press(self, torques: Floats) -> None:
        """What pressing limbs miss of their aims, as springs would press: their own inertia is too little."""
        law, stiffness = self.law, self.pace.pressing
        if not self._presses:
            return
        for limb in np.flatnonzero(self._pressed.any(axis=1)).tolist():
            normal = self._pressed[limb]
            missed = law.dynamics.tip[limb] - self._aimed[limb]
            force = self._push[limb] + stiffness * max(0.0, float(missed @ normal))
            torques -= force * (normal @ law.dynamics.jacobian[limb, :3, FREE:])
            np.clip(torques, -law.limits.torque, law.limits.torque, out=torques)

    def seeks(self, limb: int) -> bool:
        """Whether a limb that was to stand on its hold is in the air, and feels for it."""
        return not math.isnan(self._sought[limb])

    def _feel_holds(self) -> None:
        """Notice what has come off, and have feet that were lifted off their holds find them again."""
        for limb, hold in enumerate(self.holds.tolist()):
            if hold >= 0 and self.seeks(limb) and limb != self.fading:
                self._seek(limb, hold)
            elif self.attaches(limb) and self._open[limb] == OPEN:
                self._open[limb] = 0
                if not self.sensed.shutting[limb]:
                    self.let_go(limb)
                    raise LostHoldError(limb, hold)
            elif self._open[limb] * self.plant.period > LIFTED * self.pace.shift:
                self._sought[limb], self._open[limb] = 0.0, 0
                self.press(limb, self.world.normals[hold])

    def feels(self, limb: int) -> bool:
        """Whether a foot feels what it stands on: one reading may be noise, a few in a row are not."""
        return int(self._felt[limb]) >= FELT

    def _in_air(self, limb: int) -> bool:
        """Whether a limb has felt nothing for a while."""
        return bool((self.ticks - self._met[limb]) * self.plant.period > LIFTED * self.pace.shift)

    def _seek(self, limb: int, hold: int) -> None:
        """Feel on along the inward normal for what a foot stood on."""
        aims, inward = self.law.aims, -self.world.normals[hold]
        deep = float((self.tips[limb] - self.places[limb]) @ inward)
        if self.feels(limb) and deep <= self.pace.deep:
            self.hold_on(limb, hold)
            return
        velocity = self.pace.approach * inward
        self._sought[limb] += self.pace.approach * self.plant.period
        if max(deep, float(self._sought[limb])) > self.pace.deep:
            self.let_go(limb)
            raise LostHoldError(limb, hold)
        swings = aims.does[limb] == SWINGS
        before = self._aimed[limb] if swings else self.tips[limb]
        aim = before + self.plant.period * velocity
        pointed = inward if self.robot.contacts[limb].aligned else None
        self.swing(limb, (aim, velocity, np.zeros(3)), pointed)

    def over_holds(self, at: Standing) -> Floats:
        """Where the base is to be so that the robot's weight lies over its tips as in a stance of its plan [m], shape (3,).

        Tips stand beside where the map has their holds, and links weigh more or less than their file says; balance goes with both.
        """
        on = np.flatnonzero(self.holds >= 0)
        away = self.tips[on] - self.world.places[self.holds[on]]
        place: Floats = at.pose.position + away.mean(axis=0) - at.pose.rotation @ self.lean
        return place

    def stop(self) -> None:
        """From now on the body is to stay where it is."""
        aims, state = self.law.aims, self.law.state
        aims.position[:], aims.rotation[:] = state.position, state.rotation
        aims.velocity[:] = aims.acceleration[:] = 0.0

    def _take_hold(self) -> None:
        """Have kernels work on the readings that there are."""
        law = self.law
        rest = law.tree, law.dynamics, law.packed, self.plant.period, law.torques, law.limits.torque, self.peaks
        self.handle: Handle = Handle(self.sensed, law.aims, law.state, self._limbs, rest)
        """What kernels of `task_kernels` take."""
        self._find_resting = ready(find_resting, self.handle)
        self._bear_loads = ready(bear_loads, self.handle, 0.0, 0, 0.0, 0)
        self._count_open = ready(count_open, self.handle, 0, 0.0)

    def _believe(self) -> None:
        if self.handle.held[0] is not self.sensed:
            self._take_hold()
        self._find_resting()
        moved = self.belief.update(self.sensed, self._limbs.resting, self.law.state)
        if moved is not None:  # in the world, not on its holds: it is to stay where it is on them
            aims = self.law.aims
            aims.rotation[:] = moved.rotation @ aims.rotation
            aims.position[:] = moved.rotation @ aims.position + moved.position
