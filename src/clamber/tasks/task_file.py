"""What task files of every family have in common: their format, the hashes of their parts, and rules for steps and checks."""

import math
from collections.abc import Mapping, Sequence
from typing import Final

from ..errors import describe_choices
from ..files import Document, content_hash

SCHEMA: Final = "clamber-task-1"


def hashes_of(document: Document, parts: Mapping[str, Document]) -> dict[str, str]:
    """Each part, and "task" for the rest -> SHA-256 of it."""
    rest = {key: value for key, value in document.data.items() if key not in {*parts, "labels"}}
    return {name: content_hash(part.data) for name, part in parts.items()} | {"task": content_hash(rest)}


def check_angle(angle: float, document: Document) -> None:
    """Make sure that steps of an angle [rad] fill a turn.

    Raises:
        SpecError: Otherwise.
    """
    steps = math.tau / angle
    if abs(steps - round(steps)) > 1e-9 * steps:
        allowed = f"must divide a turn; {steps:.6g} steps fill one, so take '{360 / max(1, round(steps)):.6g} deg'"
        raise document.problem("step.angle", allowed)


def check_hard(hard: Sequence[str], known: Sequence[str], document: Document) -> None:
    """Make sure that hard checks are known ones, each named once.

    Raises:
        SpecError: Otherwise.
    """
    for name in hard:
        if name not in known:
            raise document.problem("rules.hard", f"unknown check '{name}'; {describe_choices(name, tuple(known))}")
    if len(set(hard)) < len(hard):
        raise document.problem("rules.hard", "names a check twice")
