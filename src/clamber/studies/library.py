"""The studies by name: paper or subject, then result, to the function that repeats it."""

from collections.abc import Callable
from functools import partial
from typing import Final, TypeAlias

from .bevly_1997 import PAPER
from .bevly_1997.body_angle import find_poses
from .bevly_1997.body_circle import lead_body
from .bevly_1997.body_climb import climb_two_steps, show_gait
from .bevly_1997.body_coordinated import compare_schemes
from .bevly_1997.body_cycle import sweep_stiffness
from .bevly_1997.body_limit import limit_pulls
from .bevly_1997.body_potential import cross_body
from .bevly_1997.body_push import push_body
from .bevly_1997.body_push_up import push_body_up
from .bevly_1997.body_table import count_lost_pegs
from .bevly_1997.evolution import follow_h, follow_modified_ladder
from .bevly_1997.h_torques import compare_h_torques
from .bevly_1997.hook_check import check_hooks
from .bevly_1997.inventory_size import count_modules
from .bevly_1997.learned_module import learn_to_climb, plan_with_modules_alone
from .bevly_1997.limb_circle import track_circle
from .bevly_1997.limb_claims import compare_admittance, damp_directions
from .bevly_1997.limb_force import press_walls
from .bevly_1997.limb_models import compare_models
from .bevly_1997.limb_open_loop import compare_transforms
from .bevly_1997.limb_push import push_and_release
from .bevly_1997.limb_step import step_response
from .bevly_1997.no_rotation import rotation_is_needed, rotation_is_not_needed
from .bevly_1997.nominal_gait import climb_with_gait
from .bevly_1997.planner_success import count_successes
from .bevly_1997.printed_plans import PRINTED, repeat_plan
from .bevly_1997.push_pull import compare_push_pull
from .bevly_1997.search_variants import compare_crossovers, compare_subgoals
from .bevly_1997.static_torques import compare_torques
from .bevly_1997.step_size import vary_step_size
from .bevly_1997.uneven_terrain import climb_uneven
from .boards_exact import STUDY as BOARDS_EXACT
from .boards_exact.hook_cones import compare_hooks, narrow_cones
from .boards_exact.least_torque import find_least_torques
from .boards_exact.no_rotation import forbid_rotation
from .boards_exact.optima import prove_optima
from .boards_exact.peg_spacing import vary_spacing
from .boards_exact.torque_front import trade_length_for_torque
from .hoshino_1995 import PAPER as HOSHINO
from .hoshino_1995.ditches import draw_figure_5
from .hoshino_1995.equation_19 import check_second_term
from .hoshino_1995.fig_7 import compare_inclinations
from .hoshino_1995.fig_8 import walk_level
from .hoshino_1995.fig_9 import compare_directions
from .hoshino_1995.fig_10 import compare_freedoms
from .hoshino_1995.fig_11 import vary_gain
from .hoshino_1995.passing_steps import pass_steps
from .hoshino_1995.plane_walks import turn_anywhere, walk_everywhere
from .hoshino_1995.printed_numbers import compare_numbers
from .hoshino_1995.regions import draw_figure_4
from .hoshino_1995.section_6_2 import count_freedoms
from .hoshino_1995.tool_experiment import follow_in_dynamics
from .result import StudyResult

Repeat: TypeAlias = Callable[[], StudyResult]
ON_ONE_LIMB: Final[dict[str, Repeat]] = {
    "fig-3-9": compare_models,
    "fig-3-10": compare_transforms,
    "fig-3-11": partial(step_response, "fig-3-11", "ode"),
    "fig-3-12": partial(step_response, "fig-3-12", "mujoco"),
    "fig-3-13": track_circle,
    "fig-3-14": push_and_release,
    "fig-3-15": press_walls,
    "section-3-2-3": damp_directions,
    "section-3-3-2": compare_admittance,
}
"""Chapter 3 of Bevly 1997: laws in closed loop."""
SEEDED: Final = {"table-4-2": count_lost_pegs}
"""Results of seeds, as many as one asks for."""
ON_A_BODY: Final[dict[str, Repeat]] = {
    "fig-4-15": show_gait,
    "fig-4-16": climb_two_steps,
    "fig-4-17": lead_body,
    "fig-4-18": push_body_up,
    "fig-4-19": push_body,
    "section-4-4-2": limit_pulls,
    "section-4-4-3": find_poses,
    "section-4-4-4": sweep_stiffness,
    "section-4-4-5": compare_schemes,
    "section-4-4-6": cross_body,
    "section-5-2": climb_uneven,
    **SEEDED,
}
"""Chapter 4 of Bevly 1997: the whole robot in contact dynamics."""
OF_FRAMES: Final[dict[str, Repeat]] = {"table": compare_numbers, "fig-4": draw_figure_4, "fig-5": draw_figure_5}
"""Sections 2 and 3 of Hoshino 1995: geometry of the two frames."""
OF_LEVELLING: Final[dict[str, Repeat]] = {
    "fig-7": compare_inclinations,
    "fig-8": walk_level,
    "fig-9": compare_directions,
}
"""Sections 4 and 5: the upper surface inclined by its legs, and kept level on a slope."""
OF_WALKING: Final[dict[str, Repeat]] = {
    "walk-directions": walk_everywhere,
    "turn-about-points": turn_anywhere,
    "passing-steps": pass_steps,
}
"""Sections 3.2 and 7: walks in contact dynamics."""
OF_ARM_AND_BODY: Final[dict[str, Repeat]] = {
    "fig-10": compare_freedoms,
    "fig-11": vary_gain,
    "section-6-2": count_freedoms,
    "equation-19": check_second_term,
    "tool-experiment": follow_in_dynamics,
}
"""Section 6: the tool moved by arm and body."""
STUDIES: Final[dict[str, dict[str, Repeat]]] = {
    PAPER: {
        "inventory-size": count_modules,
        **{result: partial(repeat_plan, result) for result in PRINTED},
        "hook-check": check_hooks,
        "nominal-gait": climb_with_gait,
        "no-rotation": rotation_is_needed,
        "no-rotation-free": rotation_is_not_needed,
        "step-size": vary_step_size,
        "h-torques": compare_h_torques,
        "modified-ladder-evolution": follow_modified_ladder,
        "h-evolution": follow_h,
        "planner-success": count_successes,
        "tail-crossover": compare_crossovers,
        "sub-goals": compare_subgoals,
        "learned-module": learn_to_climb,
        "modules-alone": plan_with_modules_alone,
        "push-pull": compare_push_pull,
        "static-torques": compare_torques,
        **ON_ONE_LIMB,
        **ON_A_BODY,
    },
    BOARDS_EXACT: {
        "optima": prove_optima,
        "h-torque-front": trade_length_for_torque,
        "least-torque": find_least_torques,
        "no-rotation": forbid_rotation,
        "hook-cost": compare_hooks,
        "narrowest-cone": narrow_cones,
        "peg-spacing": vary_spacing,
    },
    HOSHINO: {**OF_FRAMES, **OF_LEVELLING, **OF_WALKING, **OF_ARM_AND_BODY},
}
"""Paper or subject -> result -> what repeats it; the command line, the pages and the tests read it."""

TITLES: Final[dict[str, str]] = {
    PAPER: "Bevly 1997: planning action modules for, and controlling, an experimental climbing robot",
    BOARDS_EXACT: "What exact search proves about the boards of Bevly 1997",
    HOSHINO: "Hoshino and others 1995: posture control of a six-legged robot that walks and manipulates",
}
"""Paper or subject -> what a reader is told of it."""
