"""One action of a plan at a time, tried again where it fails: from other poses of the body, with the other elbow."""

import math
from typing import Final

import numpy as np

from ....execution.run_report import Outcome
from ....types import Floats
from .climber import Climber, Grabbed
from .executable_plan import ExecutablePlan, swings
from .grabbing import grab, press_on, release
from .hang import Hang, release_to_hang
from .hook import may_stay
from .motions import clear_the_way, is_clear, move_body
from .parking import OUT, unwound

ELSEWHERE: Final = ((0.0, 0.0), (0.0, 0.02), (0.0, -0.02), (0.025, 0.0), (-0.025, 0.0))
"""Where the body goes for another approach after a miss, from the plan's pose [m]."""
FARTHER: Final = ((0.0, 0.045), (0.0, -0.045), (0.05, 0.0), (-0.05, 0.0))
"""Likewise where a limb has found no way from any of these [m]."""
DROPS: Final = (0.0, 0.02, 0.04, 0.06)
"""By how much a body that hangs goes lower, in turn, for its free limbs to come out between holds [m]."""
WORST: Final = -8.0
"""How badly off the worst of hooks and motors may be where the body goes for that [N]."""
ARRIVED: Final = 0.02
"""A body nearer to its aim than this has come to it [m]."""
TURNED: Final = math.radians(6.0)
"""Likewise [rad]."""
SHIFTED: Final = 0.005
"""A body's aim farther from the plan's pose than this is brought back before a grab [m], [rad]."""
SETTLING: Final = 1.0
"""Most time that it gets to come there after its way [s]."""
SLID: Final = (0.008, 0.02)
"""A tip that clings and seems to be the first of these back from its hold has slid off it, or the second off it any other way [m]."""
PAUSE: Final = 0.1
"""Between two looks at that [s]."""


class Actor:
    """Carries out actions of a course.

    Args:
        climber: The robot.
        course: The plan; another may take its place.
    """

    def __init__(self, climber: Climber, course: ExecutablePlan) -> None:
        self.climber, self.course = climber, course
        self.missed: set[int] = set()
        """Numbers of holds that could not be had."""
        self.hanging: Hang | None = None
        """While the body hangs on one limb as the plan has it."""

    def carry_out(self, first: int, last: int) -> tuple[Outcome, int, str]:
        """Carry out one action, or like moves of the body in a row, by their first and last step from 1.

        Returns:
            What became of it, in how many tries, and why it was not done.

        Raises:
            SlippedError: If a hook comes off.
            FallenError: If the robot falls.
        """
        action = self.course.actions[first - 1]
        if (
            action.limb is not None
            and self.hanging is not None
            and self.hanging.i == self.climber.robot.limb_index(action.limb)
        ):
            return "not supported", 0, "it is the last limb that holds"
        if swings(self.course, last):
            refused = self._hang(last)
            if refused:
                return "not supported", 0, refused
            if action.kind != "grab":
                return "ok", 1, ""
        if action.kind == "move":
            return self._move(last)
        if action.limb is not None:
            slid = self._press_on(self.climber.robot.limb_index(action.limb))
            if slid:
                return "missed", 1, slid
        if action.kind == "release":
            assert action.limb is not None
            i = self.climber.robot.limb_index(action.limb)
            if self.climber.body.tasks[i].hold:  # a slip may have done it
                release(self.climber, i)
            if self.climber.body.tasks[i].hold:
                self._release_farther_back(i, first)
                if self.climber.body.tasks[i].hold:
                    return "missed", 2, "its hook stays wedged on its hold"
                return "ok", 2, ""
            return "ok", 1, ""
        if action.kind == "grab":
            return self._grab(first)
        return "ok", 0, ""

    def catch_up(self, step: int) -> bool:
        """Come to before a step from the holds that the robot has: as the plan did, where it had just these before.

        A limb that has slipped into a hang may reach no hold but the one that it came from.

        Raises:
            SlippedError: If a hook comes off.
            FallenError: If the robot falls.
        """
        course, body = self.course, self.climber.body
        names = self.climber.robot.limb_names
        held = {name: task.hold for name, task in zip(names, body.tasks, strict=True)}
        sides = [int(math.copysign(task.hold > 0, body.q[i, 1])) for i, task in enumerate(body.tasks)]
        had = [k for k in range(step - 1) if course.holds(k) == held and course.elbows[k].tolist() == sides]
        if sum(map(bool, sides)) < 2 or not had:
            return False
        start = min(had, key=lambda k: float(np.hypot(*(self.pose(k) - body.settled)[:2])))
        move_body(self.climber, self.pose(start))
        between = (group for group in course.groups() if start < group[0] and group[1] < step)
        return all(self.carry_out(*group)[0] in ("ok", "stalled") for group in between)

    def _press_on(self, acts: int) -> str:
        """Take holds once more that clinging limbs have slid off, before another limb acts and they are to carry; why that failed.

        Nothing but a gentle pull keeps a limb that clings on its hold while the body moves.
        """
        body = self.climber.body
        for i, task in enumerate(body.tasks):
            if i == acts or task.mode != "unloaded_contact":
                continue
            off = task.place - body.tip(i)
            far = float(np.hypot(*off)) > SLID[1]
            if not far and (float(off @ body.grab_direction(i)) < SLID[0] or press_on(self.climber, i)):
                continue
            number, side = task.hold, int(math.copysign(1, body.q[i, 1]))
            if not grab(self.climber, i, number, elbow=side).held:
                return f"'{self.climber.robot.limbs[i].name}' has slid off hold {number}, and does not take it again"
        return ""

    def _hang(self, step: int) -> str:
        """The body comes to hang, or moves as it hangs, as the plan has it after a step; why not, where that cannot be."""
        climber, tasks = self.climber, self.climber.body.tasks
        if not climber.hangs:
            acts = self.course.actions[step - 1].limb
            leaving = None if acts is None else self.climber.robot.limb_index(acts)
            stay = [i for i, task in enumerate(tasks) if task.hold and i != leaving]
            if leaving is None or len(stay) != 1:
                return "more than one limb would have to let go"
            self.hanging = release_to_hang(climber, leaving, stay[0])
            if self.hanging is None:
                return "the weight cannot be brought below the hold that is to carry it alone"
        elif self.hanging is None:  # a slip has left the body to one limb
            self.hanging = Hang(climber, climber.holding()[0])
        hanging = self.hanging
        self._come_clear(hanging, self.pose(step))
        hanging.bring(self.pose(step))
        hanging.calm()
        return ""

    def _come_clear(self, hanging: Hang, pose: Floats) -> None:
        """Bring free limbs to where they meet no hold as the body goes to a pose, from lower down where they do not get out from here."""
        climber = self.climber
        for drop in DROPS:
            lower = climber.body.settled.copy() if drop == 0.0 else pose - np.array((0.0, drop, 0.0))
            if drop > 0.0:
                hanging.bring(lower)
                hanging.calm()
            clear_the_way(climber, pose, OUT)
            if is_clear(climber, pose, OUT):
                return

    def _move(self, step: int) -> tuple[Outcome, int, str]:
        """The body goes to the plan's pose; once more where it does not come there."""
        for tries in (1, 2):
            if move_body(self.climber, self.pose(step)) and self._settle():
                return "ok", tries, ""
        short = float(np.hypot(*(self.pose(step) - self.climber.body.settled)[:2]))
        return "stalled", 2, f"the body stays {1e3 * short:.0f} mm off where it was to go"

    def _release_farther_back(self, i: int, step: int) -> None:
        """Take a wedged hook off where it was less turned: back along the plan's poses with the same holds, then on to where it was.

        A hook turns about its hold as the body moves, and a hold beside that one may come to lie between its lips.
        """
        course, climber = self.course, self.climber
        back = step - 1
        while back > 0 and climber.body.tasks[i].hold and course.holds(back - 1) == course.holds(step - 1):
            back -= 1
            move_body(climber, self.pose(back))
            release(climber, i)
        for at in range(back + 1, step):
            move_body(climber, self.pose(at))

    def _grab(self, step: int) -> tuple[Outcome, int, str]:
        action = self.course.actions[step - 1]
        if action.limb is None or action.hold is None:
            return "missed", 0, "the plan names no hold"
        i, tries = self.climber.robot.limb_index(action.limb), 0
        elbow = int(self.course.elbows[step, i])
        side = math.copysign(1.0, self.climber.holds[action.hold][0] - self.pose(step)[0])
        result = Grabbed(False, 0, 0.0, 0.0)
        sides = [elbow, -elbow] if self.course.serves(self.climber.body.legs, i, step, -elbow) else [elbow]
        for elbow in sides:
            for x, y in (*ELSEWHERE, *FARTHER):
                if result.tries and (x, y) in FARTHER:
                    break
                place = self.pose(step) + np.array((side * x, y, 0.0))
                off = float(np.abs(place - self.climber.body.aim).max())
                home = None
                if not self.climber.hangs and off > SHIFTED:  # also by the approach to the hold before
                    if (x or y) and self.climber.body.stands(place) < WORST:
                        continue
                    if not (x or y) and may_stay(self.climber, i, place):
                        home = place
                    else:
                        move_body(self.climber, place)
                result = grab(self.climber, i, action.hold, elbow=elbow, home=home)
                tries += max(1, result.tries)
                if result.held:
                    self.course.elbows[self.course.stays(i, step), i] = elbow
                    if self.hanging is not None:
                        self.hanging.end()
                        self.hanging = None
                    return "ok", tries, ""
            if result.tries:
                break  # there is a way; the hook does not take
        self.missed.add(action.hold)
        if not result.tries:
            return "missed", tries, "the limb finds no way there"
        return (
            "missed",
            tries,
            f"the hook stopped {1e3 * result.along:+.0f}, {1e3 * result.across:+.0f} mm from the hold",
        )

    def _settle(self) -> bool:
        for _ in range(round(SETTLING / PAUSE)):
            if self._arrived():
                return True
            self.climber.wait(PAUSE)
        return self._arrived()

    def _arrived(self) -> bool:
        body = self.climber.body
        return self.off() < ARRIVED and abs(float(body.aim[2] - body.settled[2])) < TURNED

    def off(self) -> float:
        """How far the body is from its aim, as believed [m]."""
        body = self.climber.body
        return float(np.hypot(*(body.aim[:2] - body.settled[:2])))

    def pose(self, step: int) -> Floats:
        """The plan's pose, by as much aside as its holds are from where they were mapped, its angle counted on from where the body is."""
        pose = self.course.pose(step)
        pose[:2] += self.shift(step)
        return unwound(pose, float(self.climber.body.aim[2]))

    def shift(self, step: int) -> Floats:
        """How far the holds of a step of the plan are believed to be from where they were mapped, shape (2,) [m]."""
        return self.climber.map.shift(number for number in self.course.holds(step).values() if number)
