"""Climbers: two to eight limbs of two joints each in a plane, holds on a wall."""

from __future__ import annotations

from pathlib import Path
from types import MappingProxyType

from ...family import Family


class Climber(Family):
    """The climber of limbs in a plane."""

    name = "limbed"
    title = "limbed climber"
    data = Path(__file__).parent / "data"
    commands = MappingProxyType(
        {
            "validate": "clamber.families.climber.cli.validate:validate",
            "hold-force": "clamber.families.climber.cli.hold_force:hold_force",
        }
    )
    groups = MappingProxyType({"plant": "clamber.families.climber.cli.plant:plant"})
    parts = MappingProxyType(
        {
            "checks": "clamber.families.climber.statics.checks:LIMBED_CHECKS",
            "files": "clamber.families.climber.planning.task_file:FILES",
            "plans": "clamber.families.climber.planning.plans:PLANS",
            "relaxations": "clamber.families.climber.planning.relaxations:climber_relaxations",
            "one_hold_more": "clamber.families.climber.planning.one_hold_more:find_places",
            "printed_plan": "clamber.families.climber.planning.thesis_plan:open_thesis_plan",
            "pictures": "clamber.families.climber.pictures.pictures:PICTURES",
            "scenes": "clamber.families.climber.pictures.scenes:SCENES",
            "trajectories": "clamber.families.climber.trajectories:TRAJECTORIES",
            "inspection": "clamber.families.climber.inspection:INSPECTION",
            "printed": "clamber.families.climber.printed:PRINTED",
            "dynamics": "clamber.families.climber.dynamics:DYNAMICS",
            "bench_limb": "clamber.families.climber.sim.bench_limb:limb_for_bench",
            "model": "clamber.families.climber.sim.climber_model:lone_climber",
        }
    )


CLIMBER = Climber()
