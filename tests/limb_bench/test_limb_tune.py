"""Tuning: the stored gains come to rest, too large ones do not, and the procedure finds them again."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from clamber.cli.printed.library import schema_of
from clamber.control.law_settings import LAWS, LawSettings
from clamber.control.recommended import (
    RecommendationError,
    Recommended,
    read_recommended,
    save_recommended,
)
from clamber.errors import SpecError, UnknownNameError
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.entries import read_law, tip_stiffness, with_recommended_gains
from clamber.limb_bench.runner import Crew
from clamber.limb_bench.stability import STEADY, peak_to_peak, poses, run_situations, situations
from clamber.limb_bench.tune import (
    DAMPING_TIMES,
    OVERSHOOT,
    PRECISION,
    Edge,
    TuningError,
    chosen_edge,
    find_edge,
    rounded_down,
    tune,
)
from clamber.sim.bench_limb import BenchLimb
from clamber.sim.flaw_texts import named_flaws
from clamber.sim.limb_flaws import LimbFlaws


@pytest.fixture(scope="module")
def limb() -> BenchLimb:
    return bench_limb("libra")


@pytest.fixture(scope="module")
def flaws(limb: BenchLimb) -> LimbFlaws:
    return named_flaws("nominal", limb.robot)


def stored(law: str) -> tuple[LawSettings, Recommended]:
    (found,) = (one for one in read_recommended() if (one.robot, one.limb, one.law) == ("libra", "right", law))
    return replace(read_law(law), kp=found.kp, kd=found.kd), found


def swing(limb: BenchLimb, law: LawSettings, flaws: LimbFlaws, every: int) -> float:
    """Largest peak to peak at rest over a part of the situations."""
    chosen = situations(limb, flaws.control_rate, "search")[::every]
    drawn = flaws.with_changes(seed=3)
    return max(float(peak_to_peak(trace).max()) for _, trace in run_situations(limb, law, drawn, chosen))


def test_the_nominal_plant_is_that_of_the_issue(flaws: LimbFlaws) -> None:
    assert math.degrees(flaws.backlash) == pytest.approx(2.0)
    assert (flaws.control_rate, flaws.encoder_counts, flaws.delay) == (200.0, 400, 1)


@pytest.mark.slow
@pytest.mark.parametrize("every", [6, 3])
@pytest.mark.parametrize("law", LAWS)
def test_no_law_limit_cycles_at_its_recommended_gains(limb: BenchLimb, flaws: LimbFlaws, law: str, every: int) -> None:
    assert swing(limb, stored(law)[0], flaws, every=every) <= 0.0005


@pytest.mark.slow
@pytest.mark.parametrize("law", ["scct", "jacobian-transpose", "operational-space"])
def test_a_law_limit_cycles_beyond_its_limit(limb: BenchLimb, flaws: LimbFlaws, law: str) -> None:
    settings, found = stored(law)
    worn = flaws.with_changes(friction=0.7)  # as the limit was searched
    for part, steady in ((1.0, True), (1.1, False)):
        kp, kd = (part * found.limit_kp / found.kp * gain for gain in (found.kp, found.kd))
        assert (swing(limb, replace(settings, kp=kp, kd=kd), worn, every=1) <= STEADY) == steady


@pytest.mark.parametrize("law", LAWS)
def test_recommended_gains_keep_their_margin(law: str) -> None:
    found = stored(law)[1]
    assert found.margin == 2.0
    assert found.kp <= found.limit_kp / found.margin <= 1.02 * found.kp


def test_situations_cover_both_elbows_near_and_far(limb: BenchLimb) -> None:
    places = poses(limb)
    assert {round(math.copysign(1.0, q[1])) for q in places} == {-1, 1}
    reaches = sorted({round(float((limb.chain.place(q)[:2] ** 2).sum() ** 0.5), 3) for q in places})
    assert reaches[0] < 0.2 < 0.27 < reaches[-1]


def test_the_derivative_of_the_implicit_admittance_is_no_stiffness(limb: BenchLimb) -> None:
    scct, implicit = (
        tip_stiffness(limb.chain, LawSettings(law=law, kp=100.0, kd=4.0), limb.q0)
        for law in ("scct", "implicit-admittance")
    )
    np.testing.assert_allclose(implicit, scct, rtol=1e-6)


def test_every_command_has_ended_before_the_limb_must_be_still(limb: BenchLimb) -> None:
    for each in situations(limb, 200.0, "fine"):
        late = each.aims[800:]
        assert (late["place"] == late["place"][0]).all()
        assert not late["twist"].any() and not late["acceleration"].any()
        assert each.push is None or each.push.end + each.push.rise < 4.0


@given(st.floats(1e-3, 1e6), st.integers(1, 5))
def test_rounding_down_never_adds_and_loses_less_than_one_digit(value: float, digits: int) -> None:
    down = rounded_down(value, digits)
    assert down <= value * (1 + 1e-11)
    assert down > value * (1 - 1.0001 * 10.0 ** (1 - digits))


def edge(kp: float, overshoot: float) -> Edge:
    return Edge(damping_time=0.02, kp=kp, beyond=kp, linear_kp=kp, situation="", overshoot=overshoot)


def test_the_stiffest_of_the_calm_edges_is_chosen() -> None:
    assert chosen_edge([edge(3.0, 2 * OVERSHOOT), edge(1.0, 0.0), edge(2.0, OVERSHOOT)]).kp == 2.0
    assert chosen_edge([edge(3.0, 0.9), edge(1.0, 0.5)]).kp == 1.0


def test_saved_gains_replace_their_own_kind_alone(tmp_path: Path) -> None:
    path = tmp_path / "gains.toml"
    first = Recommended(
        robot="r", limb="a", law="scct", kp=1.5, kd=0.25, limit_kp=3.0, margin=2.0, stiffness=(1.0, 2.0),
        plant={"backlash": 0.01, "delay": 1},
    )  # fmt: skip
    other = replace(first, law="joint-pd")
    save_recommended([first, other], path)
    save_recommended([replace(first, kp=1.25)], path)
    assert read_recommended(path) == [other, replace(first, kp=1.25)]


def test_laws_take_the_gains_recommended_for_them(limb: BenchLimb) -> None:
    texts = ["scct", "scct:kp=7", "joint-pd:weight=none", "operational-space:feed_friction=1,feed_acceleration=yes"]
    laws = [read_law(text) for text in with_recommended_gains(limb, texts)]
    for law, name in ((laws[0], "scct"), (laws[2], "joint-pd"), (laws[3], "operational-space")):
        found = stored(name)[1]
        assert (law.kp, law.kd) == (found.kp, found.kd)
    assert laws[1].kp == 7.0
    assert laws[3].feed_friction == 1.0


@pytest.mark.parametrize("text", ["scct:weight=damping", "scct:feed_friction=1,friction_from=measured"])
def test_a_law_with_another_loop_has_no_recommended_gains(limb: BenchLimb, text: str) -> None:
    with pytest.raises(RecommendationError, match="no gains of scct"):
        with_recommended_gains(limb, [text])


@pytest.mark.parametrize(
    ("text", "error"),
    [('schema = "other"', SpecError), ('schema = "clamber-gains-1"\n[[gains]]\nrobot = "r"', RecommendationError)],
)
def test_a_file_of_something_else_is_refused(tmp_path: Path, text: str, error: type[Exception]) -> None:
    path = tmp_path / "gains.toml"
    path.write_text(text)
    with pytest.raises(error):
        read_recommended(path)


def test_a_margin_of_one_is_refused(limb: BenchLimb, flaws: LimbFlaws) -> None:
    with pytest.raises(TuningError, match=r"margin: is 1; must be more than 1"):
        tune(limb, ["scct"], flaws, margin=1.0)


def test_an_unknown_law_is_refused_before_anything_runs(limb: BenchLimb, flaws: LimbFlaws) -> None:
    with pytest.raises(UnknownNameError, match="nosuch"):
        tune(limb, ["scct", "nosuch"], flaws)


@pytest.mark.long
@pytest.mark.parametrize("law", LAWS)
def test_the_procedure_finds_the_stored_limit_again(limb: BenchLimb, flaws: LimbFlaws, law: str) -> None:
    found = stored(law)[1]
    time = min(DAMPING_TIMES, key=lambda each: abs(each - found.kd / found.kp))
    (again,) = tune(limb, [law], flaws, damping_times=(time,), crew=Crew(workers=2)).laws
    assert again.limit_kp == pytest.approx(found.limit_kp, rel=PRECISION)
    assert again.steady
    assert again.limit_kp == pytest.approx(again.linear_kp, rel=0.25)  # friction calms a little beyond the linear limit


@pytest.mark.long
def test_a_tuning_does_not_depend_on_the_number_of_workers(limb: BenchLimb, flaws: LimbFlaws) -> None:
    alone, together = (
        tune(
            limb, ["scct", "joint-pd"], flaws, damping_times=(0.04,), effort="search", crew=Crew(workers=workers)
        ).to_json()
        for workers in (1, 3)
    )
    assert alone == together
    Draft202012Validator(schema_of("limb tune")).validate(json.loads(json.dumps(alone)))


@pytest.mark.long
def test_an_edge_lies_between_its_two_witnesses(limb: BenchLimb, flaws: LimbFlaws) -> None:
    from dataclasses import asdict

    told = find_edge(
        {
            "robot": "libra", "limb": "right", "start": list(limb.start), "q0": limb.q0.tolist(), "law": "scct",
            "damping_time": 0.057, "margin": 2.0, "flaws": asdict(flaws),
        }
    )  # fmt: skip
    assert told["kp"] < told["beyond"] <= told["kp"] * (1.0 + PRECISION)
    assert told["situation"]
