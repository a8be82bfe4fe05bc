"""One walk carried out in contact dynamics: the plant with its flaws, and what truly happened."""

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from operator import attrgetter
from pathlib import Path
from typing import Annotated, Any, Final

import numpy as np

from ....errors import UnitError, describe_choices
from ....execution.fault import Fault
from ....execution.log_scene import LoggedScene
from ....execution.log_stream import LogGap, WantedLog, growing_log
from ....execution.run_report import RunEndedError
from ....execution.sequencer import Sequencer
from ....json_form import HIDDEN, INLINE, Jsonable, Key, OrNull, in_json
from ....notebook import Pictured
from ....planning.problem.plan import Plan
from ....sim.plant_rules import PlantError
from ....types import Floats
from ....units import parse_quantity
from ..control.gait import Limits
from ..control.track import Track, through
from ..execution.faulty_walker import FaultyWalker
from ..execution.footstep_plan import FootstepPlan, ImaginedWalker, PlannedCourse, PlannedStep, TrackCourse
from ..execution.quickest import quickest_way
from ..execution.settings import WalkSettings
from ..execution.true_walk import TracedPlant, TrueWalk
from ..execution.walk_report import WalkReport
from ..execution.walk_scene import walk_scene
from ..execution.walk_trace import TOPIC, TracedWalker, WalkTrace, walker_notes
from ..execution.walker import RefusedError
from ..execution.walking import Lay, Progress, Walking
from ..planning import Walk
from ..planning.walk import why_it_tips
from ..robot.ditch import Footing
from ..robot.ditch_plan import Crossing, cross_ditch, stances
from ..robot.plane_poses import compose
from ..robot.weight import weight_of
from ..sim.walker_flaws import WalkerFlaws
from ..sim.walker_plant import WalkerSim
from .held_point import HeldPoint, LaidHold, lay_hold
from .noise import WalkNoise
from .planned import BALANCE, CLEARANCE, GUARD, STROKE


def plan_crossing(walk: Walk) -> Crossing:
    """The slides that cross a walk's ditch, wider by what feet keep from its edges, within less than the mechanism can; or why none do.

    Args:
        walk: Its way is one ditch.
    """
    piece, robot, start = walk.way[0], walk.robot, walk.start
    assert piece.ditch is not None and piece.ahead is not None
    mechanism = replace(
        robot.mechanism,
        shortest=robot.mechanism.shortest + STROKE,
        stroke=robot.mechanism.stroke - 2.0 * STROKE,
        guard=min(robot.mechanism.guard, Limits().guard - GUARD),
    )
    weight = weight_of(robot, walk.arm if robot.arm is not None else None, walk.payload)
    footing = Footing.of(replace(robot, mechanism=mechanism), weight=weight, margin=BALANCE)
    return cross_ditch(
        footing,
        piece.ditch + 2.0 * CLEARANCE,
        before=piece.ahead - CLEARANCE,
        heading=-(piece.along or 0.0),
        theta=start.twist,
    )


def crossing_steps(found: Crossing) -> tuple[PlannedStep, ...]:
    """The slides of a crossing as steps."""
    before = stances(found.start, found.slides)
    return tuple(
        PlannedStep(slide.frame, slide.way[1:], poses[1 - slide.frame])
        for slide, poses in zip(found.slides, before, strict=False)
    )


def lay_crossing(walk: Walk) -> Lay:
    """How a walk's ditch is crossed from where the robot stands; it is refused, with the reason, where it cannot be."""

    def lay(pose: Floats) -> PlannedCourse:
        found = plan_crossing(walk)
        if found.status != "found":
            raise RefusedError(
                f"the ditch cannot be crossed with {1e3 * CLEARANCE:.0f} mm kept between feet and edges, {1e3 * BALANCE:.0f} mm of "
                f"balance and {1e3 * STROKE:.0f} mm of the actuators' strokes: {found.reason}"
            )
        return PlannedCourse(crossing_steps(found), found.start[0], pose, radius=walk.robot.legs.radius_delta)

    return lay


SETTINGS: Final[dict[str, str]] = {"friction": "ratio", "payload": "mass", "physics_rate": "frequency"}
"""Settings of the plant that a user may change -> dimension. The payload is one that the robot does not know of."""
LOST: Final = 0.02
"""A robot that ends farther from where it believes to be has not come to the end of its way [m]."""
WITHIN: Final = 0.005
"""So near are places of a path passed [m]."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class WalkRun(Jsonable, Pictured):
    """A walk that was carried out; exit code 1 where it is not done."""

    walk: Annotated[Walk, Key(get=attrgetter("name"), kind=str, after="steps")]
    report: Annotated[WalkReport, INLINE]
    trace: Annotated[WalkTrace, HIDDEN]
    """As the robot believed it."""
    true: Annotated[TrueWalk, HIDDEN]
    """As it was."""
    wall_seconds: Annotated[float, Key(after="margin")]
    """That it took."""
    held: Annotated[HeldPoint | None, Key("hold", after="wall_seconds", may_be_missing=True)] = None
    """There only if the walk has a point to hold, and the way was laid."""
    fault: Annotated[Fault | None, HIDDEN] = None
    """That the robot had."""
    plan: Annotated[Plan | None, HIDDEN] = None
    """That it followed; None: its own way."""
    log_gap: Annotated[LogGap | None, Key(after="hold", may_be_missing=True)] = None
    """What its log lacks, there only if it could not be written to its end; None: nothing, or there is no log."""

    @property
    def work(self) -> Walk:
        """What was carried out."""
        return self.walk

    @property
    @in_json()
    def done(self) -> bool:
        """Whether it came to the end of its way, truly."""
        return not self.reason

    @property
    @in_json()
    def reason(self) -> str:
        """Why it did not; empty where it did."""
        report = self.report
        if not report.done:
            return report.reason
        off = math.dist(self.true.pose[-1, :2], report.pose[:2])
        return "" if off <= LOST else f"lost: the robot is {1e3 * off:.0f} mm from where it believes to be"

    @property
    def scene(self) -> LoggedScene:
        """See `CarriedOut`."""
        true, arm = self.trace.true_pose is not None, self.trace.true_tool is not None
        return walk_scene(self.walk.robot, self.walk.ground, true=true, arm=arm)

    def told(self) -> str:
        """Of what, and how it ended."""
        return f"of {self.work.name!r}: {self.reason or 'done'}, {self.report.seconds:.0f} s"

    @property
    def walking(self) -> slice:
        """Rows of `true` from the first step on."""
        start = self.report.steps[0].start if self.report.steps else self.report.seconds
        return slice(int(np.searchsorted(self.true.time, start)), None)

    @property
    @in_json(after="walk")
    def tilt(self) -> float:
        """Largest angle of the plate from level while it walked [rad]."""
        return float(self.true.tilts[self.walking].max(initial=0.0))

    @property
    @in_json(after="tilt")
    def margin(self) -> OrNull:
        """Least margin of balance while it walked, with as many feet as touch the ground [m]; infinite with fewer than three."""
        return float(self.true.margins[self.walking].min(initial=np.inf))


def walk_flaws(walk: Walk, settings: Sequence[str]) -> WalkerFlaws:
    """The plant of a walk with settings such as "friction=50%".

    Raises:
        PlantError: If one of them cannot be.
    """
    changes: dict[str, Any] = {}
    for text in settings:
        key, _, said = (part.strip() for part in text.partition("="))
        if key not in SETTINGS:
            raise PlantError(key, said, f"no such property; there are {describe_choices(key, SETTINGS)}")
        try:
            changes[key] = parse_quantity(said, SETTINGS[key])
        except UnitError as error:
            raise PlantError(key, said, f"{error.problem}; {error.allowed}") from None
    changes["payload"] = changes.get("payload", 0.0) + walk.payload
    if changes["payload"] > 0.0 and walk.robot.arm is None:
        raise PlantError("payload", f"{changes['payload']:g} kg", "needs an arm to carry it, and the robot has none")
    return WalkerFlaws().with_changes(**changes)


def lay_track(walk: Walk, pose: Floats) -> Track:
    """The way of a walk from where the Delta-frame is, x, y [m], heading [rad], shape (3,); to places the quickest way."""
    twists: list[Floats] = []
    radius = walk.robot.legs.radius_delta
    for piece in walk.way:
        track = Track.of(pose, twists, radius)
        here = track.pose(track.length)
        if piece.to is not None:
            twists += quickest_way(imagined(walk, here), np.array(piece.to), piece.heading)[0].twists
        elif piece.through is not None:
            twists += list(through(here, piece.poses(float(here[2])), radius, within=WITHIN).twists)
        else:
            twists.append(piece.whole_twist())
    return Track.of(pose, twists, radius)


def imagined(walk: Walk, pose: Floats) -> ImaginedWalker:
    """A walk's robot, with the settings that walks have, where its Delta-frame is at a pose, shape (3,)."""
    placed = np.stack([pose, compose(pose, np.array((0.0, 0.0, walk.start.twist)))])
    return ImaginedWalker(walk.robot, WalkSettings(), walk.payload, np.array(walk.arm), placed)


def own_way(walk: Walk) -> Lay:
    """How the way of a walk's file is laid out from where the robot stands."""
    if walk.way[0].ditch is not None:
        return lay_crossing(walk)
    return lambda pose: TrackCourse(lay_track(walk, pose), neutral=walk.start.twist)


def run_walk(
    walk: Walk,
    flaws: WalkerFlaws,
    *,
    noise: WalkNoise = WalkNoise.of("none"),  # noqa: B008  # frozen
    seed: int = 0,
    settings: WalkSettings | None = None,
    lay: Lay | None = None,
    progress: Progress | None = None,
    log: Path | WantedLog | None = None,
    fault: Fault | None = None,
) -> WalkRun:
    """Carry a walk out.

    Args:
        walk: Robot, ground, start and way.
        flaws: Of the plant, before noise.
        noise: What deviates from what the robot believes. With an offset of the inclinometers they are calibrated first.
        seed: Of how much it does, and of rough ground.
        settings: How it walks; None: as usual, level and probing as the walk says.
        lay: The course that it follows, laid where it stands; None: the walk's own way.
        progress: Told before each step.
        log: An .mcap file that grows as the robot walks (`execution.log_stream`).
        fault: That the robot has; None: none.

    Raises:
        FileError: If the log cannot be made; one that cannot be written to its end does not end the run.
    """
    began = time.perf_counter()
    walk = walk.with_seed(seed)
    drawn = noise.flaws(flaws, seed) if any(noise.widths.values()) else flaws
    moved = WalkerSim(walk.robot, walk.ground, drawn)
    plant = TracedPlant(moved if fault is None else FaultyWalker(moved, fault))
    how = settings
    if how is None:
        # where ground may be higher than the walker can tell, its feet stay up until they are over their next footholds
        clear = WalkSettings().clear if lay is None and walk.probe == 0.0 else None
        how = WalkSettings(level=walk.level, probe=walk.probe, clear=clear)
    walker = TracedWalker(walk.robot, plant, settings=how, payload=walk.payload)
    holds: list[LaidHold] = []

    def lay_with_hold(pose: Floats) -> FootstepPlan:
        if walk.hold is not None:
            holds.append(lay_hold(walker, lay_track(walk, pose), walk.hold))
            holds[0].hold.start(walker)
        return (lay or own_way(walk))(walker.frames()[0])

    calibrated = noise.widths["inclinometer_offset"] == 0.0
    walking = Walking(walker, lay_with_hold, start=lambda: stand(walker, walk), calibrated=calibrated)
    titles = walker.titles
    scene = walk_scene(walk.robot, walk.ground, true="plate x true [m]" in titles, arm="tool x true [m]" in titles)
    with growing_log(log, walker.samples, titles, walker_notes(), TOPIC, scene) as finish:
        report = Sequencer(walking, progress=progress).run()
        notes = report.to_json() | {"walk": walk.name, "noise": noise.to_json(), "seed": seed}
        gap = finish(notes)
    true = plant.trace()
    held = holds[0].as_it_was(true) if holds else None
    taken = time.perf_counter() - began
    return WalkRun(walk, report, walker.trace(notes), true, taken, held, fault, log_gap=gap)


def step_told(step: int, way: float, whole: float) -> tuple[str, float | None]:
    """The step that begins, on `whole` metres of way, in words, and the share that is done [-]."""
    return f"step {step}: {way:.2f} of {whole:.2f} m", way / whole if whole > 0.0 else None


def stand(walker: TracedWalker, walk: Walk) -> None:
    """Put a walk's robot where it starts.

    Raises:
        RunEndedError: If it does not come to stand there, with what it could carry if it tips.
    """
    try:
        walker.start(walk.start_pose(), walk.start_place(), walk.start_legs(), np.array(walk.arm))
    except RunEndedError as end:
        why = why_it_tips(walk)
        raise type(end)(f"{end}: {why}" if why else str(end)) from None
