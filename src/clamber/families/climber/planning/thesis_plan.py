"""Plan files of printed plans: TOML with the thesis's numbers, and the pegs taken, where they are printed."""

from pathlib import Path
from typing import Annotated, Final

import numpy as np
from pydantic import Field, StrictStr

from ....errors import SpecError
from ....files import Document, read_toml
from ....planning.problem.codes import Code
from ....planning.problem.plan import Plan
from ....planning.problem.plan_source import OpenedPlan
from ....planning.problem.problems import ActionError
from ....specs import build_spec, spec
from ....tasks import Task, load_task
from .plans import hold_code, thesis_code
from .task import LimbedTask, limbed

Positive = Annotated[float, Field(strict=True, gt=0.0, allow_inf_nan=False)]
Number = Annotated[int, Field(strict=True, ge=0, le=999)]
TASK_NAMES: Final = {"modladder": "modified-ladder"}
"""What such files call a task -> its name here."""


@spec
class ThesisPlan:
    """A plan as it is printed."""

    task: StrictStr
    """Name of the task, such as "ladder" or "modladder"."""
    source: StrictStr = ""
    """Where it is printed."""
    step_inch: Positive
    """Length of a body move [in]."""
    step_deg: Positive
    """Angle of a body move [deg]."""
    n_steps: Annotated[int, Field(strict=True, ge=0)]
    """Number of actions, as a check that none got lost."""
    actions: tuple[Number, ...]
    """0, 1..6, N00, NXX, N9k."""
    actual_peg: tuple[Number, ...] | None = None
    """The peg that each action took as printed; 0: none printed."""

    def step_overrides(self, overrides: tuple[str, ...]) -> tuple[str, ...]:
        """The overrides that give the task this plan's step sizes, except where `overrides` set them."""
        own = (f"step.length={self.step_inch:.12g}in", f"step.angle={self.step_deg:.12g}deg")
        said = {text.partition("=")[0].strip() for text in overrides}
        return tuple(text for text in own if not {text.partition("=")[0], "step"} & said)

    def load_task(self, name: str | None, overrides: tuple[str, ...]) -> Task:
        """The task that it is a plan for, with its step sizes.

        Args:
            name: A task in place of the one that the file names.
            overrides: Texts "key=value"; a step size in them wins over the file's.
        """
        return load_task(name or TASK_NAMES.get(self.task, self.task), (*self.step_overrides(overrides), *overrides))

    def asked(self, task: LimbedTask, label: str = "plan") -> list[int]:
        """Packed codes of the printed numbers, "nearest" as it is; errors call the plan `label`.

        Raises:
            SpecError: If limb or hold of a number do not exist.
        """
        codes = []
        for index, number in enumerate(self.actions):
            try:
                codes.append(thesis_code(task, number))
            except ActionError as error:
                raise self._problem(label, f"actions.{index}", error.allowed) from None
        return codes

    def taken(self, task: LimbedTask, label: str = "plan") -> list[int]:
        """The same with the printed pegs in place of "nearest".

        Raises:
            SpecError: If limb or hold of a number do not exist, or a peg is printed for an action that takes none.
        """
        codes = self.asked(task, label)
        for index, peg in enumerate(self.actual_peg or ()):
            if not peg:
                continue
            opened = Code.of(codes[index])
            if opened.kind not in {"nearest", "random", "hold"}:
                allowed = f"must be 0, for action {self.actions[index]} takes no peg"
                raise self._problem(label, f"actual_peg.{index}", allowed)
            try:
                codes[index] = hold_code(task, opened.limb, peg)
            except ActionError as error:
                raise self._problem(label, f"actual_peg.{index}", error.allowed) from None
        return codes

    def _problem(self, label: str, key: str, allowed: str) -> SpecError:
        shown = {"actions": list(self.actions), "actual_peg": list(self.actual_peg or ())}
        return Document(label, shown).problem(key, f"{allowed} (step {int(key.split('.')[1]) + 1} of the plan)")

    def build(self, task: LimbedTask, label: str = "plan") -> Plan:
        """The plan in a task, with the pegs that it says were taken, else with those that "nearest" comes to."""
        genes = [str(number) for number in self.actions]
        return Plan.of_codes(task, self.taken(task, label), planner=self.source, genes=genes)


def load_thesis_plan(path: Path) -> ThesisPlan:
    """A printed plan from its TOML file.

    Raises:
        FileError: If it cannot be read or is no TOML.
        SpecError: If a key is missing, unknown or wrong, or the lists do not have `n_steps` entries.
    """
    document = read_toml(path)
    stated = build_spec(ThesisPlan, document)
    if len(stated.actions) != stated.n_steps:
        raise document.problem("n_steps", f"must be the number of actions, {len(stated.actions)}")
    if stated.actual_peg is not None and len(stated.actual_peg) != stated.n_steps:
        raise document.problem("actual_peg", f"must have an entry for each of the {stated.n_steps} actions")
    return stated


def open_thesis_plan(path: Path, name: str | None, overrides: tuple[str, ...]) -> OpenedPlan:
    """A printed plan with its task; `name` and `overrides` take the place of the task that it names."""
    printed, label = load_thesis_plan(path), str(path)
    task = limbed(printed.load_task(name, overrides), f"task of {label}")
    taken = printed.step_overrides(overrides)
    notes = (f"step sizes as the plan file says: {', '.join(taken)}",) if taken else ()
    asked = None if printed.actual_peg is None else np.array(printed.asked(task, label), np.int32)
    return OpenedPlan(task=task, plan=printed.build(task, label), label=label, asked=asked, notes=notes)
