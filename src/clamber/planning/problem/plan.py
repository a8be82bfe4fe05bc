"""A plan as a value and a file: the actions with every hold chosen, and the whole task that they were planned for."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Final

import numpy as np
from pydantic import Field, StrictStr

from ...errors import FileError, SpecError
from ...family import named_family
from ...files import Document, check_schema, parse_json, read_text, write_atomically
from ...notebook import Pictured
from ...specs import build_spec, spec
from ...tasks import Task, task_from_document
from ...types import Ints, Json
from .problems import ActionError as ActionError
from .problems import PlannedAction as PlannedAction
from .problems import plan_family

SCHEMA: Final = "clamber-plan-1"


@spec
class Plan(Pictured):
    """A sequence of actions for a task; it replays in the same way whoever made it."""

    task: StrictStr
    """Name of the task."""
    document: Json
    """The merged document of the task; `task_from_document` rebuilds it."""
    hashes: dict[str, StrictStr]
    """"robot", the world's key and "task" -> SHA-256 of that part of `document`."""
    actions: tuple[PlannedAction, ...]
    seed: Annotated[int, Field(strict=True, ge=0)] | None = None
    """Seed of the planner; None for a plan made by hand."""
    planner: StrictStr = ""
    """Who made it, such as "genetic/default" or a table of a paper."""

    def told(self) -> str:
        """How long, for what, by whom."""
        return f"of {len(self.actions)} actions for {self.task!r}{f' by {self.planner}' if self.planner else ''}"

    @classmethod
    def of_codes(
        cls,
        task: Task,
        codes: Sequence[int] | Ints,
        *,
        seed: int | None = None,
        planner: str = "",
        genes: Sequence[str | None] | None = None,
    ) -> "Plan":
        """A plan from packed codes: replays them, and writes down the holds that "nearest" and "random" came to.

        Args:
            task: The task.
            codes: Packed actions (`actions.codes`).
            seed: Seed of the planner.
            planner: Who made it.
            genes: What each action was called where it came from.
        """
        family = plan_family(task)
        replay = family.problem(task).replay(codes, go_on=True)
        names = genes if genes is not None else [None] * len(codes)
        actions = tuple(
            family.action(task, int(code), after, gene)
            for code, after, gene in zip(codes, replay.stances[1:], names, strict=True)
        )
        return cls(
            task=task.name,
            document=task.document,
            hashes=dict(task.hashes),
            actions=actions,
            seed=seed,
            planner=planner,
        )

    def codes(self, task: Task, label: str = "plan") -> Ints:
        """Packed codes for `CompiledProblem.replay`; every grab names its hold.

        Args:
            task: The task to carry the plan out in, its own or another.
            label: What errors call the plan.

        Raises:
            SpecError: If an action is none that the task's robot and board have.
        """
        family = plan_family(task)
        packed = np.zeros(len(self.actions), np.int32)
        for index, action in enumerate(self.actions):
            try:
                packed[index] = family.code(task, action)
            except ActionError as error:
                key = f"actions.{index}.{error.key}"
                value = getattr(action, error.key)
                raise SpecError(label, key, value, f"{error.allowed} (step {index + 1} of the plan)") from None
        return packed

    def numbers(self) -> list[int] | None:
        """The plan in the thesis's numbers, or None where one of its actions has none."""
        codes = [action.code for action in self.actions]
        return None if any(code is None for code in codes) else [code for code in codes if code is not None]

    def rebuild_task(self, label: str = "plan") -> Task:
        """The task that it was planned for.

        Raises:
            SpecError: If the document builds no task, or is no longer the one that was planned for.
        """
        try:
            task = task_from_document(self.document, f"{label}: document")
        except SpecError as error:  # a robot's or a board's own label alone would not say which plan it is in
            if error.file.startswith(label):
                raise
            raise SpecError(f"{label}: {error.file}", error.key, error.value, error.allowed, error.others) from None
        for part, known in task.hashes.items():
            if self.hashes.get(part) != known:
                allowed = f"must be {known[:12]}..., the hash of '{part}' in 'document'; plan again if that has changed"
                raise SpecError(label, f"hashes.{part}", self.hashes.get(part), allowed)
        return task

    def to_json(self) -> Json:
        """Plain data, as in the file."""
        return {
            "schema": SCHEMA,
            "task": self.task,
            "planner": self.planner,
            "seed": self.seed,
            "actions": [action.to_json() for action in self.actions],
            "hashes": dict(self.hashes),
            "document": self.document,
        }

    @classmethod
    def from_json(cls, data: Any, label: str = "plan") -> "Plan":
        """A plan from plain data.

        Raises:
            SpecError: If a key is missing, unknown or wrong; all problems are listed.
            FileError: If the data is no table.
        """
        if not isinstance(data, dict):
            raise FileError(label, "holds no table", f'a plan is a JSON object with schema = "{SCHEMA}"')
        document = Document(label, data)
        check_schema(document, SCHEMA)
        plan = build_spec(cls, document, without=("schema",))
        robot = plan.document.get("robot")
        family = named_family(robot.get("family")) if isinstance(robot, dict) else None
        if family is not None:  # else the document is the problem, which whoever rebuilds the task is told
            axes = family.plans.pose_axes
            for index, action in enumerate(plan.actions):
                if action.delta is not None and len(action.delta) != len(axes):
                    names = ", ".join(axis.name for axis in axes)
                    raise SpecError(
                        label, f"actions.{index}.delta", list(action.delta), f"must be {len(axes)} numbers: {names}"
                    )
        return plan

    def save(self, path: str | Path) -> None:
        """Write it as JSON; a crash never leaves half a file.

        Raises:
            FileError: If the folder is missing or cannot be written.
        """
        write_atomically(Path(path), self.text())

    def text(self) -> str:
        """Its file, as JSON."""
        return json.dumps(self.to_json(), indent=1) + "\n"


def load_plan(path: Path) -> Plan:
    """A plan from the JSON file that `Plan.save` wrote.

    Raises:
        FileError: If it cannot be read or is no JSON.
        SpecError: If it is no plan.
    """
    text = read_text(path)
    try:
        data = parse_json(text)
    except ValueError as error:
        raise FileError(str(path), f"is not valid JSON: {error}", "a plan is what `clamber plan -o` writes") from None
    return Plan.from_json(data, str(path))
