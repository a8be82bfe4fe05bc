"""Settings "key=value" of a run: those of its plant are told from those of its task or walk by their first word."""

from collections.abc import Sequence
from typing import Final

PLANT: Final = "plant."
"""First word of settings that change the plant."""


def split_settings(settings: Sequence[str]) -> tuple[list[str], list[str]]:
    """Those of the task or walk, and those of the plant without their "plant."."""
    plant = [text[len(PLANT) :] for text in settings if text.startswith(PLANT)]
    return [text for text in settings if not text.startswith(PLANT)], plant
