"""One protocol for a limb in MuJoCo, by the ODE, and in another thread behind a socket: the same closed loop to the last bit."""

import threading

import numpy as np
import pytest

from clamber.control.controller import Controller, still_aim
from clamber.control.law_settings import LawSettings
from clamber.execution.closed_loop import close_loop
from clamber.execution.hardware import WiredLimb
from clamber.execution.link.channel import Address, listen
from clamber.execution.link.client import RemoteHardware
from clamber.execution.link.messages import About
from clamber.execution.link.server import PlantServer
from clamber.execution.plant import LimbPlant
from clamber.execution.posture_guard import PostureGuard
from clamber.execution.trace import LimbTrace
from clamber.execution.wiring import Wiring
from clamber.families.climber.execution.wiring import envelope_of, wiring_of_limb
from clamber.limb_bench.bench_limb import bench_limb
from clamber.sim.bench_limb import BenchLimb
from clamber.sim.limb_flaws import LimbFlaws, Push
from clamber.sim.plants import PLANTS
from clamber.sim.wires import LimbWires

FLAWS = LimbFlaws(encoder_counts=400, delay=1, push=Push(x=4.0, y=1.0, start=0.05, end=0.1))


@pytest.fixture(scope="module")
def leg() -> BenchLimb:
    return bench_limb()


def wires(name: str, leg: BenchLimb) -> tuple[LimbWires, Wiring]:
    wiring = wiring_of_limb(leg.robot, leg.robot.limb_names[0], FLAWS.encoder_counts)
    return LimbWires(PLANTS[name](leg.chain, FLAWS, gears=leg.gears), wiring), wiring


def loop(plant: LimbPlant, leg: BenchLimb) -> LimbTrace:
    controller = Controller(leg.chain, LawSettings(law="scct", kp=100.0), period=plant.period)
    plant.reset(leg.q0)
    return close_loop(plant, controller, np.stack([still_aim((0.22, -0.02))] * 60))


@pytest.mark.parametrize("name", PLANTS)
def test_a_limb_behind_a_socket_is_driven_as_one_here(name: str, leg: BenchLimb) -> None:
    here = loop(WiredLimb(*wires(name, leg)), leg)
    served, wiring = wires(name, leg)
    served.reset(leg.q0)
    about = About(leg.robot.name, leg.chain.name, 2, 2, 2, len(served.truth()), False, served.period)
    listener, address = listen(Address("tcp", "127.0.0.1"))
    guard = PostureGuard(wiring, leg.chain.joints["rotor"], served.period)
    envelope = envelope_of(leg.robot, wiring, served.period, (leg.robot.limb_names[0],))
    server = PlantServer(served, about, guard, envelope, listener, say=lambda _: None, once=True)
    thread = threading.Thread(target=server.serve, daemon=True)
    thread.start()
    with RemoteHardware(address) as remote:
        there = loop(WiredLimb(remote, wiring), leg)
    thread.join(20.0)
    for key in ("true", "sensed", "commanded", "applied", "wrenches", "reports"):
        assert np.array_equal(getattr(here, key), getattr(there, key)), key
    assert here.wrenches.any() and np.ptp(here.true) > 0.0


@pytest.mark.parametrize("name", PLANTS)
def test_a_limb_through_wires_comes_where_it_comes_without_them(name: str, leg: BenchLimb) -> None:
    plain = loop(PLANTS[name](leg.chain, FLAWS, gears=leg.gears), leg)
    wired = loop(WiredLimb(*wires(name, leg)), leg)
    np.testing.assert_allclose(wired.true[:, 0, 0], plain.true[:, 0, 0], atol=1e-4)
