"""Two-frame walkers: two frames of three legs that slide and turn over each other, an arm, slopes and steps."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ...family import Family


class Walker(Family):
    """The two-frame walker."""

    name = "walker"
    title = "two-frame walker"
    data = Path(__file__).parent / "data"
    commands = MappingProxyType(
        {
            name.replace("_", "-"): f"clamber.families.walker.cli.{name}:{name}"
            for name in ("follow", "max_setting", "calibrate", "ditch")
        }
    )
    parts = MappingProxyType(
        {
            "checks": "clamber.families.walker.statics.checks:WALKER_CHECKS",
            "files": "clamber.families.walker.planning.task:FILES",
            "plans": "clamber.families.walker.planning.plans:PLANS",
            "relaxations": "clamber.families.walker.planning.relaxations:walker_relaxations",
            "pictures": "clamber.families.walker.pictures.pictures:PICTURES",
            "scenes": "clamber.families.walker.pictures.scenes:SCENES",
            "trajectories": "clamber.families.walker.trajectories:TRAJECTORIES",
            "inspection": "clamber.families.walker.inspection:INSPECTION",
            "printed": "clamber.families.walker.printed:PRINTED",
            "dynamics": "clamber.families.walker.dynamics:DYNAMICS",
            "model": "clamber.families.walker.sim.walker_model:lone_walker",
        }
    )

    def other_work(self, name_or_path: str, overrides: Sequence[str] = ()) -> Any | None:
        """Walks."""
        from .planning import is_walk, load_walk

        return load_walk(name_or_path, overrides) if is_walk(name_or_path) else None

    def other_names(self) -> tuple[str, ...]:
        """Walks."""
        from .planning import walk_names

        return walk_names()


WALKER = Walker()
