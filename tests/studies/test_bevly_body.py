"""Chapter 4 of Bevly 1997: what figures 4.15 to 4.19, sections 4.2 and 4.4.4 come to on our plant."""

import json
import math
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from clamber.execution.climb.body_gains import BodyGains
from clamber.experiments.climb.body_rung import RungTrial, climb_rung, climb_rungs
from clamber.experiments.climb.body_stand import bench_flaws, ladder_stand
from clamber.experiments.climb.body_stiffness import body_stiffness
from clamber.studies.bevly_1997 import body_table
from clamber.studies.bevly_1997.body_climb import climbed, show_gait
from clamber.studies.bevly_1997.body_cycle import CYCLE, GAINS, find_end, find_onset, peak_to_peak
from clamber.studies.bevly_1997.body_entries import EARLIER, JOINT_PD
from clamber.studies.bevly_1997.body_push import tenfold
from clamber.studies.bevly_1997.body_table import controls, count_lost_pegs, stiffer
from clamber.studies.library import ON_A_BODY
from clamber.studies.markdown import write_markdown
from clamber.studies.result import StudyResult

QUICK = {"fig-4-15": "holds", "fig-4-16": "holds", "fig-4-18": "differs"}
LONG = {"fig-4-17": "open", "fig-4-19": "open", "section-4-4-4": "holds"}


@cache
def told(name: str) -> StudyResult:
    return ON_A_BODY[name]()


def keeps_its_verdict(name: str, verdict: str) -> None:
    result = told(name)
    assert (result.result, result.verdict) == (name, verdict)
    json.dumps(result.to_json(), allow_nan=False)
    assert len({row.name for row in result.compared}) == len(result.compared)  # no number hides another


@pytest.mark.parametrize("name", QUICK)
def test_quick_results_of_chapter_4_keep_their_verdicts(name: str, tmp_path: Path) -> None:
    keeps_its_verdict(name, QUICK[name])
    write_markdown([told(name)], tmp_path)
    assert {path.suffix for path in (tmp_path / "bevly-1997").iterdir()} == {".md", ".png"}


@pytest.mark.long
@pytest.mark.parametrize("name", LONG)
def test_long_results_of_chapter_4_keep_their_verdicts(name: str) -> None:
    keeps_its_verdict(name, LONG[name])


def test_the_gait_climbs_two_rungs_and_every_hook_ends_on_its_peg() -> None:
    run = climbed(2)
    assert run.report.done
    assert run.trace.true_pose is not None
    rise = run.trace.true_pose[-1, 1] - run.trace.true_pose[0, 1]
    assert rise == pytest.approx(0.3048, abs=0.015)  # two rungs [m]
    assert list(run.trace.holds[-1]) == [8, 7, 0]


def test_the_sides_of_the_bottom_elbow_alternate_and_decide() -> None:
    sides = str(show_gait().numbers["sides of leg 3's elbow that it holds with"]).split()
    assert set(sides) <= {"-1", "+1"}
    assert all(before != after for before, after in pairwise(sides))
    assert show_gait().verdict == ("holds" if len(sides) > 1 else "open")


def test_gains_for_ten_times_give_ten_times_the_compliance() -> None:
    stand = ladder_stand()
    compliance = np.linalg.inv(body_stiffness(stand, tenfold(stand)))
    assert compliance[0, 0] / compliance[1, 1] == pytest.approx(10.0, rel=1e-6)


def test_onsets_are_read_from_the_stiff_end_and_sways_from_the_soft_one() -> None:
    swings = [0.0] * len(GAINS)
    assert find_onset(swings) is None and find_end(swings) is None
    swings[0], swings[3], swings[-2], swings[-1] = 9.0, 9.0, 9.0, 9.0
    assert find_onset(swings) == GAINS[-2]
    assert find_end(swings) == GAINS[0]
    assert find_onset([9.0] * len(GAINS)) == GAINS[0]


def test_measured_at_one_hook_a_stiff_body_with_play_cycles_and_measured_at_both_it_rests() -> None:
    worn, tight = bench_flaws("nominal"), bench_flaws("nominal", ["backlash=0deg"])
    stand = ladder_stand(fixed=True)
    kpx = 4800.0
    assert peak_to_peak(stand, kpx, True, worn) > CYCLE
    assert peak_to_peak(stand, kpx, False, worn) < CYCLE
    assert peak_to_peak(stand, kpx, True, tight) < CYCLE


def test_trials_of_a_rung_are_the_same_wherever_they_run(tmp_path: Path) -> None:
    alone = climb_rung(BodyGains(), 3)
    assert alone.done and not alone.lost
    store = tmp_path / "rungs.db"
    first = climb_rungs({"now": BodyGains()}, range(3, 4), store=store)
    again = climb_rungs({"now": BodyGains()}, range(3, 4), store=store, resume=True)
    assert first == again == {"now": [alone]}


def test_the_table_judges_by_who_loses_pegs(monkeypatch: pytest.MonkeyPatch) -> None:
    def made_up(controls: dict[str, BodyGains], seeds: range, **_: object) -> dict[str, list[RungTrial]]:
        stiff = tuple(map(stiffer, (JOINT_PD, EARLIER)))
        bad = ((), (JOINT_PD, body_table.PRINTED), stiff, (JOINT_PD, EARLIER, *stiff))[len(seeds) - 1]
        return {label: [RungTrial(label not in bad, label in bad, "fell", 20.0)] * len(seeds) for label in controls}

    monkeypatch.setattr(body_table, "climb_rungs", made_up)
    assert [count_lost_pegs(seeds).verdict for seeds in (1, 2, 3, 4)] == ["differs", "open", "open", "holds"]


def test_stiffer_controls_of_the_table_are_as_much_stiffer_in_every_way() -> None:
    """But for those of our own map, whose damping is a rate: it stays."""
    gains = controls()
    soft, stiff = gains[JOINT_PD], gains[stiffer(JOINT_PD)]
    assert len(gains) == 12
    assert stiff.leg_kp / soft.leg_kp == pytest.approx(body_table.STIFFER)
    assert stiff.leg_kd / soft.leg_kd == pytest.approx(math.sqrt(body_table.STIFFER))
    for label in body_table.CARTESIAN:
        one, other = gains[label], gains[stiffer(label)]
        assert np.divide(other.kp, one.kp) == pytest.approx(np.full(3, body_table.STIFFER))
        assert np.divide(other.stiffness, one.stiffness) == pytest.approx(np.full(3, body_table.STIFFER))
        assert np.divide(other.kd, one.kd) == pytest.approx(np.full(3, math.sqrt(body_table.STIFFER)))
        assert other.limb_kp == one.limb_kp
