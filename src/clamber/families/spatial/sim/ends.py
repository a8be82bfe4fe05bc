"""The end effectors of a robot while it moves: they attach to holds on command, bear what their data sheets say, and come off beyond."""

import math
from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from ....compiled import Handle, ready
from ....control.quintic import quintic_share
from ....execution.plant import HoldBreak, PlantStoppedError
from ....types import Floats, Ints
from ..robot.contacts import SHUTTING
from ..robot.robot import SpatialRobot
from ..world.solids import frame_about
from ..world.world import World
from .end_kernels import END, FORMS, WORDS, feel_ends, held_by, nearest_holds
from .spatial_flaws import Deviations, SpatialFlaws
from .spatial_model import ON_SOLIDS, THICK, TIP, held_name, patch_name, quaternion, tip_name

GIVING_WAY: Final = 0.02
"""An end effector comes off after that long above its strength; shorter knocks, as when it lands, break nothing [s]."""
CLOSE: Final = 0.1
"""An end effector attaches from this part of its capture distance out of the surface, or into it [-]."""
TOUCH: Final = 0.0002
"""Forces below this part of the strength of a hook or of spines, which nothing pulls on, neither slip nor leave [-]."""
SEATED: Final = 1e-5
"""A tip that is so near where it belongs is not drawn there [m]."""
FAR: Final = 1e3
"""Where patches are of limbs near no hold [m]."""


class Seen(NamedTuple):
    """End effectors, what they feel and the holds around them; a NamedTuple, as kernels take it."""

    ends: npt.NDArray[np.void]
    """Records of `END`, shape (limbs,)."""
    axes: Floats
    """Of all sites in the world, row by row, shape (sites, 9)."""
    tips: Floats
    """Where all sites are, world frame [m], shape (sites, 3)."""
    sites: Ints
    """Of the end effectors, shape (limbs,)."""
    readings: Floats
    """Force and moment of what carries each tip on it, in its own frame, shape (limbs, 6)."""
    shutting: Ints
    """Ticks until jaws have shut: what they draw with themselves is not counted. Shape (limbs,)."""
    wrenches: Floats
    """Of the surface on each tip, world frame [N], [N m], shape (limbs, 6)."""
    local: Floats
    """The same in the end effector's frame."""
    given: Ints
    """What gives way (`WORDS`); `HOLDS` of those that are not attached. Shape (limbs,)."""
    places: Floats
    """Of the holds [m], shape (holds, 3)."""
    normals: Floats
    """Out of their surfaces, shape (holds, 3)."""
    radii: Floats
    """Of their patches [m], shape (holds,); negative: the hold is no more."""
    recessed: npt.NDArray[np.bool_]
    """Whether they lie deeper than was believed, shape (holds,)."""
    numbers: Floats
    """MuJoCo's `qpos`, of which none is finite any more once its numbers are lost."""


class Ends:
    """End effectors and the holds beneath them.

    An end effector that is told to attach does so as soon as it is on the patch of a hold, or beside it within its capture distance, and
    points into that hold within its tilt. One that centres itself then draws its tip to the hold's place, and is attached, as its switch
    says, once it has shut; others are held where they are. Directions are held as they are if it bears moments. It comes off when the
    wrench on it has been outside its exact body (`contacts.Strength`) for `GIVING_WAY`; a hold that was weaker than the end effector is
    then gone for good.

    Args:
        robot: Whose they are.
        world: Its holds as believed.
        deviations: How they truly are.
        flaws: Share of attempts that fail, and the seed.
        model, data: MuJoCo's, of `spatial_spec`.
    """

    def __init__(
        self, robot: SpatialRobot, world: World, deviations: Deviations, flaws: SpatialFlaws, model: Any, data: Any
    ) -> None:
        import mujoco

        self._mujoco, self._model, self._data, self._flaws = mujoco, model, data, flaws
        self._strengths = strengths = [end.bears() for end in robot.ends]
        names = robot.limb_names
        n = len(names)
        self._places, self._normals = deviations.places, deviations.normals
        sunk = np.einsum("ij,ij->i", deviations.places - world.places, world.normals)
        self._recessed = sunk < 0.0
        self._own_radii = np.array([hold.radius for hold in world.holds])
        self._radii = self._own_radii.copy()
        inf = math.inf
        self._hold_mu = np.array([inf if hold.friction is None else hold.friction for hold in world.holds])
        self._own_pull = np.array([inf if hold.strength is None else hold.strength for hold in world.holds])
        self._hold_pull = self._own_pull.copy()
        self._grip_factor, self._slip_factor = deviations.strengths, deviations.frictions
        self._numbers = [hold.number for hold in world.holds]
        self._ends = np.zeros(n, END)
        for end, strength in zip(self._ends, strengths, strict=True):
            end["form"] = FORMS[strength.form]
            for key in ("friction", "pull", "press", "bending", "twisting", "moments"):
                end[key] = getattr(strength, key)
            end["half1"], end["half2"] = strength.halves
            end["slope"] = math.tan(strength.angle)
            end["touch"] = TOUCH * strength.pull
        self._capture = np.array([strength.capture for strength in strengths])
        sites = np.array([model.site(tip_name(name)).id for name in names])
        self._bodies = [model.body(tip_name(name)).id for name in names]
        self._site_places, self._site_axes, self._sites = data.site_xpos, data.site_xmat, sites
        self._held = [
            model.equality(held_name(name)).id if c else -1 for name, c in zip(names, self._capture, strict=True)
        ]
        self._patches = [model.geom(patch_name(name)).id for name in names]
        self._mocaps = [int(model.body(patch_name(name)).mocapid[0]) for name in names]
        self._balls = [
            [geom for geom in range(model.ngeom) if model.geom_bodyid[geom] == body] for body in self._bodies
        ]
        self._contype = model.geom_contype
        self._bits = [int(self._contype[balls[0]]) for balls in self._balls]
        self._limit = max(1, round(GIVING_WAY * flaws.control_rate))
        self.wrenches: Final = np.zeros((n, 6))
        """Of the surface on each tip, world frame, shape (limbs, 6) [N], [N m]."""
        self.local: Final = np.zeros((n, 6))
        """The same in the end effector's frame."""
        self._ends["capture"], self._ends["under"] = self._capture, -2
        self._ends["near"] = 2.0 * self._capture + [self._reach(limb) for limb in range(n)]
        self._nearest, self._under, self._gaps = (self._ends[key] for key in ("nearest", "under", "gap"))
        self._wanted, self._spent = self._ends["wanted"], self._ends["spent"]
        self.shutting: Final = np.zeros(n, np.int32)
        """Ticks until jaws have shut, shape (limbs,)."""
        self._anchors, self._seats = (
            np.zeros((n, 3)),
            np.zeros((n, 3)),
        )  # where they closed, and where they draw the tip to
        self._ticks = max(1, round(SHUTTING * flaws.control_rate))
        self.closed: Final = np.zeros(n, np.int32)
        """1 of those that are attached, shape (limbs,)."""
        self.broken: tuple[HoldBreak, ...] = ()
        """Since the reset."""
        self._chance = np.random.default_rng(flaws.seed)
        seen = Seen(
            ends=self._ends,
            axes=data.site_xmat,
            tips=data.site_xpos,
            sites=sites,
            readings=data.sensordata.reshape(n, 6),
            shutting=self.shutting,
            wrenches=self.wrenches,
            local=self.local,
            given=np.zeros(n, np.int64),
            places=self._places,
            normals=self._normals,
            radii=self._radii,
            recessed=self._recessed,
            numbers=data.qpos,
        )
        self._given, self._handle = seen.given, Handle(seen)
        self._nearest_holds, self._feel_ends = ready(nearest_holds, self._handle), ready(feel_ends, self._handle)
        self._held_by = ready(held_by, self._handle, np.empty(n, np.int32))

    @property
    def attached(self) -> Ints:
        """Index of the hold that each is attached to; of what only pushes the one that it pushes on; -1: none. Shape (limbs,)."""
        found = np.empty(len(self._ends), np.int32)
        self._held_by(found)
        return found

    def reset(self, held: Sequence[int] | Ints) -> None:
        """Attach limbs to holds, -1: to none, where their tips are; the others are open."""
        self._radii[:], self._hold_pull[:] = self._own_radii, self._own_pull
        self._wanted[:] = self._spent[:] = False
        self.closed[:] = 0
        self._ends["hold"], self.broken = -1, ()
        self._under[:] = -2
        self._chance = np.random.default_rng(self._flaws.seed)
        for limb, hold in enumerate(held):
            self._let_go(limb)
            if hold >= 0 and self._capture[limb] > 0.0:
                self._wanted[limb] = True
                self._attach(limb, int(hold))
                self.shutting[limb], self.closed[limb] = 0, 1  # shut long since
        self.look()

    def places(self, held: Sequence[int] | Ints) -> Floats:
        """Where the tips of limbs on holds truly are, shape (limbs, 3) [m]."""
        at: Floats = self._places[np.asarray(held)]
        return at

    def grip(self, limb: int, close: bool) -> None:
        """Tell an end effector to attach or to let go."""
        if not self._capture[limb]:
            return
        self._wanted[limb] = close
        if not close:
            self._spent[limb] = False
            if self._ends["hold"][limb] >= 0:
                self._let_go(limb)

    def weaken(self, hold: int, strength: float) -> None:
        """Have a hold, by its index, bear a pull of `strength` [N] at most, until the next reset."""
        self._hold_pull[hold] = strength / self._grip_factor[hold]
        attached = self._ends["hold"] == hold
        self._ends["held"][attached] = np.minimum(self._ends["held"][attached], strength)

    def look(self) -> None:
        """Bring the nearest hold beneath every tip, and attach what is to attach: before the physics of a control period."""
        limbs = self._nearest_holds()
        if limbs:
            for limb, hold in enumerate(self._nearest.tolist()):
                if not limbs >> limb & 1:
                    continue
                if hold != self._under[limb]:
                    self._put_beneath(limb, hold)
                if self._capture[limb] and self._ends["hold"][limb] < 0:
                    self._open_recess(limb, hold)
                    if self._wanted[limb] and not self._spent[limb] and self._catches(limb, hold):
                        self._take(limb, hold)
                if self.shutting[limb]:
                    self._shut(limb)

    def _take(self, limb: int, hold: int) -> None:
        """Attach a limb, unless the attempt fails."""
        if self._flaws.miss > 0.0 and self._chance.random() < self._flaws.miss:
            self._spent[limb] = True
        else:
            self._attach(limb, hold)

    def feel(self, time: float) -> None:
        """See what acts on tips, and let come off what bears too much: after the physics of a control period that ends at `time` [s].

        Raises:
            PlantStoppedError: If the simulation has lost its numbers.
        """
        felt = self._feel_ends()
        if felt < 0:
            raise PlantStoppedError("the simulation has lost its numbers")
        if felt:
            for limb in np.flatnonzero(self._ends["over"] >= self._limit).tolist():
                self._come_off(limb, time)

    def _catches(self, limb: int, hold: int) -> bool:
        if hold < 0 or self._gaps[limb] > 2.0 * self._capture[limb]:
            return False
        capture, off = self._capture[limb], self._site_places[self._sites[limb]] - self._places[hold]
        out = float(off @ self._normals[hold])
        aside = math.sqrt(max(0.0, float(off @ off) - out * out)) - self._own_radii[hold]
        deep = self._strengths[limb].jaws / 2.0 or CLOSE * capture
        return abs(out) <= deep and aside <= capture and self._tilt(limb, hold) <= self._strengths[limb].tilt

    def _tilt(self, limb: int, hold: int) -> float:
        inward = -float(self._site_axes[self._sites[limb]].reshape(3, 3)[:, 2] @ self._normals[hold])
        return math.acos(min(1.0, max(-1.0, inward)))

    def _friction(self, limb: int, hold: int) -> float:
        return float(self._slip_factor[hold] * min(self._strengths[limb].friction, self._hold_mu[hold]))

    def _put_beneath(self, limb: int, hold: int) -> None:
        """Put a hold's patch beneath a limb."""
        self._under[limb] = hold
        geom, mocap = self._patches[limb], self._mocaps[limb]
        if hold < 0 or self._strengths[limb].jaws:  # jaws close about what they hold, and lie on nothing
            self._data.mocap_pos[mocap] = (FAR, FAR, FAR)
            return
        radius, normal = self._own_radii[hold] + self._reach(limb), self._normals[hold]
        self._model.geom_size[geom, 0] = radius
        self._model.geom_rbound[geom] = math.hypot(radius, THICK)
        self._model.geom_aabb[geom, 3:] = radius, radius, THICK
        self._model.geom_friction[geom, 0] = max(self._friction(limb, hold), 1e-5)
        self._data.mocap_pos[mocap] = self._places[hold] - (TIP + THICK) * normal
        self._data.mocap_quat[mocap] = quaternion(self._mujoco, frame_about(normal).T)

    def _reach(self, limb: int) -> float:
        """How far beside a hold an end effector may be that attaches to it [m]."""
        return float(self._capture[limb]) + math.hypot(*self._strengths[limb].halves)

    def _open_recess(self, limb: int, hold: int) -> None:
        """A hold that lies deeper than was believed is the bottom of a recess, into which what attaches there can come."""
        bits = self._bits[limb]
        sunk = hold >= 0 and bool(self._recessed[hold]) and self._gaps[limb] <= self._reach(limb)
        self._ends["sunk"][limb] = sunk
        self._touch(limb, bits & (1 << ON_SOLIDS) - 1 if sunk else bits)

    def _attach(self, limb: int, hold: int) -> None:
        data, eq, body = self._data, self._model.eq_data[self._held[limb]], self._bodies[limb]
        strength, end = self._strengths[limb], self._ends[limb]
        if strength.moments:  # a weld: anchor in the world, in the body, turn from it to the world
            eq[3:6] = 0.0
            eq[6:10] = data.xquat[body] * (1.0, -1.0, -1.0, -1.0)
        else:
            eq[:3] = 0.0
        self._anchors[limb] = data.xpos[body]
        self._seats[limb] = self._seat(limb, hold)
        self._hold_at(limb, self._anchors[limb])
        data.eq_active[self._held[limb]] = 1
        own = strength.pull * max(0.0, 1.0 - strength.tilt_loss * self._tilt(limb, hold))
        end["hold"], end["over"], end["normal"] = hold, 0, self._normals[hold]
        self._nearest[limb], self._gaps[limb] = hold, 0.0
        end["mu"] = self._friction(limb, hold)
        end["held"] = self._grip_factor[hold] * min(own, self._hold_pull[hold])
        self._touch(limb, 0)
        drawn = float(np.linalg.norm(self._seats[limb] - self._anchors[limb])) > SEATED
        self.shutting[limb] = self._ticks if drawn else 0
        self.closed[limb] = not drawn

    def _hold_at(self, limb: int, place: Floats) -> None:
        """Have the tip of a limb that is attached at a place [m]."""
        first = 0 if self._strengths[limb].moments else 3
        self._model.eq_data[self._held[limb], first : first + 3] = place

    def _seat(self, limb: int, hold: int) -> Floats:
        """Where an end effector that closes about a hold comes to lie [m], shape (3,)."""
        strength, at = self._strengths[limb], self._anchors[limb]
        off, normal = self._places[hold] - at, self._normals[hold]
        if strength.jaws:
            off = off - (off @ normal) * normal
        if strength.bar:
            along = self._site_axes[self._sites[limb]].reshape(3, 3)[:, 0]
            along = along - (along @ normal) * normal
            off = off - (off @ along) / max(float(along @ along), 1e-12) * along
        seat: Floats = at + off if float(np.linalg.norm(off)) <= strength.centring else at.copy()
        return seat

    def _shut(self, limb: int) -> None:
        """Jaws shut a little further, from rest to rest."""
        self.shutting[limb] -= 1
        share = quintic_share(1.0 - self.shutting[limb] / self._ticks)
        self._hold_at(limb, self._anchors[limb] + share * (self._seats[limb] - self._anchors[limb]))
        self.closed[limb] = not self.shutting[limb]

    def _let_go(self, limb: int) -> None:
        if self._held[limb] >= 0:
            self._data.eq_active[self._held[limb]] = 0
        self._ends["hold"][limb], self._ends["over"][limb] = -1, 0
        self._touch(limb, self._bits[limb])
        self.closed[limb] = self.shutting[limb] = 0

    def _come_off(self, limb: int, time: float) -> None:
        hold = int(self._ends["hold"][limb])
        force = float(np.linalg.norm(self.wrenches[limb, :3]))
        why = f"{WORDS[self._given[limb]]} at {force:.1f} N"
        self.broken = (*self.broken, HoldBreak(time, self._numbers[hold], force, why))
        if self._hold_pull[hold] < self._strengths[limb].pull:
            self._radii[hold] = -1.0
        self._let_go(limb)
        self._spent[limb] = True

    def _touch(self, limb: int, bits: int) -> None:
        """Have a tip touch what has one of these bits of MuJoCo's `conaffinity`."""
        self._contype[self._balls[limb]] = bits
