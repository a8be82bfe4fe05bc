"""One rung of the ladder under noise, carried out with one way to control body and limbs: which of them lose pegs?"""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from ....errors import StatedError
from ....jobs import Executor, map_items, read_result
from ....sim.limb_flaws import LimbFlaws
from ....tasks import load_task
from ....types import Floats, Json
from ....units import INCH
from ..execution.body_gains import BodyGains
from ..execution.climb_trace import ClimbTrace, TracedClimber
from ..execution.climber import Climber, FallenError
from ..execution.grabbing import grab, release
from ..execution.motions import move_body
from ..planning.task import LimbedTask
from ..sim.climber_plant import ClimberPlant
from .body_bench import SLOT
from .body_stand import bench_flaws

GRABS: Final = (("right", 6, -1), ("bottom", 1, 1), ("left", 5, 1))
"""Limb, hold and side of the elbow, in order: hooks come from above, whatever the control."""
ELBOWS: Final = {"right": -1, "left": 1}
"""At the start."""
START: Final = (0.2286, 0.1374, 0.0)
"""Of the body, 15 mm below the two pegs that carry [m], [rad]."""
PEG_ERROR: Final = 0.003
"""Pegs are off the map by up to this along each axis, but for those that the robot was put on [m]."""
FRICTION: Final = 0.3
WEIGHT: Final = 0.1
"""Likewise as parts of what they are believed to be [-]."""


class RungError(StatedError):
    """A trial of a rung that raised, or whose worker died."""

    says = "a rung with {control}, seed {seed}: {error}"
    control: str
    seed: int
    error: str


@dataclass(frozen=True, slots=True)
class RungTrial:
    """How one rung ended."""

    done: bool
    """Whether every action was carried out."""
    lost: bool
    """Whether the hook of a limb that carried came off its peg."""
    reason: str
    """Why it ended."""
    seconds: float
    """Of simulated time."""


class WatchedClimber(TracedClimber):
    """A climber whose hooks are watched from outside.

    Args:
        pegs: Number -> where the hold truly is [m].
    """

    def __init__(self, *args: Any, pegs: Mapping[int, Floats], **options: Any) -> None:
        super().__init__(*args, **options)
        self.pegs = pegs
        self.lost = False
        """Whether the hook of a limb that carried has come off."""

    def tick(self) -> None:
        """As a climber's; the tick of a fall is watched, too."""
        try:
            super().tick()
        finally:
            assert self.truth is not None
            for tip, task in zip(self.truth().tips, self.body.tasks, strict=True):
                if task.mode == "stance" and np.linalg.norm(tip - self.pegs[task.hold]) > SLOT:
                    self.lost = True


def climb_rung(gains: BodyGains, seed: int) -> RungTrial:
    """A rung from the ladder's start: three grabs, the bottom limb off, the body up by 6 in.

    Pegs, friction and weight are drawn from the seed; the plant is nominal otherwise.
    """
    task = _ladder()
    draw = np.random.default_rng(seed)
    flaws = bench_flaws("nominal").with_changes(friction=1.0 + draw.uniform(-FRICTION, FRICTION))
    weight = 1.0 + draw.uniform(-WEIGHT, WEIGHT)
    numbers = [hold.number for hold in task.world.holds]
    shifts = draw.uniform(-PEG_ERROR, PEG_ERROR, (len(numbers), 2))
    shifts[[numbers.index(number) for number in (2, 3, 4)]] = 0.0  # the robot was put on these
    pegs = task.world.positions() + shifts
    return _climb_on(task, gains, flaws, pegs, map_error=PEG_ERROR, weight=weight)[0]


def watch_rung(gains: BodyGains, plant: str) -> tuple[RungTrial, ClimbTrace]:
    """The same rung with pegs, friction and weight as they are believed to be, and its trace.

    Args:
        gains: Of body and limbs.
        plant: "ideal" or "nominal".
    """
    task = _ladder()
    trial, climber = _climb_on(task, gains, bench_flaws(plant), task.world.positions(), map_error=0.0)
    return trial, climber.trace()


def _ladder() -> LimbedTask:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    return task


def _climb_on(
    task: LimbedTask, gains: BodyGains, flaws: LimbFlaws, pegs: Floats, *, map_error: float, weight: float = 1.0
) -> tuple[RungTrial, WatchedClimber]:
    """How a rung of a robot of so many times its weight ended, and the climber at its end."""
    plant = ClimberPlant(replace(task.robot, weight=weight * task.robot.weight), task.world, flaws, pegs=pegs)
    numbers = [hold.number for hold in task.world.holds]
    climber = WatchedClimber(
        task.robot,
        task.world,
        plant,
        gains=gains,
        map_error=map_error,
        pegs=dict(zip(numbers, pegs, strict=True)),
        truth=plant.truth,
    )
    reason = _climb(climber)
    return RungTrial(not reason, climber.lost, reason, climber.time), climber


def _climb(climber: Climber) -> str:
    """Carry the rung out; why it ended early, or nothing."""
    index = climber.robot.limb_index
    start = np.array(START)
    climber.start(start, {"right": 4, "left": 3, "bottom": 2}, idle="bottom", elbows=ELBOWS)
    try:
        climber.wait(0.5)
        climber.learn_start()
        for limb, number, elbow in GRABS:
            if not grab(climber, index(limb), number, elbow=elbow).held:
                return f"the {limb} limb missed {number}"
        release(climber, index("bottom"))
        move_body(climber, start + np.array((0.0, 6 * INCH, 0.0)))
        climber.wait(0.5)
    except FallenError as error:
        return f"fell: {error}"
    return ""


def run_item(item: Json) -> Json:
    """One trial as plain data, for workers."""
    gains: Json = {key: tuple(value) if isinstance(value, list) else value for key, value in item["gains"].items()}
    return asdict(climb_rung(BodyGains(**gains), item["seed"]))


def climb_rungs(
    controls: Mapping[str, BodyGains],
    seeds: range,
    *,
    executor: Executor | None = None,
    store: Path | None = None,
    resume: bool = False,
    progress: Callable[..., None] | None = None,
) -> dict[str, list[RungTrial]]:
    """The same seeds with every control.

    Args:
        controls: Label -> gains.
        seeds: Of the noise.
        executor: Who runs them; None: this machine, one at a time.
        store: SQLite file that keeps each trial as it ends.
        resume: Whether to go on with that file.
        progress: Told of each end.

    Raises:
        StoreError: If the file can't be the store of these trials.
        RungError: If a trial raised.
    """
    pairs = [(label, seed) for label in controls for seed in seeds]
    items: list[Json] = [{"gains": asdict(controls[label]), "seed": seed} for label, seed in pairs]
    ends = map_items(
        run_item,
        items,
        executor=executor,
        store=store,
        about={"items": items},
        resume=resume,
        progress=progress,
        title=f"{len(seeds)} rungs with each of {', '.join(controls)}",
    )
    told: dict[str, list[RungTrial]] = {label: [] for label in controls}
    for (label, seed), end in zip(pairs, ends, strict=True):
        if end.result is None:
            raise RungError(label, seed, end.error or "failed")
        told[label].append(read_result(RungTrial, end.result, store))
    return told
