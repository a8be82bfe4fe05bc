"""Plants of a climb by name or address, and the server that lends one to another process."""

import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

from ....errors import StatedError, describe_choices
from ....execution.hardware import WiredClimber
from ....execution.link.channel import LinkError, read_address
from ....execution.link.client import RemoteHardware
from ....execution.link.messages import About
from ....execution.link.server import PlantServer, Say
from ....execution.plant import BodyPlant, BodyTruth
from ....sim.limb_flaws import LimbFlaws
from ....sim.wires import ClimberWires
from ..execution.wiring import envelope_of, guard_of, wiring_of
from ..planning.task import LimbedTask
from ..sim.climber_plant import ClimberPlant
from .noise import Drawn, drawn_flaws, drawn_hook, drawn_robot, encoder_offsets, true_places

HERE: Final = ("torques", "volts")
"""Plants in this process: torques in and angles out, or through simulated amplifiers and counters."""


class PlantChoiceError(StatedError):
    """A plant that is neither one of ours nor an address."""

    text: str

    def __str__(self) -> str:
        return f"no plant is called {self.text!r}; there are {describe_choices(self.text, HERE)}, or the address of a server"


def check_plant(text: str) -> None:
    """Make sure that a text names a plant, before anything is planned for it.

    Raises:
        PlantChoiceError: If it does not.
        LinkError: If it is an address that cannot be.
    """
    if is_remote(text):
        read_address(text)
    elif text not in HERE:
        raise PlantChoiceError(text)


def is_remote(text: str) -> bool:
    """Whether a plant's text is an address."""
    return ":" in text


@contextmanager
def climbing_plant(text: str, task: LimbedTask, simulate: Callable[[], ClimberPlant]) -> Iterator[BodyPlant]:
    """The plant that a text names, let go at the end.

    Args:
        text: One of `HERE`, or an address: there, the robot and its flaws are the server's.
        task: What is climbed.
        simulate: Makes the plant of a simulation here.

    Raises:
        PlantChoiceError: If there is no such plant.
        LinkError: If nobody serves it, or another robot or task is served.
        SpecError: If the robot has no amplifiers or encoders that its wires could carry.
    """
    check_plant(text)
    if not is_remote(text):
        plant = simulate()
        yield plant if text == "torques" else wired(plant)
        return
    with RemoteHardware(read_address(text)) as remote:
        remote.check(task.robot.name, task.world.name)
        wiring = wiring_of(task.robot)
        for word, served, ours in (
            ("readings", remote.about.readings, wiring.n_readings),
            ("commands", remote.about.commands, wiring.n_commands),
        ):
            if served != ours:
                raise LinkError(text, f"it has {served} {word}", f"must have {ours}, as '{task.robot.name}' has")
        yield WiredClimber(remote, wiring)


def truth_of(plant: BodyPlant) -> Callable[[], BodyTruth] | None:
    """What tells how a plant really is; None of one that nobody knows."""
    if plant.truth() is None:
        return None

    def told() -> BodyTruth:
        truth = plant.truth()
        assert truth is not None
        return truth

    return told


def drawn_plant(task: LimbedTask, flaws: LimbFlaws, drawn: Drawn) -> ClimberPlant:
    """A task's robot on its board as they truly are."""
    return ClimberPlant(
        drawn_robot(task.robot, drawn),
        task.world,
        drawn_flaws(flaws, drawn),
        pegs=true_places(task, drawn),
        shape=drawn_hook(drawn),
        offsets=encoder_offsets(drawn),
    )


def wired(plant: ClimberPlant) -> WiredClimber:
    """A simulated climber through simulated wires in this process."""
    wiring = wiring_of(plant.robot, plant.flaws.encoder_counts)
    return WiredClimber(ClimberWires(plant, wiring), wiring)


def climb_server(
    task: LimbedTask,
    plant: ClimberPlant,
    listener: socket.socket,
    *,
    say: Say,
    real_time: bool = False,
    pace: float = 1.0,
    once: bool = False,
    dac_bits: int = 0,
) -> PlantServer:
    """A server of a task's simulated robot; see `PlantServer`.

    Raises:
        SpecError: If the robot has no amplifiers or encoders that its wires could carry.
        PlantError: If the converters cannot be.
        LinkError: If the token cannot be written by which operators may stop it.
    """
    wiring = wiring_of(task.robot, plant.flaws.encoder_counts)
    hardware = ClimberWires(plant, wiring, dac_bits=dac_bits)
    about = About(
        task.robot.name,
        task.world.name,
        wiring.n_commands,
        wiring.n_readings,
        3 + wiring.n_joints,
        len(hardware.truth()),
        real_time,
        hardware.period,
        pace,
    )
    guard = guard_of(task.robot, wiring, hardware.period)
    envelope = envelope_of(task.robot, wiring, hardware.period)
    return PlantServer(hardware, about, guard, envelope, listener, say=say, once=once)
