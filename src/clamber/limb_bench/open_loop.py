r"""Open loop: steady joint torques on a limb at rest, and where its tip goes first (Bevly 1997, 3.4.3 and figure 3.10).

A law turns what is wanted at the tip into torques by its own transform. Without any feedback one sees the transform alone: J^T F asks
for a force, K' J^-1 a for an acceleration. Torques are scaled until the force that they balance at the tip, J^-T tau, has the same
part along the wanted direction for all transforms.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Annotated, Any, Final

import numpy as np

from ..control.chain import Chain
from ..control.controller import still_aim
from ..errors import UnknownNameError
from ..execution.trace import LimbTrace, empty_trace
from ..json_form import HIDDEN, Jsonable, Key, in_json
from ..sim.bench_limb import BenchLimb
from ..sim.flaw_texts import plant_words
from ..sim.limb_flaws import LimbFlaws
from ..sim.plants import plant_maker
from ..types import Floats
from .measures import components
from .result import Comparison
from .scenario import ScenarioError

FIRST: Final = 1e-3
"""The first motion is the straight line from the start to where the tip is first this far away [m]."""
SCHEMA: Final = "clamber-open-loop-1"
FAR: Final = (0.02, 0.05)
"""Ways along the wanted direction at which the stray is told [m]."""


def _force(chain: Chain, q: Floats, wanted: Floats) -> Floats:
    out: Floats = chain.jacobian(q)[:2].T @ wanted
    return out


def _motion(chain: Chain, q: Floats, wanted: Floats) -> Floats:
    return np.asarray(np.linalg.solve(chain.jacobian(q)[:2], wanted), dtype=np.float64)


TRANSFORMS: Final[dict[str, Callable[[Chain, Floats, Floats], Floats]]] = {
    "jacobian-transpose": _force,
    "scct": lambda chain, q, wanted: chain.joints["share"] * _motion(chain, q, wanted),
    "resolved-rate": _motion,
    "operational-space": lambda chain, q, wanted: chain.inertia(q) @ _motion(chain, q, wanted),
}
"""Law -> torques of a wanted direction at the tip, before they are scaled: J^T d, K' J^-1 d, J^-1 d, H J^-1 d."""


@dataclass(frozen=True, slots=True, eq=False)
class OpenLoopRun(Jsonable):
    """Where the tip of a limb went under one transform's torques."""

    transform: Annotated[str, Key("law")]
    force: Annotated[float, HIDDEN]
    """Part of J^-T tau along the wanted direction at the start [N]."""
    wanted: Annotated[Floats, HIDDEN]
    """The wanted direction, a unit vector, shape (2,)."""
    torques: Annotated[Floats, Key(kind=list[float])]
    """At the start, shape (n,) [N m]."""
    trace: Annotated[LimbTrace, HIDDEN]
    """Every step of the physics; it has no aims and no reports."""
    places: Annotated[Floats, HIDDEN]
    """True tip from the start on, base frame, shape (steps + 1, 2) [m]."""
    predicted: Annotated[float, Key(kind=float | None, after="turned")] = math.nan
    """Angle of the first acceleration from the wanted direction by the dynamics without friction [rad]."""

    @property
    def along(self) -> Floats:
        """Way along the wanted direction [m], shape (steps + 1,)."""
        return components(self.places - self.places[0], self.wanted)[0]

    @property
    def across(self) -> Floats:
        """Way to the left of the wanted direction [m], shape (steps + 1,)."""
        return components(self.places - self.places[0], self.wanted)[1]

    @property
    def distance(self) -> Floats:
        """From the start [m], shape (steps + 1,)."""
        out: Floats = np.linalg.norm(self.places - self.places[0], axis=1)
        return out

    @property
    @in_json(after="strays")
    def moved(self) -> float:
        """Furthest distance from the start [m]."""
        return float(self.distance.max())

    @in_json(after="torques")
    def turned(self, after: float = FIRST) -> float | None:
        """Angle of the motion from the wanted direction over its first `after` metres, anticlockwise positive [rad].

        None: the tip never gets so far.
        """
        distance = self.distance
        if not distance.max() >= after:
            return None
        k = int(np.argmax(distance >= after))
        part = (after - distance[k - 1]) / (distance[k] - distance[k - 1])
        along, across = (a[k - 1] + part * (a[k] - a[k - 1]) for a in (self.along, self.across))
        return math.atan2(across, along)

    def stray(self, after: float) -> float | None:
        """Way to the left of the wanted direction when the tip is first `after` metres along it [m]; None: it never is."""
        along = self.along
        if not along.max() >= after:
            return None
        k = int(np.argmax(along >= after))
        return float(np.interp(after, along[k - 1 : k + 1], self.across[k - 1 : k + 1]))

    @in_json(after="predicted")
    def strays(self) -> tuple["Stray", ...]:
        """At the ways that are told."""
        return tuple(Stray(far, self.stray(far)) for far in FAR)


@dataclass(frozen=True, slots=True)
class Stray:
    """How far a tip strayed from the line of the force."""

    after: float
    """Way of the tip along it [m]."""
    stray: float | None
    """Way to its left [m]; None where the tip never got so far."""


def scaled_torques(chain: Chain, q: Floats, transform: str, wanted: Floats, force: float) -> Floats:
    """Torques of a transform whose tip force J^-T tau has the part `force` along `wanted` [N m], shape (n,).

    Raises:
        UnknownNameError: If there is no such transform.
    """
    if transform not in TRANSFORMS:
        raise UnknownNameError("transform", transform, tuple(TRANSFORMS))
    raw = TRANSFORMS[transform](chain, q, wanted)
    balanced = np.linalg.solve(chain.jacobian(q)[:2].T, raw)
    out: Floats = raw * (force / (balanced @ wanted))
    return out


def first_turn(chain: Chain, q: Floats, torques: Floats, wanted: Floats) -> float:
    """Angle of the tip's first acceleration J H^-1 tau from `wanted` without friction (Bevly 1997, Eq. 3.10) [rad]."""
    first = chain.jacobian(q)[:2] @ np.linalg.solve(chain.inertia(q), torques)
    return math.atan2(wanted[0] * first[1] - wanted[1] * first[0], float(first @ wanted))


def run_open_loop(
    limb: BenchLimb,
    transform: str,
    flaws: LimbFlaws,
    *,
    force: float = 10.0,
    direction: float = -math.pi / 2,
    seconds: float = 0.5,
    renewed: bool = False,
    plant: str = "mujoco",
) -> OpenLoopRun:
    """Put a transform's torques on the limb at rest at its start, and follow the tip at every step of the physics.

    Args:
        limb: Of two joints.
        transform: A key of `TRANSFORMS`.
        flaws: The plant's; encoders, delay and control rate have no part in it.
        force: Along the wanted direction [N]; see `scaled_torques`.
        direction: In which the tip is to move, from the x axis of the base frame [rad].
        seconds: How long.
        renewed: Whether the torques follow the limb's pose as it moves, without being scaled anew, instead of standing still.
        plant: Name of a plant.

    Raises:
        ScenarioError: If the force or the time cannot be.
        UnknownNameError: If there is no such transform or plant.
    """
    if not 0.0 < force < math.inf:
        raise ScenarioError("open-loop", "force", force, "must be more than 0 N, and finite")
    if not 0.0 < seconds <= 60.0:
        raise ScenarioError("open-loop", "seconds", seconds, "must be more than 0 and at most 60 s")
    if not math.isfinite(direction):
        raise ScenarioError("open-loop", "direction", direction, "must be a finite angle")
    chain, wanted = limb.chain, np.array((math.cos(direction), math.sin(direction)))
    torques = scaled_torques(chain, limb.q0, transform, wanted, force)
    scale = float(np.linalg.norm(torques) / np.linalg.norm(TRANSFORMS[transform](chain, limb.q0, wanted)))
    stage = plant_maker(plant)(chain, flaws.with_changes(control_rate=flaws.physics_rate), gears=limb.gears)
    stage.reset(limb.q0)
    truth, sensed = stage.truth(), stage.sense()
    steps = max(1, round(seconds * flaws.physics_rate))
    trace = empty_trace(chain, still_aim(limb.start)[None].repeat(steps, axis=0), stage.period, 1)
    now = torques
    for k in range(steps):
        if k:
            stage.sense()
        if renewed:
            now = scale * TRANSFORMS[transform](chain, truth.states[0, 0], wanted)
        stage.actuate(now[None])
        trace.sensed[k], trace.true[k], trace.commanded[k] = sensed.states, truth.states, now
        stage.step()
        trace.applied[k], trace.wrenches[k] = truth.torques, truth.wrenches
    places = np.concatenate((trace.true_places()[:, 0, :2], chain.place(truth.states[0, 0])[None, :2]))
    predicted = first_turn(chain, limb.q0, torques, wanted)
    return OpenLoopRun(transform, force, wanted, torques, trace, places, predicted)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OpenLoopResult(Comparison):
    """Paths of one limb's tip under several transforms of the same wanted direction."""

    picture = "force:draw_open_loop_result"
    schema: str = SCHEMA
    direction: Annotated[float, Key(after="force")]
    """From the x axis of the port frame [rad]."""
    renewed: Annotated[bool, Key(after="direction")]
    """Whether the torques followed the pose."""
    runs: Annotated[tuple[OpenLoopRun, ...], Key("transforms", after="first")]

    @in_json(after="limb", key="plant")
    def whole_plant(self) -> dict[str, Any]:
        """What is not ideal about it."""
        return {"name": self.plant} | asdict(self.flaws)

    @in_json(after="plant")
    def force(self) -> float:
        """Along the wanted direction [N]."""
        return self.runs[0].force

    @in_json(after="renewed")
    def first(self) -> float:
        """Way over which the first direction is taken [m]."""
        return FIRST

    @property
    def moved(self) -> bool:
        """Whether any transform moved the tip far enough to have a direction."""
        return any(run.turned() is not None for run in self.runs)

    def plant_words(self) -> str:
        """The plant and what is not ideal about it, in one line."""
        return f"{self.plant}, {plant_words(self.flaws, rate=False)}"

    def traces(self) -> Iterable[tuple[str, LimbTrace]]:
        """Of each transform."""
        return ((run.transform, run.trace) for run in self.runs)


def compare_open_loop(
    limb: BenchLimb,
    flaws: LimbFlaws,
    transforms: Sequence[str] = tuple(TRANSFORMS),
    *,
    seconds: float = 0.7,
    **how: Any,
) -> OpenLoopResult:
    """Run every transform from rest at the limb's start; arguments and errors as in `run_open_loop`."""
    runs = tuple(run_open_loop(limb, transform, flaws, seconds=seconds, **how) for transform in transforms)
    defaults = {"plant": "mujoco", "direction": -math.pi / 2, "renewed": False}
    kept = {key: how.get(key, usual) for key, usual in defaults.items()}
    return OpenLoopResult(limb=limb, flaws=flaws, runs=runs, **kept)
