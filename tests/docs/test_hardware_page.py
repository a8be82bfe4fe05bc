"""docs/hardware.md: its driver drives a robot, and its tables name what there is."""

import re
import threading
from pathlib import Path
from typing import Any

import numpy as np

from clamber.benchmarks.plant_bench import gait_of
from clamber.execution.hardware import WiredClimber
from clamber.execution.link.channel import read_address
from clamber.execution.link.client import RemoteHardware
from clamber.execution.link.messages import STOPS, Kind
from clamber.execution.wiring import Wiring
from clamber.families.climber.execution.climb_trace import TracedClimber
from clamber.families.climber.execution.climbing import Climbing
from clamber.families.climber.execution.executable_plan import lay_course
from clamber.families.climber.execution.wiring import wiring_of
from clamber.families.climber.sim.climber_plant import ClimberPlant
from clamber.families.climber.trials.run_plan import climbing_flaws, climbing_task
from clamber.sim.wires import ClimberWires
from clamber.tasks import load_task

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "hardware.md").read_text(encoding="utf-8")


class Card:
    """An I/O card whose robot is simulated, and was put onto its pegs by hand."""

    def __init__(self, hardware: ClimberWires, wiring: Wiring) -> None:
        self._hardware, self._wiring = hardware, wiring

    def place(self, start: np.ndarray) -> None:
        self._hardware.reset(start)

    def set_counters(self, counts: np.ndarray) -> None:
        assert np.array_equal(self._hardware.sense().counts, counts)

    def counters(self) -> list[int]:
        return [int(count) for count in self._hardware.sense().counts]

    def set_volts(self, volts: np.ndarray) -> None:
        self._hardware.actuate(volts)
        self._hardware.step()


def test_the_driver_of_the_page_drives_a_robot_that_knows_no_truth(tmp_path: Path) -> None:
    driver, serve = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    task = climbing_task(load_task("ladder"))
    flaws = climbing_flaws(task, ("delay=0",))
    wiring = wiring_of(task.robot)
    card = Card(ClimberWires(ClimberPlant(task.robot, task.world, flaws), wiring), wiring)
    where = f"unix:{tmp_path / 'libra'}"
    names: dict[str, Any] = {"card": card, "real_time": False, "where": where}
    exec(driver, names)
    listening = serve.replace("server.serve()", "")
    exec(listening, names)
    thread = threading.Thread(target=names["server"].serve, daemon=True)
    thread.start()
    with RemoteHardware(read_address(where)) as remote:
        remote.check("libra", "ladder")
        plant = WiredClimber(remote, wiring)
        climber = TracedClimber(task.robot, task.world, plant)
        reset = plant.reset

        def by_hand(pose: np.ndarray, q: np.ndarray) -> None:
            card.place(np.concatenate((pose, q.ravel())))
            reset(pose, q)

        plant.reset = by_hand  # type: ignore[method-assign]
        Climbing(climber, lay_course(task, gait_of(task), "gait")).start()
        climber.wait(0.5)
        assert plant.truth() is None
        assert climber.trace().true_pose is None
        assert remote.sense().tick == 100


def test_the_page_tells_of_every_message_and_every_stop() -> None:
    for kind in Kind:
        assert f"| {kind.value} {kind.name} |" in PAGE
    assert [
        int(number)
        for number in re.findall(r"(\d) (?:none|no command|client|no message|server|operator|clock|beyond)", PAGE)
    ] == [int(stop) for stop in STOPS]
