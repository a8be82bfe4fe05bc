"""The studies by name: paper or subject, then result, to the function that repeats it, imported when it is called."""

from __future__ import annotations

from dataclasses import dataclass, replace
from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Callable

    from .result import StudyResult

BEVLY: Final = "bevly-1997"
BOARDS_EXACT: Final = "boards-exact"
HOSHINO: Final = "hoshino-1995"


@dataclass(frozen=True, slots=True)
class Repeat:
    """What repeats a result."""

    paper: str
    result: str
    path: str
    """Module below the paper's folder, and name of the function there."""
    arguments: tuple[str, ...] = ()

    @property
    def function(self) -> Callable[..., StudyResult]:
        """The function that its path names."""
        module, _, name = self.path.partition(":")
        found: Callable[..., StudyResult] = getattr(
            import_module(f"{__package__}.{self.paper.replace('-', '_')}.{module}"), name
        )
        return found

    def __call__(self, **options: Any) -> StudyResult:
        """Repeat it; only results of seeds have options."""
        return replace(self.function(*self.arguments, **options), paper=self.paper, result=self.result)


def _of(paper: str, paths: dict[str, str]) -> dict[str, Repeat]:
    """What repeats the results of a paper: name -> path, and arguments behind it."""
    words = {result: path.split() for result, path in paths.items()}
    return {result: Repeat(paper, result, path, tuple(rest)) for result, (path, *rest) in words.items()}


OF_PLANNING: Final = _of(
    BEVLY,
    {
        "inventory-size": "search_variants:count_modules",
        "ladder-plan": "printed_plans:repeat_plan ladder-plan",
        "h-hand-plan": "printed_plans:repeat_plan h-hand-plan",
        "h-planner-plan": "printed_plans:repeat_plan h-planner-plan",
        "modified-ladder-plan": "printed_plans:repeat_plan modified-ladder-plan",
        "across-plan": "printed_plans:repeat_plan across-plan",
        "circle-plan": "printed_plans:repeat_plan circle-plan",
        "hook-check": "printed_plans:check_hooks",
        "nominal-gait": "nominal_gait:climb_with_gait",
        "no-rotation": "modified_ladder:rotation_is_needed",
        "no-rotation-free": "modified_ladder:rotation_is_not_needed",
        "step-size": "modified_ladder:vary_step_size",
        "h-torques": "printed_plans:compare_h_torques",
        "modified-ladder-evolution": "evolution:follow_modified_ladder",
        "h-evolution": "evolution:follow_h",
        "planner-success": "search_variants:count_successes",
        "tail-crossover": "search_variants:compare_crossovers",
        "sub-goals": "search_variants:compare_subgoals",
        "learned-module": "learned_module:learn_to_climb",
        "modules-alone": "learned_module:plan_with_modules_alone",
        "push-pull": "static_forces:compare_push_pull",
        "static-torques": "static_forces:compare_torques",
    },
)
"""Chapter 2 of Bevly 1997: plans of action modules."""
ON_ONE_LIMB: Final = _of(
    BEVLY,
    {
        "fig-3-9": "limb_models:compare_models",
        "fig-3-10": "limb_open_loop:compare_transforms",
        "fig-3-11": "limb_tracking:step_response fig-3-11 ode",
        "fig-3-12": "limb_tracking:step_response fig-3-12 mujoco",
        "fig-3-13": "limb_tracking:track_circle",
        "fig-3-14": "limb_push:push_and_release",
        "fig-3-15": "limb_force:press_walls",
        "section-3-2-3": "limb_claims:damp_directions",
        "section-3-3-2": "limb_claims:compare_admittance",
    },
)
"""Chapter 3 of Bevly 1997: laws in closed loop."""
SEEDED: Final = _of(BEVLY, {"table-4-2": "body_table:count_lost_pegs"})
"""Results of seeds, as many as one asks for."""
ON_A_BODY: Final = {
    **_of(
        BEVLY,
        {
            "fig-4-15": "body_climb:show_gait",
            "fig-4-16": "body_climb:climb_two_steps",
            "fig-4-17": "body_motions:lead_body",
            "fig-4-18": "body_motions:push_body_up",
            "fig-4-19": "body_push:push_body",
            "section-4-4-2": "body_limit:limit_pulls",
            "section-4-4-3": "body_angle:find_poses",
            "section-4-4-4": "body_cycle:sweep_stiffness",
            "section-4-4-5": "body_coordinated:compare_schemes",
            "section-4-4-6": "body_potential:cross_body",
            "section-5-2": "uneven_terrain:climb_uneven",
        },
    ),
    **SEEDED,
}
"""Chapter 4 of Bevly 1997: the whole robot in contact dynamics."""
OF_FRAMES: Final = _of(
    HOSHINO,
    {
        "table": "printed_numbers:compare_numbers",
        "fig-4": "frames:draw_figure_4",
        "fig-5": "frames:draw_figure_5",
    },
)
"""Sections 2 and 3 of Hoshino 1995: geometry of the two frames."""
OF_LEVELLING: Final = _of(
    HOSHINO,
    {
        "fig-7": "levelling:compare_inclinations",
        "fig-8": "levelling:walk_level",
        "fig-9": "levelling:compare_directions",
    },
)
"""Sections 4 and 5: the upper surface inclined by its legs, and kept level on a slope."""
OF_WALKING: Final = _of(
    HOSHINO,
    {
        "walk-directions": "walks:walk_everywhere",
        "turn-about-points": "walks:turn_anywhere",
        "passing-steps": "walks:pass_steps",
    },
)
"""Sections 3.2 and 7: walks in contact dynamics."""
OF_ARM_AND_BODY: Final = _of(
    HOSHINO,
    {
        "fig-10": "freedoms:compare_freedoms",
        "fig-11": "freedoms:vary_gain",
        "section-6-2": "freedoms:count_freedoms",
        "equation-19": "freedoms:check_second_term",
        "tool-experiment": "tool_runs:follow_in_dynamics",
    },
)
"""Section 6: the tool moved by arm and body."""
STUDIES: Final[dict[str, dict[str, Repeat]]] = {
    BEVLY: {**OF_PLANNING, **ON_ONE_LIMB, **ON_A_BODY},
    BOARDS_EXACT: _of(
        BOARDS_EXACT,
        {
            "optima": "proofs:prove_optima",
            "h-torque-front": "torques:trade_length_for_torque",
            "least-torque": "torques:find_least_torques",
            "no-rotation": "no_rotation:forbid_rotation",
            "hook-cost": "hook_cones:compare_hooks",
            "narrowest-cone": "hook_cones:narrow_cones",
            "peg-spacing": "peg_spacing:vary_spacing",
        },
    ),
    HOSHINO: {**OF_FRAMES, **OF_LEVELLING, **OF_WALKING, **OF_ARM_AND_BODY},
}
"""Paper or subject -> result -> what repeats it; the command line, the pages and the tests read it."""

TITLES: Final[dict[str, str]] = {
    BEVLY: "Bevly 1997: planning action modules for, and controlling, an experimental climbing robot",
    BOARDS_EXACT: "What exact search proves about the boards of Bevly 1997",
    HOSHINO: "Hoshino and others 1995: posture control of a six-legged robot that walks and manipulates",
}
"""Paper or subject -> what a reader is told of it."""


def study_titles() -> dict[str, str]:
    """Study -> its results."""
    return {paper: ", ".join(results) for paper, results in STUDIES.items()}
