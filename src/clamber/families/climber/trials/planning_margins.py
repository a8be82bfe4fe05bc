"""What plans that are to be carried out keep back: a task that asks for more than its own checks do."""

import copy
from dataclasses import dataclass
from typing import Final

from ....tasks.library import change_task, task_from_document
from ....types import Json
from ....units import DEGREE, INCH
from ..execution.remaining_task import GENERATORS, hold_document
from ..planning.task import LimbedTask
from ..robot.robot import HOOK_AHEAD, HOOK_WAY, HOOK_WIDTH
from ..world.board import Hold

MM: Final = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanningMargins:
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
    """Between other holds, and links of limbs and the body; None: links may lie on holds [mm]."""
    flare: float = 0.0
    """Likewise between holds and hooks, where `room` is given [mm]."""
    inside: bool = False
    """Whether the weight stays between the holds that carry it: a hook beside both, or above one, bears next to nothing."""
    aloof: bool = False
    """Whether free limbs that ride with the body keep clear of holds, too, and all second links of the body."""
    swing: float | None = None
    """Most that the body turns as it comes to hang: its weight is below the hold that stays before the other hook comes off [deg]."""
    barred: tuple[tuple[str, int], ...] = ()
    """Limbs and numbers of holds that they may not take."""


PLANNING_MARGINS: Final = (
    PlanningMargins(),
    PlanningMargins(spare=0.5),
    PlanningMargins(hook_cone=60.0, pull=0.1, spare=0.7),
    PlanningMargins(hook_cone=60.0, hold_cone=75.0, pull=0.1, share=0.5, spare=0.5),
    PlanningMargins(hook_cone=65.0, hold_cone=75.0, strength=3.0, pull=0.05, share=0.6, spare=0.3),
    PlanningMargins(hook_cone=70.0, hold_cone=90.0, strength=5.0, pull=0.0, share=0.8, spare=0.0),
)
"""The next where there is no plan that is easy in every stance; then the easiest."""
STEADY: Final = (
    PlanningMargins(pull=0.2, bend=0.0, room=3.0, flare=3.0, inside=True),
    PlanningMargins(
        hook_cone=60.0, hold_cone=75.0, strength=2.0, pull=0.2, share=0.5, bend=0.5, room=10.0, flare=6.5, aloof=True
    ),
    PlanningMargins(
        hook_cone=60.0,
        hold_cone=90.0,
        strength=3.0,
        pull=0.2,
        share=0.6,
        spare=0.5,
        bend=0.2,
        room=10.0,
        flare=6.5,
        aloof=True,
    ),
)
"""Where even the easiest of those is hard, or none is carried out, the more cautious first: hooks pull more, holders and the ways of
their hooks keep clear of other holds, and either the weight is between them or free limbs keep clear of holds, too."""
HANGING: Final = (PlanningMargins(hold_cone=90.0, bend=0.0, room=4.0, flare=3.0, swing=5.0),)
"""Before those where a task allows hangs: a hook that is about to leave bears next to nothing, and may be pulled sideways."""
INSIDE: Final = ("stability",)
ALOOF: Final = ("limb_peg", "limb_body")
"""Checks that are hard then."""


def hooked(task: LimbedTask) -> bool:
    """Whether any limb ends in what only pulls."""
    return any(limb.end.kind != "gripper" for limb in task.robot.limbs)


def steady(task: LimbedTask) -> tuple[PlanningMargins, ...]:
    """Cautions of steadier plans for a task, in the order in which they are tried."""
    if not hooked(task):
        return ()
    return (*HANGING, *STEADY) if task.rules.max_hangs > 0 else STEADY


def with_margins(task: LimbedTask, margins: PlanningMargins) -> LimbedTask:
    """A task that asks for more than its checks do, so that what holds in it can bear to be carried out."""
    document = copy.deepcopy(task.document)
    hooks = hooked(task)
    if hooks:  # grippers may well push one against the other
        board = {key: value for key, value in document["board"].items() if key not in GENERATORS}
        document["board"] = board | {"holds": [_spared(hold, task.robot.weight, margins) for hold in task.world.holds]}
    if margins.barred:
        barred = {name: list(numbers) for name, numbers in task.rules.barred.items()}
        for name, number in margins.barred:
            barred[name] = [*barred.get(name, []), number]
        document["rules"] = document.get("rules", {}) | {"barred": barred}
    changed = task_from_document(document, "cautious task")
    rules = task.rules
    stretched = (margins.bend is None and hooks) or rules.offset_while_holding
    settings = [
        f"rules.hook_cone={min(rules.hook_cone / DEGREE, margins.hook_cone)!r} deg",
        f"rules.hook_pull={max(rules.hook_pull, margins.pull * task.robot.weight)!r} N",
        f"rules.reach_offset={max(rules.reach_offset, margins.spare * INCH)!r} m",
        f"rules.offset_while_holding={str(stretched).lower()}",
        f"rules.holding_offset={max(rules.holding_offset, (margins.bend or 0.0) * INCH * hooks)!r} m",
        f"motor.torque_limit={margins.share * task.robot.motor.torque_limit!r} N m",
    ]
    if margins.swing is not None:
        # with a number of hangs, the same stance after fewer and more of them would be two
        settings += [f"rules.max_swing={margins.swing!r} deg", "rules.max_hangs=-1"]
    if margins.room is not None:
        hard = dict.fromkeys((*rules.hard, "holder_peg", *INSIDE * margins.inside, *ALOOF * margins.aloof))
        settings += [
            f"rules.hard=[{', '.join(repr(name) for name in hard)}]",
            f"rules.hook_width={HOOK_WIDTH!r} m",
            f"rules.hook_ahead={HOOK_AHEAD!r} m",
            f"rules.hook_way={HOOK_WAY!r} m",
            f"rules.hook_room={margins.flare * MM!r} m",
            f"link_radius={task.robot.link_radius + margins.room * MM!r} m",
        ]
    cautious_task = change_task(changed, settings)
    assert isinstance(cautious_task, LimbedTask)  # the robot stays what it is
    return cautious_task


def _spared(hold: Hold, weight: float, margins: PlanningMargins) -> Json:
    if hold.direction is None:
        made = hold_document(hold, -90.0 * DEGREE, margins.hold_cone * DEGREE)
    else:
        made = hold_document(hold, hold.direction, hold.cone)
    return {"strength": f"{margins.strength * weight!r} N"} | made
