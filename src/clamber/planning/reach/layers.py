"""The layers of a map: which of its columns each shows, and which families have it."""

from dataclasses import dataclass
from typing import Final

from ...errors import ClamberError, UnknownNameError, describe_choices
from ...family import family_of
from ...tasks import Task


class LayerError(ClamberError):
    """A layer is asked for that the robot's model has nothing to say about."""

    def __init__(self, layer: str, family: str, allowed: tuple[str, ...]) -> None:
        super().__init__(layer, family, allowed)
        self.layer, self.family, self.allowed = layer, family, allowed

    def __str__(self) -> str:
        return (
            f"layer '{self.layer}': the model of the family '{self.family}' has no joint torques; "
            f"allowed are {describe_choices(self.layer, self.allowed)}"
        )


@dataclass(frozen=True, slots=True)
class Layer:
    """One thing that a map can show of every place."""

    column: str
    """Of the map's table; "least_" or "most_" and a burden of the family, or one that every map has."""
    title: str
    """What the number is, for a reader of the picture."""
    good: bool
    """Whether more is better."""


LAYERS: Final[dict[str, Layer]] = {
    "force": Layer("least_torque_Nm", "largest joint torque of the easiest stance", False),
    "payload": Layer("most_payload_N", "extra weight that the best stance still carries", True),
    "power": Layer("least_power_W", "power that the cheapest stance takes", False),
    "margin": Layer("margin", "smallest margin of the best stance, as a share of what is limited", True),
    "steps": Layer("first_step", "actions of the shortest way there", False),
}
"""Name -> layer."""
COMMON: Final = ("margin", "first_step")
"""Columns that the maps of every family have."""


def layers_of(task: Task) -> tuple[str, ...]:
    """Names of the layers that a task's map has; the first is shown unless another is asked for."""
    burdens = family_of(task).plans.burdens
    return tuple(
        name for name, layer in LAYERS.items() if layer.column in COMMON or layer.column.partition("_")[2] in burdens
    )


def choose_layer(task: Task, name: str | None) -> str:
    """The layer of that name, or the family's first.

    Raises:
        UnknownNameError: If there is no such layer.
        LayerError: If the family hasn't got it.
    """
    allowed = layers_of(task)
    if name is None:
        return allowed[0]
    if name not in LAYERS:
        raise UnknownNameError("layer", name, allowed)
    if name not in allowed:
        raise LayerError(name, task.document["robot"]["family"], allowed)
    return name
