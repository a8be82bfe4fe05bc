"""What `plan`, `polish`, `learn`, `inventory` and `check` print."""

from typing import Literal

from pydantic import Field

from .base import Count, Pose, Printed
from .meanings import means_as


@means_as("actions/planned.py:PlannedAction")
class Action(Printed):
    """What the robot is told to do in one step, every choice made."""

    kind: Literal["none", "move", "release", "grab"]
    limb: str | None
    hold: int | None
    """Number of the hold that a grab takes; null for other actions, and for a grab that found none."""
    delta: Pose | None
    code: int | None
    gene: str | None


class PlacedBody(Printed):
    """Where the body is, and on what."""

    x_m: float
    y_m: float
    theta_rad: float
    holds: dict[str, int]
    """Limb to the number of its hold, 0 if it is free; empty for robots without holds."""


class Furthest(Printed):
    """How far a search without success came, and what stopped it there."""

    actions: Count
    goals_met: Count
    goals: Count
    pose: PlacedBody
    stopped_by: dict[str, int]
    """Check to how many of the inventory's modules it forbids there."""


class LearnedModule(Printed):
    """A learned module that the search had."""

    name: str
    length: Count
    """Actions."""
    gain_m: float
    """Progress of the body in one go [m]."""
    starts: Count
    """Of the starts that it was tried from, in how many it worked."""


class Opening(Printed):
    """The smallest change of one kind that makes an infeasible task feasible."""

    key: str
    """What changes, such as "motor.torque_limit"."""
    before: float | str | None = Field(alias="from")
    """As it is, in `unit`."""
    after: float | str | None = Field(alias="to")
    """As it would have to be, in `unit`."""
    infeasible_at: float | str | None
    """The value one step before, at which the task is proved infeasible."""
    unit: str
    """Empty where the values are names."""
    overrides: list[str]
    """The change as texts for `--set`."""
    length: Count
    """Actions of the plan that it opens."""
    shortest: bool
    """Whether that plan is proved to be the shortest."""
    least: bool
    """Whether it is proved that no smaller change of this kind does."""
    text: str
    """The change in words."""


class Shut(Printed):
    """One kind of change that was not found to open the task."""

    key: str
    tried: str
    """How far it was changed."""
    proved: bool
    """Whether the task is proved infeasible even then."""


class OneHoldMore(Printed):
    """Where one hold more opens the task."""

    spacing_m: float
    """Of the lattice of places that were tried [m]."""
    places: Count
    """Places that a limb could ever grab from where the robot can get to."""
    tried: Count
    """Of those, how many were settled."""
    complete: bool
    """Whether all were."""
    openings: list[Opening]
    """The shortest plan first."""


class Openings(Printed):
    """Every single change that was tried on an infeasible task, and what came of it."""

    openings: list[Opening]
    shut: list[Shut]
    one_hold_more: OneHoldMore | None
    """Null where the robot has no holds, or the places were not settled."""
    searches: Count
    """Exact searches made."""
    seconds: float
    ended: str
    """Empty if all was tried; else why not: interrupted, time."""


class Polished(Printed):
    """A plan, or why there is none; `polish` prints it too, without `openings`."""

    status: Literal["optimal", "found", "infeasible", "bounded", "stopped"]
    """optimal: proved best by what was minimized; found: a plan; infeasible: proved that there is none; bounded: none has fewer than
    `lower_bound` actions; stopped: none yet, and nothing proved."""
    task: str
    reason: str
    """In a sentence."""
    actions: list[Action]
    """The plan; without success, the actions that lead furthest."""
    codes: list[int] | None
    """The same in the thesis's numbers; null where an action has none."""
    length: Count
    """Actions."""
    max_torque_Nm: float
    """Largest joint torque of the plan [N m]; 0 for robots without joint torques."""
    max_torque_oz_in: float
    evaluations: Count
    """Whole plans evaluated."""
    checks: Count
    """Single actions judged."""
    seconds: float
    """Wall-clock time."""
    seed: int
    planner: str
    lower_bound: int | None
    """Proved: no plan has fewer actions."""
    minimized: list[str]
    """What a proof is about: costs in lexicographic order."""
    costs: dict[str, float]
    """Length and every cost of the robot's family, in SI units; empty unless minimized."""
    gap: int | None
    """Actions that the plan may have too many, at most."""
    stances: int | None
    """Different stances that an exact search saw."""
    model: str
    """The rules that a proof holds for; empty without one."""
    first_length: int | None
    """Actions of the first plan found, before it was polished."""
    first_evaluations: int | None
    first_checks: int | None
    """Actions judged up to the first plan."""
    furthest: Furthest | None
    """Null where there is a plan."""
    macros: list[LearnedModule]


class Planned(Polished):
    """A plan, or why there is none."""

    openings: Openings | None
    """What would open the task; null where there is a plan, or nothing was proved or looked for."""


class NoStart(Printed):
    """The task's start stance is refused; exit code 2."""

    status: Literal["no start"]
    task: str
    reason: str
    openings: Openings
    """What would allow it."""


class Trade(Printed):
    """One plan of a front."""

    costs: dict[str, float]
    """Length and every cost of the robot's family, in SI units."""
    codes: list[int] | None
    actions: list[Action]


class Front(Printed):
    """`--pareto`: the plans that no other beats in both of two costs."""

    task: str
    costs: list[str]
    """The two."""
    status: Literal["optimal", "infeasible", "bounded"]
    """optimal: proved that there are no others."""
    trades: list[Trade]
    """From the least of the first cost to the least of the second."""
    reason: str
    stances: Count
    checks: Count
    seconds: float
    model: str


@means_as("planning/genetic/learning.py:Macro")
class Macro(Printed):
    """A learned module: several actions as one."""

    name: str
    codes: list[int]
    """Packed actions."""
    gain: float
    starts: Count
    tried: Count
    seen: Count
    from_start: Count


class Learned(Printed):
    """What `learn` found; the file of `-o` is the same."""

    file_schema: str = Field(alias="schema")
    task: str
    robot: str
    """Its name; another robot's macros are refused."""
    plans: Count
    """Looked at."""
    evaluations: Count
    macros: list[Macro]
    """Empty if nothing repeats; exit code 1."""


class Dropped(Printed):
    """Modules that a filter left out."""

    filter: str
    reason: str
    names: list[str]


class Inventory(Printed):
    """The modules that a plan can be made of."""

    modules: Count
    full_size: Count
    """Before the filters."""
    names: list[str]
    dropped: list[Dropped]
    length: Count
    """Actions of a plan, for the size of the search."""
    log10_before: float
    """Logarithm of how many plans of that length there are."""
    log10_after: float


@means_as("actions/step_verdict.py:StepVerdict")
class StepJudged(Printed):
    """One step of a plan and what the checks say of it."""

    step: int
    action: int | str
    """As the plan's file has it: the thesis's number where there is one, else in words."""
    ok: bool
    check: str | None
    reason: str | None
    hold: int | None
    nearest: int | None
    max_torque_oz_in: float | None
    """Largest joint torque."""
    power_W: float | None
    """Electrical power that holding the stance takes."""
    reported: list[str]
    margins: dict[str, float | None]
    """Check to its signed margin in SI units; null where nothing limits it."""


class Violation(Printed):
    """The first step that violates a hard check."""

    step: int
    action: int | str
    check: str | None
    margin: float | None
    """In SI units."""
    reason: str | None


class Ended(Printed):
    """Where the plan ends."""

    x_in: float
    y_in: float
    theta_deg: float
    holds: dict[str, int]


class NearestRule(Printed):
    """How many printed holds the rule "nearest" would have taken too."""

    agree: Count
    of: Count


class Verdict(Printed):
    """What came out when a plan was carried out again."""

    kind: Literal["plan"]
    ok: bool
    """Whether every action holds."""
    task: str
    planner: str
    length: Count
    """Actions of the plan."""
    steps: Count
    """Actions that hold, up to the first violation or all of them."""
    reached: bool
    """Whether the goal was reached on the way."""
    goals: Count
    goals_met: Count
    first_violation: Violation | None
    max_torque_oz_in: float
    max_torque_Nm: float
    max_power_W: float
    energy_J: float
    """Electrical energy of the actions that hold."""
    final: Ended
    hard: list[str]
    """Checks that forbid an action; the others report."""
    warnings: dict[str, list[int]]
    """Check that only reports to the steps that violate it."""
    nearest_rule: NearestRule | None
    notes: list[str]
    per_step: list[StepJudged]
