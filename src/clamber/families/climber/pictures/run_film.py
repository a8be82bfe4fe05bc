"""A climb as it truly was, as a film in its own time."""

from dataclasses import replace
from typing import Final

import numpy as np

from ....types import Floats
from ....viewing.browser.film import Film, MarginRow
from ..control.felt_force import feel_forces
from ..execution.legs import legs_of
from .climb_run_view import OUTCOMES, ClimbRunView, Moment

USUAL: Final = 8.0
"""A climb takes minutes: it is played that much faster than it was [-]."""
SMOOTH: Final = 0.15
"""Torques are averaged over so much time before and after a moment [s]."""


class ClimbFilm(Film[Moment]):
    """A climb that was carried out; the forces of holds are what its motors' torques and the links' weights tell.

    Args:
        view: Of the run.
    """

    speed = USUAL
    noun = "Action"
    words = OUTCOMES

    def __init__(self, view: ClimbRunView) -> None:
        self._view = view
        self.title, self.gauges = view.title, (view.gauges,)
        self.actions, self._trace = view.actions, view.trace
        self.seconds = float(self._trace.time[-1])
        self.steps = ("start", *(action.title for action in self.actions))
        self.grades = (3, *view.grades)
        self.starts = np.array([0.0, *(action.start for action in self.actions)])
        self.ends = np.array([0.0, *(action.start + action.seconds for action in self.actions)])
        self._legs = legs_of(view.task.robot)

    def at(self, time: float) -> Moment:
        """See `Film`."""
        at = self._view.at_time(time)
        return replace(at, forces=self._forces(time))

    def _forces(self, time: float) -> Floats:
        """Forces of the holds on the tips by what the motors give, as if at rest, world frame, shape (n_limbs, 2) [N]."""
        trace = self._trace
        k = min(int(np.searchsorted(trace.time, time)), len(trace.time) - 1)
        first, last = np.searchsorted(trace.time, (time - SMOOTH, time + SMOOTH))
        torques = (
            trace.torques[first : max(last, first + 1)].mean(axis=0) if first < len(trace.time) else trace.torques[k]
        )
        n = len(self._legs)
        still, forces = np.zeros((n, 2)), np.zeros((n, 2))
        angle = float((trace.believed if trace.true_pose is None else trace.true_pose)[k, 2])
        feel_forces(
            self._legs, np.ones(n, np.int64), trace.angles[k], still, still.copy(), torques, angle, 1.0, 1.0,
            np.zeros((n, 2)), forces,
        )  # fmt: skip
        return -forces

    def values(self, at: Moment) -> tuple[Floats, ...]:
        """See `Film`."""
        return (self._view.values(at),)

    def facts(self, step: int, at: Moment) -> tuple[tuple[str, str], ...]:
        """See `Film`: the moment, and what was reported of the step."""
        told = list(zip(self._view.rows, self._view.facts(step, at), strict=True))
        if step:
            action = self.actions[step - 1]
            words = [
                action.outcome,
                f"plan's step {action.steps}",
                f"{action.seconds:.1f} s",
                f"body {1e3 * action.off:.1f} mm off its aim",
            ]
            words += [f"{action.tries} tries"] if action.kind == "grab" and action.tries > 1 else []
            words += [f"tip believed {1e3 * action.tip_error:.1f} mm off"] if action.tip_error is not None else []
            told.append(("Outcome", ", ".join(words)))
            if action.reason:
                told.append(("Why", action.reason))
        return tuple(told)

    def margins(self, step: int) -> list[MarginRow]:
        """See `Film`: nothing judges a run."""
        return []

    @property
    def worst(self) -> int | None:
        """See `Film`."""
        return 1 + int(np.argmin(self.grades[1:])) if len(self.grades) > 1 and min(self.grades[1:]) < 3 else None

    def planned_time(self, time: float, plan: Film[Moment]) -> float | None:
        """See `Film`: as far in the same action; None after another plan took its place."""
        step = self.step_at(time)
        if step == 0:
            return 0.0
        if step > self._of_first_plan:
            return None
        action = self.actions[step - 1]
        if max(action.first, action.last) >= len(plan.steps):
            return None
        share = min(1.0, (time - action.start) / max(action.seconds, 1e-9))
        begin, end = float(plan.starts[action.first]), float(plan.ends[action.last])
        return begin + share * (end - begin)

    @property
    def _of_first_plan(self) -> int:
        """How many actions were of the plan that the run began with."""
        notes = self._trace.notes or {}
        replans = notes.get("replans") or ()
        return int(replans[0]["after"]) if replans else len(self.actions)
