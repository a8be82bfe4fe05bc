"""How fast stances in space are judged and laws of a whole body work, beside the field's programs on the same stances and moments."""

import time
from collections.abc import Sequence
from functools import partial
from statistics import median
from typing import Any, Final

import numpy as np

from ....control.whole_body.law import BodyLaw, WholeBody
from ....errors import how_to_install
from ....trials.measured import NOTHING, Row, Say, keep_quiet, round_times
from ..control.laws import BODY_LAWS, USUAL
from ..statics.checks import STANCE_CHECK
from ..statics.judging import rules_record
from .law_rivals import RIVALS, Rival, installed
from .law_trials import Moment, first_steps, law_at, spatial_task, time_loop, try_law
from .stance_rivals import Stances, Verdict, connect, highs, hpp, jet_leg, jet_stances, programme, shipped_stances

RATES: Final = {"gripper-climber": ">= 60 000", "hexapod": ">= 30 000", "clamp-triped": ">= 25 000"}
"""Robot -> checks a second that the project aims at, on a core."""
STANCES: Final = 11_500
"""Whose verdicts are compared with those of HiGHS, of all robots together; a tenth of them is out of reach and not counted."""
TIMED: Final = 2000
"""Stances of ours in one timing."""
RIVAL_STANCES: Final = 100
"""Of a rival in one timing."""
ROUNDS: Final = 7
NEAR: Final = 1e-7
"""A share of reserve this near to none may fall either way."""
STEPS: Final = 20
"""Stances that OMPL moves the body from."""
GOAL: Final = np.array((0.03, 0.0, 0.01, 0.05))
"""By how much: forward, aside, up [m], turn [rad]."""
SECONDS: Final = 5.0
EXTRA: Final = f"not installed: {how_to_install('rivals')}"
LAW_TASKS: Final = ("wall-gripper", "stones-quadruped", "corners-magnet", "rubble-hexapod")
"""Whose first steps every law of a whole body is tried on."""


def _judge(stances: Stances, n: int, rules: Any) -> None:
    stances.statics.judge(stances.bodies[:n], stances.contacts[:n], rules)


def _ask(verdict: Verdict, n: int) -> None:
    for i in range(n):
        verdict(i)


def _solve(programmes: list[Any]) -> None:
    for each in programmes:
        highs(*each)


def rate_rows(*, stances: int = TIMED, rounds: int = ROUNDS, say: Say = keep_quiet) -> list[Row]:
    """Full checks a second of a core, every margin to its end, and those that only decide."""
    rows = []
    for robot, aim in RATES.items():
        say(f"stances of {robot}")
        made = shipped_stances(robot, stances)
        works = [partial(_judge, made, stances, rules_record(exact=exact)) for exact in (1, 0)]
        exact, decided = stances / np.median(round_times(works, rounds), axis=0)
        rows.append(Row(f"{robot}: stance checks, every margin, one core", exact, "checks/s", aim))
        rows.append(Row(f"{robot}: stance checks, verdict only, one core", decided, "checks/s"))
    return rows


def highs_rows(*, stances: int = STANCES, rounds: int = ROUNDS, say: Say = keep_quiet) -> list[Row]:
    """Verdicts and time of HiGHS for the same programmes, made anew in numpy."""
    robots = (*RATES, "quadruped", "magnet-quadruped")
    each, wrong, asked, worst, ratios = stances // len(robots), 0, 0, 0.0, []
    for robot in robots:
        say(f"HiGHS on {each} stances of {robot}")
        made = shipped_stances(robot, each, seed=2)
        rng = np.random.default_rng(3)
        weight = 9.81 * made.chains.total_mass
        made.contacts["strength"] = rng.uniform(0.02, 0.4, made.contacts.shape) * weight
        made.contacts["friction"] = rng.uniform(0.2, 1.0, made.contacts.shape)
        made.bodies["gravity"] = rng.normal(size=(each, 3)) * 4.0 + (0.0, 0.0, -6.0)
        judged, _ = made.statics.judge(made.bodies, made.contacts)
        _, reasons = made.statics.judge(
            made.bodies, made.contacts, rules_record(exact=0, hard=1 << STANCE_CHECK["equilibrium"])
        )
        programmes = []
        for i in np.flatnonzero(judged["judged"]):
            posed = programme(made, int(i), judged[i])
            programmes.append(posed)
            best = highs(*posed)
            if best > -0.9:
                worst = max(worst, abs(best - float(judged["s"][i])))
            asked += 1
            wrong += abs(best) > NEAR and bool(best > 0.0) != bool(reasons[i] < 0)
        few = programmes[:RIVAL_STANCES]
        works = [partial(_solve, few), partial(_judge, made, each, rules_record())]
        theirs, ours = np.median(round_times(works, rounds), axis=0)
        ratios.append(theirs / len(few) / (ours / each))
    return [
        Row("stances whose verdict was compared with that of HiGHS", asked, "stances"),
        Row("of these with another verdict", wrong, "stances", "0"),
        Row("largest difference of the shares in reserve from those of HiGHS", worst, "1", "< 1e-6"),
        Row("HiGHS through SciPy, programme given, over our whole check, median of robots", median(ratios), "ratio"),
    ]


def peer_rows(*, stances: int = RIVAL_STANCES, rounds: int = ROUNDS, say: Say = keep_quiet) -> list[Row]:
    """jet-leg and hpp-centroidal-dynamics on the same stances of HyQ."""
    many = 20 * stances
    made = jet_stances(many)
    hard = 1 << STANCE_CHECK["reach"] | 1 << STANCE_CHECK["equilibrium"]
    rules = rules_record(exact=0, hard=hard)
    rows = [Row("HyQ: stance checks, verdict only, one core", NOTHING, "checks/s")]
    _, reasons = made.statics.judge(made.bodies, made.contacts, rules)
    for name, module, make, aim in (
        ("jet-leg, torques and friction", "jet_leg", jet_leg, ">= 200"),
        ("hpp-centroidal-dynamics, friction alone", "hpp_centroidal_dynamics", hpp, None),
    ):
        if not installed(module):
            rows.append(Row(f"{name} ({EXTRA})", NOTHING, "ratio", aim))
            continue
        say(f"{name} on the same stances")
        verdict = make(made)
        ours, theirs = round_times(
            [partial(_judge, made, many, rules), partial(_ask, verdict, stances)], rounds
        ).T / np.array([[many], [stances]])
        rows[0] = Row(rows[0].name, 1.0 / median(ours), "checks/s")
        rows.append(Row(f"{name}: checks", 1.0 / median(theirs), "checks/s"))
        rows.append(Row(f"{name}: time of a check over ours", median(theirs / ours), "ratio", aim))
        if module == "jet_leg":
            same = sum(verdict(i) == bool(reasons[i] < 0) for i in range(stances))
            rows.append(Row(f"{name}: verdicts that are ours, of {stances}", same, "stances"))
    return rows


def step_rows(*, steps: int = STEPS, say: Say = keep_quiet) -> list[Row]:
    """A body moved over its holds: OMPL's RRT-connect with our check as its validity, over that check of the lattice's one stance."""
    name = "OMPL: RRT-connect of one body move, our check as validity"
    if not installed("ompl"):
        return [Row(f"{name} ({EXTRA})", NOTHING, "ms")]
    say("OMPL's RRT-connect, a body move at a time")
    made = shipped_stances("gripper-climber", 20 * steps, seed=4)
    rules = rules_record(exact=0)
    _, reasons = made.statics.judge(made.bodies, made.contacts, rules)
    times, asked, came = [], [], 0
    for i in np.flatnonzero(reasons < 0)[:steps]:
        began = time.thread_time()
        there, states = connect(made, int(i), GOAL, SECONDS)
        times.append(time.thread_time() - began)
        asked.append(states)
        came += there
    ours = float(np.median(round_times([partial(_judge, made, len(made), rules)], ROUNDS))) / len(made)
    return [
        Row(f"{name}, {came} of {len(times)} arrived", 1e3 * median(times), "ms"),
        Row("OMPL: states judged on the way", median(asked), "states"),
        Row("OMPL: time of a body move over one check of ours", median(times) / ours, "ratio"),
    ]


def space_rows(*, say: Say = keep_quiet) -> list[Row]:
    """All of it."""
    return [*rate_rows(say=say), *highs_rows(say=say), *peer_rows(say=say), *step_rows(say=say)]


def _tick_all(laws: Sequence[BodyLaw]) -> None:
    for law in laws:
        law.look()
        law.tick()


def _tick_rivals(bodies: Sequence[Rival]) -> None:
    for body in bodies:
        body.tick()


def law_rows(*, tasks: Sequence[str] = LAW_TASKS, rounds: int = 15, say: Say = keep_quiet) -> list[Row]:
    """Stand, a move of the body, a regrab and another move by each law; errors as they truly were, ticks on moments of the first run."""
    rows: list[Row] = []
    for name in tasks:
        task = spatial_task(name)
        plan = first_steps(task)
        moments: list[Moment] = []
        for law in BODY_LAWS:
            say(f"{name}: first steps by {law}")
            trial, seen = try_law(task, plan, law)
            moments = seen if law == USUAL else moments
            said = f"{name}, {law}"
            rows += [
                Row(f"{said}: motions carried out ({trial.reason or 'done'})", trial.motions, "motions"),
                Row(f"{said}: body off its aim, at most", 1e3 * trial.body, "mm"),
                Row(f"{said}: swinging tip off its path, at most", 1e3 * trial.tip, "mm"),
                Row(f"{said}: tip that holds slid, at most", 1e3 * trial.slid, "mm"),
                Row(f"{said}: largest share of a torque", 100.0 * trial.torque, "%"),
                Row(f"{said}: contacts that came off", trial.off, "contacts"),
            ]
        say(f"{name}: ticks")
        rows += [Row(f"{name}: {what}", *rest) for what, rest in time_loop(task, plan).items()]
        kinds = {law: [law_at(task, moment, law) for moment in moments] for law in BODY_LAWS}
        works = {law: partial(_tick_all, laws) for law, laws in kinds.items()}
        missing = []
        for rival, make in RIVALS.items():
            if installed(rival):
                works[rival] = partial(_tick_rivals, [make(law) for law in kinds[USUAL]])
            else:
                missing.append(f"{rival} (not installed: {how_to_install(rival)})")
        times = np.median(round_times(tuple(works.values()), rounds), axis=0) / len(moments)
        rows += [Row(f"{name}, {law}: tick", 1e6 * seconds, "us") for law, seconds in zip(works, times, strict=True)]
        bound = [law.told for law in kinds[USUAL] if isinstance(law, WholeBody) and law.told]
        rows.append(Row(f"{name}, {USUAL}: moments at which a limit binds", len(bound) / len(moments), "share"))
        if bound:
            solving = np.median([each["setup_time"] + each["solve_time"] for each in bound])
            rows.append(Row(f"{name}, {USUAL}: DAQP's of a tick then", 1e6 * float(solving), "us"))
        rows += [Row(f"{name}, {rival}", NOTHING, "us") for rival in missing]
    return rows
