"""Figures 4.15 and 4.16: the gait as it is carried out, and x and y of the body over two rungs of the ladder, by two controls."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Final

import numpy as np

from ...families.climber.execution.body_gains import BodyGains
from ...families.climber.execution.executable_plan import climbable
from ...families.climber.pictures.pictures import draw_body_over_time, draw_stages
from ...families.climber.planning.plans import thesis_code
from ...families.climber.planning.task import LimbedTask
from ...families.climber.trials.body_bench import SLOT
from ...families.climber.trials.body_stand import bench_flaws
from ...families.climber.trials.run_plan import ClimbRun, run_plan
from ...planning.problem.plan import Plan
from ...types import Floats
from ...units import INCH
from ..result import Cells, Compared, Figure, StudyResult, Table, Value, Verdict
from . import MILLI
from .body_entries import OURS, OWN, PLANT, TABLE_4_1
from .limb_entries import SCCT
from .nominal_gait import GAIT
from .printed_plans import limbed_task

RUNGS: Final = 2
PRINTED: Final = f"{SCCT}, Table 4.1, limit of 4.4.2"
IDEAL: Final = f"{PRINTED}, ideal plant"
CASES: Final = {PRINTED: (TABLE_4_1, "nominal"), IDEAL: (TABLE_4_1, "ideal"), OWN: (OURS, "nominal")}
"""Label -> gains and plant. The verdicts are of the first, the thesis's; the others stand beside it."""
NEARBY: Final = tuple(1.0 + k * 1e-6 for k in range(8))
"""Factors on the backlash of climbs that stand for one: whether a hook is home at its first or its second try hangs on as little."""
SUFFIXES: Final = {PRINTED: "", IDEAL: "-ideal", OWN: "-own"}
"""Label -> what its pictures' names end with."""
FOLLOWS: Final = 0.5
"""A released tip follows the body if it moves relative to the body by less than this part of what the body moves [-]."""
ON_PATH: Final = 1.5 * INCH
"""Half of a module 003: a body farther off its path is nearer to another step of the plan than to its own [m]."""
SEEN: Final = 0.003
"""An error that a figure of two rungs shows: a hundredth of their height [m]."""


@dataclass(frozen=True, slots=True)
class GaitFacts:
    """What figures 4.15 and 4.16 are judged by."""

    climbed: bool
    """Whether every action was carried out."""
    reason: str
    """Why not."""
    elbows: tuple[tuple[int, int], ...]
    """Of every hold of leg 3 in order: on which side of the body it was (1: +x), and the sign of the elbow angle there."""
    followed: float | None
    """By how much leg 3, released, moved relative to the body, over how far the body moved; None: it never came to that [-]."""
    unhooked: float
    """Most that the tip of a limb that carried was from its peg [m]."""
    off_path: float
    """Most that the body was from where it was aimed [m]."""
    sways: Mapping[str, tuple[float, float]]
    """Title of an action during which the body is to hold still -> how far x and y moved to and fro [m]."""

    @property
    def switches(self) -> bool:
        """Whether leg 3 changed sides, and its elbow with every change."""
        changes = [
            (before[1], after[1])
            for before, after in zip(self.elbows, self.elbows[1:], strict=False)
            if before[0] != after[0]
        ]
        return bool(changes) and all(before != after for before, after in changes)

    @property
    def errors(self) -> float:
        """Largest error at a "body hold" [m]."""
        return max((max(sway) for sway in self.sways.values()), default=0.0)


def judge_gait(facts: GaitFacts) -> Verdict:
    """Figure 4.15: holds if the gait is climbed, every change of side switches the elbow, and the released leg follows the body."""
    if not facts.climbed:
        return "differs"
    follows = facts.followed is not None and facts.followed < FOLLOWS
    return "holds" if facts.switches and follows else "open"


def judge_steps(facts: GaitFacts) -> Verdict:
    """Figure 4.16: holds if two rungs are climbed on their path, hooks on their pegs, with errors that are seen at the body holds."""
    if not facts.climbed or facts.unhooked > SLOT:
        return "differs"
    return "holds" if facts.off_path <= ON_PATH and facts.errors >= SEEN else "open"


def gait_plan(task: LimbedTask, rungs: int) -> Plan:
    """The gait with the pegs of each rung: leg 3 to the lower right where leg 1 climbs, to the lower left where leg 2 does.

    Args:
        task: The ladder, under the rules that can be carried out.
        rungs: How many, each two steps of the body.
    """
    numbers: list[int] = []
    for k in range(rungs):
        low = 2 * k
        start = () if k == 0 else (300 + low + 2,)
        numbers += [*start, 100 + low + 6, 300 + low + 1, 200 + low + 5, 300, 3, 3]
    return Plan.of_codes(task, [thesis_code(task, number) for number in numbers], planner="by hand")


@cache
def climbed(rungs: int, gains: BodyGains = OURS, plant: str = "nominal", play: float = 1.0) -> ClimbRun:
    """That gait, carried out on a plant, "nominal" or "ideal", its backlash times `play`."""
    strict = climbable(limbed_task("ladder"))
    flaws = bench_flaws(plant)
    flaws = replace(flaws, backlash=play * flaws.backlash)
    return run_plan(strict, gait_plan(strict, rungs), flaws, gains=gains)


def facts_of(run: ClimbRun) -> GaitFacts:
    """What a climb of the gait came to, by the simulation's own state; pegs are where the map says."""
    trace, leg = run.trace, len(run.trace.limbs) - 1
    assert trace.true_pose is not None
    tips = _tips(run)
    pegs = {hold.number: np.array((hold.x, hold.y)) for hold in run.task.world.holds}
    unhooked = 0.0
    for number, peg in pegs.items():
        borne = (trace.holds == number) & (trace.carries > 0)
        if borne.any():
            unhooked = max(unhooked, float(np.linalg.norm(tips[borne] - peg, axis=1).max()))
    off = np.linalg.norm((trace.true_pose - trace.aim)[trace.step > 0, :2], axis=1)
    held = [action for action in run.report.actions if action.kind != "move"]
    return GaitFacts(
        climbed=run.report.done,
        reason=run.report.reason,
        elbows=_elbows(run, leg, pegs),
        followed=_followed(run, leg, tips),
        unhooked=unhooked,
        off_path=float(off.max()) if off.size else 0.0,
        sways={f"{a.first}-{a.last} {a.title}": _sway(run, a.start, a.start + a.seconds) for a in held},
    )


def _tips(run: ClimbRun) -> Floats:
    """Of all limbs, world frame, shape (rows, limbs, 2) [m]."""
    trace = run.trace
    assert trace.true_pose is not None and trace.true_angles is not None
    x, y, angle = trace.true_pose.T
    chains = [limb.chain(trace.true_angles[:, i])[-1] for i, limb in enumerate(run.task.robot.limbs)]
    body = x + 1j * y
    turn = np.exp(1j * angle)
    tips = body + turn * np.array(chains)
    return np.stack([tips.T.real, tips.T.imag], axis=-1)


def _elbows(run: ClimbRun, leg: int, pegs: Mapping[int, Floats]) -> tuple[tuple[int, int], ...]:
    """Side of the body and sign of the elbow angle of every hold of a limb, in order."""
    trace = run.trace
    assert trace.true_pose is not None
    numbers = trace.holds[:, leg]
    begins = np.flatnonzero(np.diff(numbers, prepend=0) != 0)
    found = []
    for k in begins:
        if not numbers[k]:
            continue
        side = 1 if pegs[int(numbers[k])][0] > trace.true_pose[k, 0] else -1
        found.append((side, 1 if trace.angles[k, leg, 1] > 0.0 else -1))
    return tuple(found)


def _followed(run: ClimbRun, leg: int, tips: Floats) -> float | None:
    """How far a free limb's tip moves relative to the body while that moves, over how far that moves; of the worst move [-]."""
    trace = run.trace
    assert trace.true_pose is not None
    parts = []
    for action in run.report.actions:
        rows = np.flatnonzero(trace.step == action.first)
        if action.kind != "move" or not rows.size or trace.holds[rows, leg].any():
            continue
        body = trace.true_pose[rows[-1], :2] - trace.true_pose[rows[0], :2]
        tip = tips[rows[-1], leg] - tips[rows[0], leg]
        parts.append(float(np.linalg.norm(tip - body)) / max(float(np.linalg.norm(body)), 1e-9))
    return max(parts, default=None)


def _sway(run: ClimbRun, start: float, end: float) -> tuple[float, float]:
    """How far the body moves to and fro less its aim between two times [m]."""
    trace = run.trace
    assert trace.true_pose is not None
    off = (trace.true_pose - trace.aim)[(trace.time >= start) & (trace.time <= end)]
    return float(np.ptp(off[:, 0])), float(np.ptp(off[:, 1]))


def _facts() -> dict[str, tuple[ClimbRun, GaitFacts]]:
    runs = {label: climbed(RUNGS, gains, plant) for label, (gains, plant) in CASES.items()}
    return {label: (run, facts_of(run)) for label, run in runs.items()}


def _compared(
    found: Mapping[str, tuple[ClimbRun, GaitFacts]],
    numbers: Callable[[ClimbRun, GaitFacts], Mapping[str, Value]],
    printed: Mapping[str, Value] | None = None,
) -> tuple[Compared, ...]:
    """Rows of all controls: numbers of our own are the largest of its climbs `NEARBY`, words all that come up in them."""
    rows = []
    for label, (run, facts) in found.items():
        columns = [numbers(run, facts)]
        if label == OWN:
            more = [climbed(RUNGS, OURS, "nominal", play) for play in NEARBY[1:]]
            columns += [numbers(one, facts_of(one)) for one in more]
        for name in columns[0]:
            ours = _largest([column[name] for column in columns])
            rows.append(Compared(f"{label}: {name}", ours, (printed or {}).get(name)))
    return tuple(rows)


def _largest(values: Sequence[Value]) -> Value:
    found = [value for value in values if value is not None and not isinstance(value, str)]
    return max(found) if len(found) == len(values) else " or ".join(dict.fromkeys(map(str, values)))


BESIDE: Final = (
    f'The verdict is of "{PRINTED}": SCCT with the thesis\'s map T, the gains of Table 4.1 and the limit of 4.4.2 with alpha 0. '
    f'"{OWN}" is what this robot climbs with otherwise, its map, limit and gains ours; it stands beside and decides nothing. Free '
    "legs, the sequence of a grab and which side an elbow takes are ours in both.",
    "2 deg of backlash, 400 counts, pegs where the map says; 0.95 of the weight is fed forward. The same control without backlash and "
    "with exact encoders stands beside, too; it was added once the verdict was known, and decides nothing. A robot whose body stays "
    "off its aim by 50 mm and more gives up, hooks on or not.",
    f'Whether a hook is home at its first or its second try hangs on the last bits of a processor\'s arithmetic. So numbers of "{OWN}" are '
    f"the largest of {len(NEARBY)} climbs, each with one millionth more of the backlash than the one before; actions and pictures are the "
    "first's.",
)


def show_gait() -> StudyResult:
    """Two rungs, action by action."""
    found = _facts()
    facts = found[PRINTED][1]
    rows: list[Cells] = [
        (label, f"{a.first}-{a.last}", a.kind, a.title, a.outcome, a.start, a.seconds)
        for label, (run, _) in found.items()
        for a in run.report.actions
    ]
    return StudyResult(
        claim="Figure 4.15, section 4.5: LIBRA climbs by the gait 191, 392, 291, 300, 3 of the action module planner; leg 3 switches "
        "its elbow as it changes sides, and follows the body once it has let go.",
        verdict=judge_gait(facts),
        compared=(
            Compared("modules of the gait", " ".join(map(str, GAIT)), " ".join(map(str, GAIT))),
            *_compared(found, _gait_numbers),
        ),
        deviations=(
            *PLANT,
            *BESIDE,
            "Modules 191, 392, 291 name pegs by where they are; ours are grabbed in the order right, bottom to the left, left, bottom "
            "off, body up, with leg 3 on the lower right before leg 1 moves, for a swing needs two other legs on pegs (the planner's "
            "model lets leg 3 hang in the air then, see `nominal-gait`). One module 003 is 3 in, so there are two a rung.",
            "Which side an elbow takes is chosen for a whole stay by what hooks and motors can then bear, with few changes; the thesis "
            "switches leg 3's with its side, so that its hook is on top. The verdict is holds if every action of two rungs is carried "
            "out, leg 3 switches its elbow with every change of side, and its tip, once it has let go, moves relative to the body by "
            f"less than {FOLLOWS:g} of what the body moves; open if the gait is climbed without one of the latter; differs if it is "
            "not climbed.",
        ),
        table=Table(("control", "actions", "kind", "what", "outcome", "start [s]", "time [s]"), tuple(rows)),
        figures=_pictures(found, "stages", "the robot at the end of each action, from the simulation's own state."),
    )


def _gait_numbers(run: ClimbRun, facts: GaitFacts) -> dict[str, Value]:
    actions = run.report.actions
    return {
        "verdict by the rule": judge_gait(facts),
        "modules carried out": sum(1 + action.last - action.first for action in actions if action.outcome == "ok"),
        "modules in the plan": len(run.plan.actions),
        "ended by": facts.reason or "the end of the plan",
        "time of an action, mean [s]": sum(action.seconds for action in actions) / max(len(actions), 1),
        "sides of leg 3's holds": " ".join(f"{side:+d}" for side, _ in facts.elbows),
        "leg 3's elbow there": " ".join(f"{elbow:+d}" for _, elbow in facts.elbows),
        "leg 3 moves relative to the body, over what that moves [-]": facts.followed,
    }


def _pictures(found: Mapping[str, tuple[ClimbRun, GaitFacts]], name: str, caption: str) -> tuple[Figure, ...]:
    """One of every control's climb: "stages" or "times"."""
    draw = draw_stages if name == "stages" else draw_body_over_time
    return tuple(
        Figure(f"{name}{SUFFIXES[label]}", f"{label}: {caption}", partial(draw, run))
        for label, (run, _) in found.items()
    )


def climb_two_steps() -> StudyResult:
    """Body x and y over time, with the actions' numbers."""
    found = _facts()
    facts = found[PRINTED][1]
    rows: list[Cells] = [
        (label, title, *(round(value * MILLI, 2) for value in sway))
        for label, (_, one) in found.items()
        for title, sway in one.sways.items()
    ]
    return StudyResult(
        claim="Figure 4.16, section 4.5: over two steps of the ladder the body follows its path; where it is to hold still there are "
        "errors as legs pull away from pegs and grab new ones, for the body is compliant so that hooks never leave the pegs.",
        verdict=judge_steps(facts),
        compared=_compared(found, _step_numbers, {"rise of the body [in]": RUNGS * 6}),
        deviations=(
            *PLANT,
            *BESIDE,
            "The figure's curves are not printed as numbers, so what is compared is what the text says of them; the printed rise is "
            "that of the aim. Two steps are read as two rungs of 6 in, each two modules 003.",
            f"The verdict is holds if both rungs are climbed, no carrying hook is ever more than {SLOT * MILLI:g} mm from its peg, the "
            f"body is never more than {ON_PATH * MILLI:.0f} mm, half of a module 003, from where it is aimed (beyond that it is nearer "
            f"to another step of the plan), and at some body hold it moves by {SEEN * MILLI:g} mm or more, a hundredth of the "
            "figure's height, so that errors can be seen; open if it is climbed with every hook on but a body farther off, or without "
            "errors; differs if it is not climbed or a hook comes off.",
        ),
        table=Table(("control", "actions", "x moves [mm]", "y moves [mm]"), tuple(rows)),
        figures=_pictures(
            found, "times", "body x and y, as they are and as aimed at; numbers are those of the actions."
        ),
    )


def _step_numbers(run: ClimbRun, facts: GaitFacts) -> dict[str, Value]:
    trace = run.trace
    assert trace.true_pose is not None
    off = np.abs((trace.true_pose - trace.aim)[trace.step > 0]) * MILLI
    last = run.report.actions[-1]
    numbers: dict[str, Value] = {
        "verdict by the rule": judge_steps(facts),
        "rise of the body [in]": float(trace.true_pose[-1, 1] - trace.true_pose[0, 1]) / INCH,
        "ended by": facts.reason or "the end of the plan",
        "time [s]": last.start + last.seconds,
        "body off its path, largest [mm]": facts.off_path * MILLI,
        "a carrying hook off its peg, largest [mm]": facts.unhooked * MILLI,
    }
    for which, axis in enumerate("xy"):
        numbers[f"{axis} off its aim, RMS [mm]"] = float(np.sqrt(np.mean(off[:, which] ** 2)))
        numbers[f"{axis} off its aim, largest [mm]"] = float(off[:, which].max())
        most = max((sway[which] for sway in facts.sways.values()), default=0.0)
        numbers[f"body holding still: {axis} moves by at most [mm]"] = most * MILLI
    return numbers
