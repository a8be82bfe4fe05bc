"""Plans that are to be carried out: joints and hooks keep something back for what no plan foresees."""

import copy
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from ...actions.plan import Plan
from ...errors import StartError
from ...execution.climb.course import lay_course
from ...execution.climb.here import GENERATORS, hold_document
from ...execution.climb.sequencer import Replan
from ...planning.budgets import accepts
from ...planning.planners import find_planner
from ...planning.result import PlanResult
from ...robots.hooks import HOOK_AHEAD, HOOK_WAY, HOOK_WIDTH
from ...tasks.library import change_task, task_from_document
from ...tasks.limbed import LimbedTask
from ...types import Json
from ...units import DEGREE, INCH
from ...worlds.board import Hold
from .rehearsal import Rehearsal

MM: Final = 1e-3
Rehearse: TypeAlias = Callable[[LimbedTask, Plan], Rehearsal]
"""Climbs by a plan before anything moves."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Caution:
    """What a plan keeps back."""

    hook_cone: float = 55.0
    """Hooks pull within this of their grab direction [deg]."""
    hold_cone: float = 60.0
    """Holds that state no direction are pulled within this of straight down [deg]: limbs carry, they don't pull one against the other."""
    strength: float = 1.5
    """Most force on a hold that states no strength, of the robot's weight [-]."""
    pull: float = 0.15
    """Least pull of every hook that carries, of the robot's weight [-]: with less, the joints' friction lets it slip off."""
    share: float = 0.4
    """Of the motors' torque that a plan may use [-]."""
    spare: float = 1.0
    """Reach that limbs leave, also while they hold: a stretched elbow is soft, and may pass to the other side [in]."""
    bend: float | None = None
    """What of it limbs leave that hold; None: all of it [in]."""
    room: float | None = None
    """Between holds, and links and hooks that pass them; None: links may lie on holds [mm]."""


CAUTIONS: Final = (
    Caution(),
    Caution(spare=0.5),
    Caution(hook_cone=60.0, pull=0.1, spare=0.7),
    Caution(hook_cone=60.0, hold_cone=75.0, pull=0.1, share=0.5, spare=0.5),
    Caution(hook_cone=65.0, hold_cone=75.0, strength=3.0, pull=0.05, share=0.6, spare=0.3),
    Caution(hook_cone=70.0, hold_cone=90.0, strength=5.0, pull=0.0, share=0.8, spare=0.0),
)
"""The next where there is no plan that is easy in every stance; then the easiest."""
ROOMY: Final = (
    Caution(spare=2.0, bend=0.0, room=3.0),
    Caution(hook_cone=50.0, hold_cone=90.0, strength=2.0, pull=0.1, bend=0.5, room=1.0),
)
"""Likewise where even the easiest of those is hard: holders and the ways of their hooks keep clear of other holds (`holder_peg`)."""
HARD: Final = 10.0
"""What counts against a plan that is hard, all its stances together."""
INCAUTIOUS: Final = 10.0
"""What being less cautious counts in one that is not."""
EASY: Final = 3.5
"""What may count against a stance that is easy to hold: no link on a hold, no hook or motor much beyond what is wished."""


def plan_to_climb(
    task: LimbedTask,
    planner: str,
    *,
    seconds: float,
    seed: int,
    threads: int | None = None,
    cut: Callable[[], None] = lambda: None,
    rehearse: Rehearse | None = None,
) -> Plan | None:
    """The most cautious plan that is easy to carry out, or the easiest of the cautious ones, or any; of several the one that climbs.

    What a search may see is limited by the planner, so the plan is the same on any number of cores, busy or not, unless a search takes
    longer than it may.

    Args:
        task: Under the rules that can be carried out.
        planner: Its name.
        seconds: Most time for each search.
        seed: Of the planner.
        threads: Threads; None for one a core.
        cut: Told of each search that its seconds ended: another machine may find another plan.
        rehearse: Climbs by a plan in simulation; None: ease alone decides.
    """
    stated = {"seconds": seconds, "seed": seed, "threads": threads}
    options = {name: value for name, value in stated.items() if accepts(planner, name)}

    def search(task: LimbedTask) -> PlanResult:
        result = find_planner(planner)(task, **options)
        if result.seconds >= seconds:
            cut()
        return result

    found: list[tuple[float, Plan]] = []
    against = math.inf
    ranked = (*enumerate(CAUTIONS), *(enumerate(ROOMY) if hooked(task) else ()))
    for rank, caution in ranked:
        if caution.room is not None and against <= HARD:
            break
        try:
            result = search(cautious(task, caution))
        except StartError:  # it stands where a cautious plan would not take it
            continue
        if not result.has_plan:
            continue
        # the same actions, for the robot and the board as they are
        plan = Plan.of_codes(task, result.plan.codes(task), seed=seed, planner=result.plan.planner)
        course = lay_course(task, plan)
        own = math.inf if course.objections else float(np.maximum(course.against - EASY, 0.0).sum())
        hardship = own + (INCAUTIOUS * rank if own > 0.0 else 0.0)
        against = min(against, own)
        found.append((hardship, plan))
        if hardship == 0.0:
            break
    found.sort(key=lambda each: each[0])
    if found:
        return found[0][1] if rehearse is None else _rehearsed(found, task, rehearse)
    try:
        result = search(task)
    except StartError:  # it stands where no plan may begin
        return None
    return result.plan if result.has_plan else None


def _rehearsed(found: list[tuple[float, Plan]], task: LimbedTask, rehearse: Rehearse) -> Plan:
    """The first plan whose rehearsal is flawless, or the one that did best, the easier of equals; by hardship, infinite where refused."""
    best, most = found[0][1], None
    seen: set[bytes] = set()
    for hardship, plan in found:
        codes = plan.codes(task).tobytes()
        if codes in seen or math.isinf(hardship):
            continue
        seen.add(codes)
        done = rehearse(task, plan)
        if done.flawless:
            return plan
        if most is None or done > most:
            best, most = plan, done
    return best


def hooked(task: LimbedTask) -> bool:
    """Whether any limb ends in what only pulls."""
    return any(limb.end.kind != "gripper" for limb in task.robot.limbs)


def cautious(task: LimbedTask, caution: Caution) -> LimbedTask:
    """A task that asks for more than its checks do, so that what holds in it can bear to be carried out."""
    document = copy.deepcopy(task.document)
    hooks = hooked(task)
    if hooks:  # grippers may well push one against the other
        board = {key: value for key, value in document["board"].items() if key not in GENERATORS}
        document["board"] = board | {"holds": [_spared(hold, task.robot.weight, caution) for hold in task.world.holds]}
    changed = task_from_document(document, "cautious task")
    rules = task.rules
    stretched = (caution.bend is None and hooks) or rules.offset_while_holding
    settings = [
        f"rules.hook_cone={min(rules.hook_cone / DEGREE, caution.hook_cone)!r} deg",
        f"rules.hook_pull={max(rules.hook_pull, caution.pull * task.robot.weight)!r} N",
        f"rules.reach_offset={max(rules.reach_offset, caution.spare * INCH)!r} m",
        f"rules.offset_while_holding={str(stretched).lower()}",
        f"rules.holding_offset={max(rules.holding_offset, (caution.bend or 0.0) * INCH * hooks)!r} m",
        f"motor.torque_limit={caution.share * task.robot.motor.torque_limit!r} N m",
    ]
    if caution.room is not None:
        room = caution.room * MM
        hard = dict.fromkeys((*rules.hard, "holder_peg"))
        settings += [
            f"rules.hard=[{', '.join(repr(name) for name in hard)}]",
            f"rules.hook_width={HOOK_WIDTH + 2.0 * room!r} m",
            f"rules.hook_ahead={HOOK_AHEAD!r} m",  # no room there: its own hold stops it
            f"rules.hook_way={HOOK_WAY + room!r} m",
            f"link_radius={task.robot.link_radius + room!r} m",
        ]
    cautious_task = change_task(changed, settings)
    assert isinstance(cautious_task, LimbedTask)  # the robot stays what it is
    return cautious_task


def _spared(hold: Hold, weight: float, caution: Caution) -> Json:
    if hold.direction is None:
        made = hold_document(hold, -90.0 * DEGREE, caution.hold_cone * DEGREE)
    else:
        made = hold_document(hold, hold.direction, hold.cone)
    return {"strength": f"{caution.strength * weight!r} N"} | made


def replanner(
    planner: str, *, seconds: float, seed: int, threads: int | None = None, cut: Callable[[], None] = lambda: None
) -> Replan:
    """What a sequencer asks for another plan; see `plan_to_climb`."""

    def replan(task: LimbedTask) -> Plan | None:
        return plan_to_climb(task, planner, seconds=seconds, seed=seed, threads=threads, cut=cut)

    return replan
