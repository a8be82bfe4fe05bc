"""Many climbs from their seeds: the same wherever they run, stored as they end, killed at any moment and gone on with."""

import json
import os
import signal
import sqlite3
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np
import pytest
from climbs_by_hand import setup_of

import clamber
from clamber.errors import SpecError
from clamber.families.climber.execution.climb_trace import TracedClimber
from clamber.families.climber.execution.executable_plan import PlanRefusedError
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.trials import run_plan as runs
from clamber.families.climber.trials import trial as one
from clamber.families.climber.trials.noise import NOISE, Noise
from clamber.families.climber.trials.trial import climb_once, error_trial, plans_on_the_way, trial_of, with_plan
from clamber.jobs import LocalProcesses, StoreError
from clamber.planning.problem.plan import Plan
from clamber.trials.dynamics import NoPlanError
from clamber.trials.noise import NoiseError
from clamber.trials.trial_runs import run_trials, stored_result
from clamber.types import Json

LETS_GO = (300, 3)
"""The bottom limb releases, and the body goes up: two seconds of climb."""


@pytest.mark.slow
def test_a_trial_is_the_same_from_a_worker_and_climbed_again(tmp_path: Path) -> None:
    setup, store = setup_of(*LETS_GO), tmp_path / "trials.db"
    trials = run_trials(setup, [3, 11], executor=LocalProcesses(1), store=store)
    assert [trial.seed for trial in trials.ended] == [3, 11]
    for told in trials.ended:
        known = stored_result(setup, told.seed, store)
        assert known is not None and plans_on_the_way(known) == []
        run, again = setup.again(told.seed, known, lambda words, share: None)
        assert again == told == setup.trial(known)
        other, _, _ = climb_once(setup, told.seed)
        for name in ("time", "believed", "torques", "true_pose"):
            np.testing.assert_array_equal(getattr(run.trace, name), getattr(other.trace, name), err_msg=name)
    assert stored_result(setup, 4, store) is None
    assert trials.ended[0].drawn != trials.ended[1].drawn
    assert trials.ended[0].seconds > 0.0


def test_a_stored_trial_tells_what_its_seed_drew_and_nothing_of_other_seeds() -> None:
    noise = Noise.of("none", ["payload=10%"])
    _, trial, _ = climb_once(setup_of(300, noise=noise), 1)
    _, other, _ = climb_once(setup_of(300, noise=Noise.of("usual")), 1)
    assert trial.drawn["payload"] == other.drawn["payload"] != 0.0
    assert not any(value for key, value in trial.drawn.items() if key != "payload")


def test_a_fall_is_told_with_action_and_reason() -> None:
    setup = setup_of(300, *([4] * 8), force=True)
    _, trial, _ = climb_once(setup, 0)
    assert not trial.done
    assert (trial.outcome, trial.kind) == ("fell", "move")
    assert trial.reason.startswith("fell: ")
    assert trial.step == 2


def test_a_body_that_its_limbs_hold_back_goes_back_and_the_move_is_told_as_stalled() -> None:
    """Eight inches up with both hooks on: farther than the limbs reach."""
    _, trial, _ = climb_once(setup_of(300, *([3] * 8), force=True), 0)
    assert not trial.done
    assert (trial.outcome, trial.kind, trial.stalled) == ("short", "move", 1)
    assert trial.reason.startswith("short: 1 of its moves did not arrive, and the body ends ")


def test_plans_made_on_the_way_are_kept_and_taken_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """A hold out of reach is missed; the plan that takes the place of the first is made once, not again when the trial is."""
    asked: list[int] = []
    plain = runs.believing_climber

    def blind(*words: Any) -> TracedClimber:
        climber = plain(*words)
        climber.holds[6] = np.array((3.0, 3.0))  # the robot believes it there
        return climber

    def another(*_: Any, **__: Any) -> Any:
        def replan(task: Any) -> Plan:
            asked.append(1)
            return Plan.of_codes(task, [thesis_code(task, 104)])

        return replan

    monkeypatch.setattr(one, "replanner", another)
    monkeypatch.setattr(runs, "believing_climber", blind)
    setup = setup_of(106)
    _, first, plans = climb_once(setup, 0)
    assert (first.done, first.replans, len(asked)) == (True, 1, 1)
    assert (first.step, first.kind, first.limb) == (1, "grab", "right")
    _, again, same = climb_once(setup, 0, plans=json.loads(json.dumps(plans)))
    assert again == first
    assert same == plans
    assert len(asked) == 1


FAULT: Final = {"kind": "stuck", "where": "body", "start": 1.0, "noticed": None, "at": "", "ending": "fell"}


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"drawn": {"friction": "much"}}, "drawn.friction = 'much': must be"),
        ({"drawn": {"friction": 0.1}}, r"drawn\.\w+: must be given"),
        ({"fault": {"kind": "stuck"}}, "where: must be given"),
        ({"fault": FAULT | {"noticed": "soon"}}, "noticed = 'soon': must be"),
        ({"fault": FAULT | {"kind": []}}, "kind = .*: must be"),
    ],
)
def test_a_damaged_trial_of_a_store_is_refused_by_field(changed: Json, told: str) -> None:
    whole = error_trial(3, "raised").to_json() | {"drawn": dict.fromkeys(NOISE, 0.0), "fault": FAULT}
    assert trial_of(whole, Path("trials.db")).fault == FAULT
    with pytest.raises(SpecError, match=rf"^trials\.db: a stored result: {told}"):
        trial_of(whole | changed, Path("trials.db"))


@pytest.mark.usefixtures("in_this_process")
def test_the_plan_is_made_once_and_kept_in_the_store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    setup, store = setup_of(300), tmp_path / "trials.db"
    asked: list[int] = []

    def plan_to_climb(*_: Any, **__: Any) -> Plan | None:
        asked.append(1)
        return setup.plan

    monkeypatch.setattr(one, "plan_to_climb", plan_to_climb)
    unplanned = replace(setup, plan=None)
    ready = with_plan(unplanned, store)
    run_trials(ready, [0], executor=LocalProcesses(1), store=store)
    later = with_plan(unplanned, store)
    assert len(asked) == 1
    assert later.plan == ready.plan == setup.plan
    more = run_trials(later, [0, 1], executor=LocalProcesses(1), store=store, resume=True)
    assert [trial.seed for trial in more.ended] == [0, 1]
    monkeypatch.setattr(one, "plan_to_climb", lambda *_, **__: None)
    with pytest.raises(NoPlanError, match="no plan for 'ladder'"):
        with_plan(unplanned)


@pytest.mark.usefixtures("in_this_process")
def test_a_store_of_other_trials_and_a_plan_that_fails_are_refused_before_anything_runs(tmp_path: Path) -> None:
    setup, store = setup_of(300), tmp_path / "trials.db"
    run_trials(setup, [0], executor=LocalProcesses(1), store=store)
    other = replace(setup, noise=setup.noise.changed(["friction=10%"]))
    for changed in (other, replace(setup, plant=("backlash=1deg",)), setup_of(300, 3)):
        with pytest.raises(StoreError, match="holds the results of trials of 'ladder'"):
            with_plan(changed, store)
    with pytest.raises(StoreError, match="has 1 finished items"):
        run_trials(setup, [0, 1], executor=LocalProcesses(1), store=store)
    with pytest.raises(PlanRefusedError, match="mine, step"):
        with_plan(setup_of(300, *([3] * 8)), label="mine")
    with pytest.raises(NoiseError, match="hook_play"):
        with_plan(replace(setup, noise=setup.noise.changed(["hook_play=2mm"])))


def command(plan: Path, store: Path, *more: str) -> list[str]:
    words = ["trials", str(plan), "-n", "10", "--workers", "2", "--store", str(store), "--resume", "--json", *more]
    return [sys.executable, "-c", "import sys; from clamber.cli import main; main(sys.argv[1:])", *words]


def rows(store: Path) -> dict[int, tuple[str, float]]:
    if not store.exists() or not store.stat().st_size:
        return {}
    with sqlite3.connect(f"file:{store}?mode=ro", uri=True, timeout=5.0) as file:
        try:
            found = file.execute("SELECT json_extract(item, '$.seed'), result, seconds FROM items").fetchall()
        except sqlite3.OperationalError:  # not made yet
            return {}
    return {seed: (result, seconds) for seed, result, seconds in found}


@pytest.mark.long
@pytest.mark.parametrize("stop", [signal.SIGKILL, signal.SIGINT])
def test_trials_stopped_at_several_moments_lose_and_repeat_none(tmp_path: Path, stop: signal.Signals) -> None:
    plan, store = tmp_path / "plan.json", tmp_path / "trials.db"
    setup = setup_of(*LETS_GO)
    assert setup.plan is not None
    setup.plan.save(plan)
    environment = os.environ | {"PYTHONPATH": str(Path(clamber.__file__).parents[1])}
    before: dict[int, tuple[str, float]] = {}
    for enough in (1, 4, 7):
        process = subprocess.Popen(command(plan, store), env=environment, stdout=subprocess.PIPE, text=True)
        while process.poll() is None and len(rows(store)) < enough:
            time.sleep(0.01)
        process.send_signal(stop)
        out, _ = process.communicate(timeout=60)
        now = rows(store)
        assert before.items() <= now.items(), "a trial was lost, or climbed again"
        if stop == signal.SIGINT:
            said = json.loads(out)
            assert process.returncode == (130 if len(now) < 10 else 0)
            assert said["n"] == len(said["trials"]) == len(now) >= enough
        before = now
    assert len(before) > 0
    done = subprocess.run(command(plan, store), env=environment, stdout=subprocess.PIPE, text=True, check=False)
    told = json.loads(done.stdout)
    assert before.items() <= rows(store).items()
    straight = run_trials(setup, range(10), executor=LocalProcesses(2))
    assert told["trials"] == [trial.to_json() for trial in straight.ended]
