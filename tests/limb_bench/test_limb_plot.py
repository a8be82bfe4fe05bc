"""Pictures of comparisons: one for each kind of scenario, with the choices that decide written on it."""

from pathlib import Path
from typing import Any

import pytest
from matplotlib.figure import Figure

from clamber.control.law_settings import LawSettings
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.entries import make_entries
from clamber.limb_bench.result import LimbResult, Matching, compare_laws
from clamber.limb_bench.runner import Contest
from clamber.limb_bench.scenario import Scenario, circle_scenario, push_scenario, step_scenario
from clamber.sim.bench_limb import BenchLimb
from clamber.sim.limb_flaws import LimbFlaws
from clamber.viewing import output
from clamber.viewing.output import SuffixError

REFERENCE = LawSettings(law="scct", kp=100.0, kd=10.0)


def asked(kind: str) -> tuple[BenchLimb, Scenario]:
    limb = bench_limb(start=(0.27, 0.0) if kind == "circle" else (0.22, 0.0))
    if kind == "circle":
        return limb, circle_scenario(limb, 200.0, lap=1.5)
    if kind == "step":
        return limb, step_scenario(limb, 200.0, seconds=1.0)
    return limb, push_scenario(limb, 200.0, start=0.1, end=0.5, seconds=1.0)


def compared(kind: str, *texts: str, flaws: LimbFlaws) -> LimbResult:
    limb, scenario = asked(kind)
    entries = make_entries(limb, texts or ("scct", "jacobian-transpose"), REFERENCE, "mean", limb.q0)
    return compare_laws(Contest(limb, scenario, entries, flaws), matching=Matching(REFERENCE, "mean"))


@pytest.mark.parametrize("kind", ["step", "circle", "push"])
def test_a_picture_says_how_gains_were_matched_and_who_ran_on_what(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[Figure] = []

    def keep(figure: Figure, path: Any) -> None:
        drawn.append(figure)

    monkeypatch.setattr(output, "save_figure", keep)
    compared(kind, flaws=LimbFlaws(backlash=0.02, delay=1)).draw(tmp_path / "a.png")
    text = " ".join(each.get_text() for each in drawn[0].texts)
    assert "matched by 'mean'" in text and "backlash 1.146 deg" in text and "delay 1" in text
    names = [each.get_text() for legend in drawn[0].legends for each in legend.get_texts()]
    assert {"scct", "jacobian-transpose"} <= set(names)


def test_the_same_result_gives_the_same_bytes_and_an_unstable_law_is_drawn(tmp_path: Path) -> None:
    for kind in ("step", "circle"):
        result = compared(kind, "scct:kp=4000,kd=0", flaws=LimbFlaws(delay=6))
        for name in ("a.png", "b.png"):
            result.draw(tmp_path / name)
        assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_a_name_without_a_picture_format_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SuffixError):
        compared("step", flaws=LimbFlaws()).draw(tmp_path / "a.txt")
