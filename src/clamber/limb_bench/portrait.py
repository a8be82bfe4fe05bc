"""A portrait of each law: one step, one circle, one push or wall, on an ideal and a nominal limb, at matched or recommended gains."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Annotated, Any, Final

import numpy as np

from ..control.law_settings import LAWS, LawSettings
from ..errors import UnknownNameError
from ..json_form import HIDDEN, Jsonable, Key, in_json
from ..sim.bench_limb import BenchLimb
from ..sim.flaw_texts import SET, named_flaws
from ..sim.limb_flaws import LimbFlaws
from ..types import Floats
from .bench_limb import bench_limb
from .entries import GAINS, Match, gain_unit, make_entries, tip_stiffness, with_recommended_gains
from .force import ForceRow, force_entries, run_force
from .measures import Entry, ForceMeasures, Measured, Measures, measure
from .result import BenchResult
from .runner import run_contest
from .scenario import ForceTask, Scenario, circle_scenario, push_scenario, step_scenario

SCHEMA: Final = "clamber-limb-portrait-1"
STEP_START: Final = (0.22, 0.0)
"""Where the step and the push find the limb, and gains are matched [m]."""
CIRCLE_START: Final = (0.27, 0.0)
"""On the circle of 5 cm about there [m]."""
FEEDFORWARD: Final = {"feed_friction": 1.0, "feed_acceleration": True}
"""What any law may feed forward from the model, besides the aim's speed."""
COMPENSATION: Final[dict[str, str]] = {"admittance": "wrist+model", "hybrid": "model", "implicit-force": "model"}
"""Law for forces -> compensation of joint friction in its portrait, beside none."""
SCENES: Final = ("step", "circle", "fed", "push")
"""Motions of a portrait; "fed" is the circle with `FEEDFORWARD`."""


def _by_friction(forces: Mapping[str, tuple[ForceRow, ...]]) -> dict[str, dict[str, ForceMeasures]]:
    """Plant -> way of dealing with friction -> what came of it."""
    return {
        plant: {row.entry.label.partition(" / ")[2]: row.measures for row in rows} for plant, rows in forces.items()
    }


@dataclass(frozen=True, slots=True, eq=False)
class Portrait(BenchResult):
    """One law in every scene, by plant: "ideal" and "nominal"."""

    picture = "portrait:draw_portrait"
    settings: Annotated[LawSettings, Key("law", get=attrgetter("law"), kind=str), Key(kind=dict[str, Any])]
    stiffness: Annotated[Floats, Key(kind=list[list[float]])]
    """At the tip at `STEP_START`, shape (2, 2) [N/m]."""
    motions: Annotated[Mapping[str, Mapping[str, Measured[Measures]]], HIDDEN]
    """Scene -> plant -> what happened."""
    scenarios: Annotated[Mapping[str, Scenario], HIDDEN]
    """Scene -> what was asked for."""
    task: Annotated[ForceTask, HIDDEN]
    forces: Annotated[
        Mapping[str, tuple[ForceRow, ...]],
        Key(get=_by_friction, kind=dict[str, dict[str, ForceMeasures]], after="figures"),
    ]
    """Plant -> on the wall with joint friction left alone, then dealt with; empty of a law that holds no force."""

    @property
    def law(self) -> str:
        """Its name."""
        return self.settings.law

    @in_json(after="stiffness")
    def figures(self) -> dict[str, dict[str, float | None]]:
        """Figure -> plant -> value in SI; None where the run was unstable.

        `step` and `push_across` are the largest true distances across, `circle` and `fed` the root mean squares of the true distance from
        the circle in the last lap, `push` the largest yielding along the push.
        """
        picks = {
            "step": ("step", "across_max"),
            "circle": ("circle", "radial_rms"),
            "fed": ("fed", "radial_rms"),
            "push": ("push", "along_max"),
            "push_across": ("push", "across_max"),
        }
        out: dict[str, dict[str, float | None]] = {}
        for name, (scene, key) in picks.items():
            plants = self.motions[scene].items()
            out[name] = {
                plant: None if one.measures.unstable_at is not None else getattr(one.measures.true, key)
                for plant, one in plants
            }
        return out

    def gains_row(self) -> tuple[str, ...]:
        """Its line in a table: law, kp, kd with units; stiffness of the tip along x and y [N/mm]."""
        gains = (f"{getattr(self.settings, key):.4g} {gain_unit(self.law, key)}" for key in GAINS)
        return (self.law, *gains, *(f"{1e-3 * value:.2f}" for value in np.diag(self.stiffness)))

    def row(self) -> tuple[str, ...]:
        """Its line in a table: law; in mm the step, the circle, the circle fed and the push, on the ideal and the nominal limb each."""
        told = self.figures()
        numbers = (told[name][plant] for name in SCENES for plant in SET)
        return (self.law, *("unstable" if value is None else _millimetres(value) for value in numbers))

    def force_rows(self) -> list[tuple[str, ...]]:
        """Lines in a table: law, way with friction; mean and largest error in N on the ideal and on the nominal limb."""
        out = []
        for ideal, nominal in zip(*(self.forces[plant] for plant in SET), strict=True) if self.forces else ():
            law, _, way = ideal.entry.label.partition(" / ")
            errors = (value for row in (ideal, nominal) for value in (row.measures.mean_error, row.measures.worst))
            out.append((law, way, *(f"{round(value, 2) + 0.0:.2f}" for value in errors)))
        return out


@dataclass(frozen=True, slots=True, kw_only=True)
class Portraits(Jsonable):
    """Laws, each with what it does."""

    schema: str = SCHEMA
    seed: int
    laws: tuple[Portrait, ...]


def paint_portraits(
    laws: Sequence[str] = (),
    *,
    robot: str = "libra",
    limb: str | None = None,
    matched: LawSettings | None = None,
    match: Match = "yy",
    seed: int = 1,
) -> list[Portrait]:
    """Portraits of laws by name; of all unless some are named.

    Args:
        laws: Their names.
        robot: A climber's name or file.
        limb: Its limb, by name or from 1; None: the first.
        matched: Law that the gains of all are matched to; None: gains as recommended for the limb.
        match: In which sense they are matched.
        seed: Draws on which side of its play each joint of the nominal limb starts, and its encoders' phases.

    Raises:
        UnknownNameError: If there is no such law, robot or limb.
        RecommendationError: If nobody tuned a law on this limb.
        StartError: If the limb cannot start where the scenes do.
        ScenarioError: If it cannot reach what they ask for.
    """
    chosen = tuple(laws) or tuple(LAWS)
    for law in chosen:
        if law not in LAWS:
            raise UnknownNameError("controller", law, tuple(LAWS))
    stands, rounds = (bench_limb(robot, limb, start) for start in (STEP_START, CIRCLE_START))
    texts = chosen if matched is not None else with_recommended_gains(stands, chosen)
    entries = make_entries(stands, texts, matched or LawSettings(law="scct"), match, stands.q0)
    plants = {name: named_flaws(name, stands.robot) for name in SET}
    plants["nominal"] = plants["nominal"].with_changes(seed=seed)
    rate = plants["nominal"].control_rate
    circle = circle_scenario(rounds, rate, lap=3.0)
    scenarios = {"step": step_scenario(stands, rate, seconds=4.0), "circle": circle, "fed": circle}
    scenarios["push"] = push_scenario(stands, rate)
    told: dict[str, dict[str, list[Measured[Measures]]]] = {}
    for scene in SCENES:
        at = rounds if scenarios[scene].kind == "circle" else stands
        told[scene] = {
            plant: _move(at, scenarios[scene], _with_feedforward(entries) if scene == "fed" else entries, flaws)
            for plant, flaws in plants.items()
        }
    task = ForceTask()
    return [
        Portrait(
            entry.settings,
            tip_stiffness(stands.chain, entry.settings, stands.q0),
            {scene: {plant: runs[k] for plant, runs in by_plant.items()} for scene, by_plant in told.items()},
            scenarios,
            task,
            _press(stands, task, entry.settings.law, plants),
        )
        for k, entry in enumerate(entries)
    ]


def _millimetres(value: float) -> str:
    return f"{1e3 * value:.2f}" if value >= 1e-4 else f"{1e3 * value:.3f}"


def _move(limb: BenchLimb, scenario: Scenario, entries: Sequence[Entry], flaws: LimbFlaws) -> list[Measured[Measures]]:
    return [Measured(run, measure(run, scenario, limb)) for run in run_contest(limb, scenario, entries, flaws)]


def _with_feedforward(entries: Sequence[Entry]) -> list[Entry]:
    return [replace(entry, settings=entry.settings.with_changes(**FEEDFORWARD)) for entry in entries]


def _press(
    limb: BenchLimb, task: ForceTask, law: str, plants: Mapping[str, LimbFlaws]
) -> dict[str, tuple[ForceRow, ...]]:
    if law not in COMPENSATION:
        return {}
    ways = ("none", COMPENSATION[law])
    return {
        plant: run_force(limb, task, force_entries(limb, task, flaws, [law], ways), flaws).rows
        for plant, flaws in plants.items()
    }
