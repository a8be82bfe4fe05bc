"""How fast control is: a tick of every law, inverse kinematics of other libraries, the closed loop, and regions of the walker's frames."""

import importlib.util
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import median
from typing import Any, Final, TypeAlias

import numpy as np

from ..control.chain import Chain
from ..control.controller import Controller, still_aim
from ..control.law_settings import LAWS, LawSettings
from ..errors import how_to_install
from ..execution.closed_loop import close_loop
from ..families.walker.robot import TwoFrames, WalkerRobot
from ..families.walker.robot.arcs import COLUMNS, MOST_ARCS, ROOM, outline, ray
from ..families.walker.robot.curves import CURVE_NUMBERS, MOST_CURVES, reach_curves
from ..families.walker.robot.ditch import Footing, ditch_map
from ..families.walker.robot.two_frames import follow_branch
from ..families.walker.robot.workspace import stride, workspace
from ..limb_bench.bench_limb import bench_limb
from ..limb_bench.scenario import rest_at
from ..sim.bench_limb import BenchLimb
from ..sim.limb_flaws import LimbFlaws, Push
from ..sim.limb_model import limb_spec
from ..sim.mujoco_limb import MujocoLimb
from ..sim.ode_limb import OdeLimb
from ..sim.raw_steps import RawSteps
from ..trials.measured import NOTHING, Row, Say, keep_quiet, round_times
from ..types import Floats, Records

Tick: TypeAlias = Callable[[Floats, Floats], Floats]
"""Joint speeds [rad/s] that bring the tip from the joint angles [rad] to a place of the base frame [m] within one period."""
PERIOD: Final = 0.005
SOLVER: Final = "daqp"


def mink_tick(chain: Chain) -> tuple[Tick, Tick]:
    """A tick of mink on the limb's MuJoCo model: with the new angles read in, and `solve_ik` alone.

    The quadratic programme has no limits in it, the least work that it can be.
    """
    import mink

    configuration: Any = mink.Configuration(limb_spec(chain, LimbFlaws()).compile())
    task: Any = mink.FrameTask("tip", "site", position_cost=[1.0, 1.0, 0.0], orientation_cost=0.0)

    def solve(q: Floats, place: Floats) -> Floats:
        task.set_target(mink.SE3.from_translation(place))
        out: Floats = mink.solve_ik(configuration, [task], PERIOD, SOLVER, limits=[])
        return out

    def tick(q: Floats, place: Floats) -> Floats:
        configuration.update(q)
        return solve(q, place)

    return tick, solve


def pink_tick(chain: Chain) -> tuple[Tick, Tick]:
    """A tick of pink on a Pinocchio model of the same arm: with the new angles read in, and `solve_ik` alone."""
    import pinocchio
    from pink import Configuration, solve_ik
    from pink.tasks import FrameTask

    model = pinocchio.Model()
    parent = 0
    for name, joint in zip(chain.joint_names, chain.joints, strict=True):
        place = pinocchio.SE3(joint["turn"].copy(), joint["place"].copy())
        parent = model.addJoint(parent, pinocchio.JointModelRevoluteUnaligned(*joint["axis"]), place, name)
    root = chain.root[0]
    tip = pinocchio.SE3(root["tip_turn"].copy(), root["tip"].copy())
    model.addFrame(pinocchio.Frame("tip", parent, 0, tip, pinocchio.FrameType.OP_FRAME))
    configuration: Any = Configuration(model, model.createData(), np.zeros(chain.n))
    # pink counts a task's rows in the tip's frame: all three, so that any turn of it asks for the same place
    task: Any = FrameTask("tip", position_cost=1.0, orientation_cost=0.0)

    def solve(q: Floats, place: Floats) -> Floats:
        task.set_target(pinocchio.SE3(np.eye(3), place))
        out: Floats = solve_ik(configuration, [task], PERIOD, SOLVER, limits=[])
        return out

    def tick(q: Floats, place: Floats) -> Floats:
        configuration.update(q)
        return solve(q, place)

    return tick, solve


IK_PEERS: Final[dict[str, Callable[[Chain], tuple[Tick, Tick]]]] = {"mink": mink_tick, "pink": pink_tick}
"""Library -> what it does in a tick; each is optional."""


def installed(peer: str) -> bool:
    """Whether a library is there, with its solver."""
    return all(importlib.util.find_spec(name) is not None for name in (peer, "qpsolvers", SOLVER))


ROUNDS: Final = 15
"""How often each piece of work is timed; the median counts, of a ratio that of the ratios of each round."""
STATES: Final = 64
"""Poses and speeds that a controller is timed on, one after the other."""
TICKS: Final = 2000
"""Of a controller in one timing."""
PEER_TICKS: Final = 100
BATCH: Final = 1000
LIMBS: Final = 256
"""Limbs of a batch in closed loop."""
SECONDS: Final = 1.0
"""Of closed loop in one timing."""
STEPPED: Final = (0.22, -0.02)
"""Where a step of 2 cm leads the tip of LIBRA's first limb, port frame [m]."""


def law_named(law: str) -> LawSettings:
    """The law as it is timed, those for forces with one along x."""
    return LawSettings(law=law, kp=100.0, forced=("x",) if law in ("hybrid", "implicit-force") else ())


def laws_timed() -> dict[str, LawSettings]:
    """Label -> settings of every law, and of one with every feed-forward."""
    whole = law_named("scct").with_changes(feed_acceleration=True, feed_bias=True, feed_friction=1.0)
    return {**{law: law_named(law) for law in LAWS}, "scct with every feed-forward": whole}


def random_states(limb: BenchLimb, shape: tuple[int, ...]) -> Floats:
    """Joint angles and speeds about the limb's start, shape (*shape, 2, n)."""
    rng = np.random.default_rng(0)
    out = rng.uniform(-0.3, 0.3, (*shape, 2, limb.chain.n))
    out[..., 0, :] += limb.q0
    return out


def _tick_often(controller: Controller, aims: Records, states: Floats, wrenches: Floats, ticks: int) -> None:
    command, many = controller.command, len(states)
    for k in range(ticks):
        command(aims, states[k % many], wrenches)


def tick_rows(*, rounds: int = ROUNDS, ticks: int = TICKS, batch: int = BATCH, say: Say = keep_quiet) -> list[Row]:
    """One tick of every law, called from Python: on one limb, and per limb of a batch, on one core."""
    say("one tick of every law")
    limb, laws = bench_limb(), laws_timed()
    aims = still_aim(STEPPED)
    rows = []
    for size, aim, label in (
        (1, "< 5", "one limb"),
        (batch, "< 1", f"per limb of {batch}"),
    ):
        states, felt = random_states(limb, (STATES, size)), np.ones((size, 6))
        count = max(1, ticks // size)
        works = [
            partial(_tick_often, Controller(limb.chain, law, period=0.005, batch=size), aims, states, felt, count)
            for law in laws.values()
        ]
        times = np.median(round_times(works, rounds), axis=0) / (count * size)
        rows += [Row(f"tick of {name}, {label}", 1e6 * t, "us", aim) for name, t in zip(laws, times, strict=True)]
    return rows


def _solve_often(tick: Tick, states: Floats, place: Floats, ticks: int) -> None:
    for k in range(ticks):
        tick(states[k % len(states), 0, 0], place)


def peer_rows(*, rounds: int = ROUNDS, say: Say = keep_quiet) -> list[Row]:
    """The motion of one tick by mink and by pink over our tick of resolved rate control, which has torques besides."""
    limb = bench_limb()
    states, place = random_states(limb, (STATES, 1)), np.array((*STEPPED, 0.0))
    rows = []
    for name, make in IK_PEERS.items():
        if not installed(name):
            rows.append(Row(f"{name} (not installed: {how_to_install('bench')})", NOTHING, "ratio"))
            continue
        say(f"{name} on the same arm")
        controller = Controller(limb.chain, law_named("resolved-rate"), period=0.005)
        ours = partial(_tick_often, controller, still_aim(place), states, np.zeros((1, 6)), 20 * PEER_TICKS)
        whole, alone = (partial(_solve_often, tick, states, place, PEER_TICKS) for tick in make(limb.chain))
        own, with_update, solve = round_times((ours, whole, alone), rounds).T / PEER_TICKS
        own /= 20
        rows += [
            Row(f"{name}: update and solve_ik, no limits, daqp", 1e6 * median(with_update), "us"),
            Row(f"{name}: the same over our tick of resolved-rate", median(with_update / own), "ratio"),
            Row(f"{name}: solve_ik alone over our tick", median(solve / own), "ratio"),
        ]
    return rows


@dataclass(frozen=True, slots=True)
class Loop:
    """A closed loop to be timed."""

    label: str
    flaws: LimbFlaws
    batch: int = 1


def loops_timed(limbs: int = LIMBS) -> tuple[Loop, ...]:
    """By physics rate, with flaws (backlash, encoders, a sample of delay), pushed; one by one, and many limbs on all cores."""
    flawed = LimbFlaws(backlash=np.radians(2.0), encoder_counts=400, delay=1)
    words = "with flaws"
    push = Push(x=10.0, y=0.0, start=0.1, end=0.8)
    return (
        Loop("2 kHz", LimbFlaws()),
        Loop("1 kHz", LimbFlaws(physics_rate=1000.0)),
        Loop(f"2 kHz, {words}", flawed),
        Loop(f"1 kHz, {words}", flawed.with_changes(physics_rate=1000.0)),
        Loop("2 kHz, pushed", LimbFlaws(push=push)),
        Loop(f"2 kHz, {limbs} limbs", LimbFlaws(), limbs),
        Loop(f"2 kHz, {limbs} limbs, {words}", flawed, limbs),
    )


def loop_rows(
    *,
    loops: Sequence[Loop] | None = None,
    rounds: int = ROUNDS,
    seconds: float = SECONDS,
    say: Say = keep_quiet,
) -> list[Row]:
    """Closed-loop simulation, trace and all, over `mj_step` of the same model with the same torques; the 2 cm step, 200 Hz."""
    limb = bench_limb()
    rows = []
    for loop in loops_timed() if loops is None else loops:
        say(f"closed loop, {loop.label}")
        flaws = loop.flaws
        aims = rest_at(STEPPED, round((seconds if loop.batch == 1 else seconds / 4) * flaws.control_rate))
        controller = Controller(limb.chain, law_named("scct"), period=flaws.period, batch=loop.batch)
        plant = MujocoLimb(limb.chain, flaws, gears=limb.gears, batch=loop.batch)

        def closed(plant: MujocoLimb = plant, controller: Controller = controller, aims: Records = aims) -> Any:
            plant.reset(limb.q0)
            return close_loop(plant, controller, aims)

        raw = RawSteps(plant.model, flaws.steps, closed().applied, limb.q0)
        clock = time.thread_time if loop.batch == 1 else time.perf_counter
        whole, bare = round_times((closed, raw.run), rounds, clock).T
        steps = len(aims) * flaws.steps * loop.batch
        rows.append(Row(f"loop over raw mj_step: {loop.label}", median(whole / bare), "ratio", "<= 1.5"))
        rows.append(Row(f"raw mj_step, a step: {loop.label}", 1e6 * median(bare) / steps, "us"))
    return [*rows, ode_row(rounds=rounds, seconds=seconds)]


def ode_row(*, rounds: int = ROUNDS, seconds: float = SECONDS) -> Row:
    """What a closed loop on the ODE takes of real time."""
    limb, flaws = bench_limb(), LimbFlaws()
    aims = rest_at(STEPPED, round(seconds * flaws.control_rate))
    controller, plant = Controller(limb.chain, law_named("scct"), period=flaws.period), OdeLimb(limb.chain, flaws)

    def closed() -> None:
        plant.reset(limb.q0)
        close_loop(plant, controller, aims)

    per_tick = median(round_times((closed,), rounds)[:, 0]) / len(aims)
    return Row("loop on the ODE plant, 2 kHz, per tick", 1e6 * per_tick, "us")


def control_rows(*, say: Say = keep_quiet) -> list[Row]:
    """All of it."""
    return [*tick_rows(say=say), *peer_rows(say=say), *loop_rows(say=say)]


REPEATS: Final = 200
"""Of a piece of work in one timing."""


def region_rows(robot: WalkerRobot, *, rounds: int = ROUNDS, say: Say = keep_quiet) -> list[Row]:
    """Times of what a planner or controller asks of the mechanism, at many angles."""
    say("regions of the two frames")
    frames = TwoFrames.of(robot.mechanism)
    thetas = np.linspace(-0.3, 0.8, REPEATS)
    footing = Footing.of(robot)
    directions = np.linspace(0.0, np.pi / 3.0, 10)
    works: list[Callable[[], object]] = [
        partial(_regions_and_strides, frames, thetas),
        partial(_compiled_regions, frames, thetas),
        partial(_poses, frames, 1e-3),
        partial(_poses, frames, 5e-2),
        partial(ditch_map, footing, thetas, directions),
    ]
    whole, bare, near, far, ditches = np.median(round_times(works, rounds), axis=0) / REPEATS
    return [
        Row("exact region, its parts and areas, and a step, at one angle", 1e3 * whole, "ms", "< 1"),
        Row("the same within a kernel: arcs, areas, step", 1e6 * bare, "us"),
        Row("pose behind lengths, followed over 1 mm", 1e6 * near, "us"),
        Row("pose behind lengths, followed over 50 mm", 1e6 * far, "us"),
        Row("widest ditch at one angle and direction", 1e6 * ditches / len(directions), "us"),
    ]


def _regions_and_strides(frames: TwoFrames, thetas: Floats) -> None:
    for theta in thetas:
        workspace(frames, float(theta), guard=frames.guard)
        stride(frames, float(theta), 0.5, guard=frames.guard)


def _compiled_regions(frames: TwoFrames, thetas: Floats) -> None:
    curves, arcs = np.zeros((MOST_CURVES, CURVE_NUMBERS)), np.empty((MOST_ARCS, COLUMNS))
    areas, owners, room = np.empty(MOST_ARCS), np.empty(MOST_ARCS, np.int64), np.empty(ROOM)
    for theta in thetas:
        n = reach_curves(frames.delta, frames.y, theta, frames.shortest, frames.longest, frames.guard, curves)
        outline(curves, n, arcs, areas, owners, room)
        ray(curves, n, 0.0, 0.0, 1.0, 0.0)
        ray(curves, n, 0.0, 0.0, -1.0, 0.0)


def _poses(frames: TwoFrames, off: float) -> None:
    aim, room = frames.lengths((off, 0.5 * off, off)), np.empty((9, 3))
    for _ in range(REPEATS):
        follow_branch(frames.delta, frames.y, aim, np.zeros(3), room)
