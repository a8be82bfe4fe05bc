"""Pictures of sweeps of laws and of tunings are written whole, the same bytes each time, for one axis and two."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from clamber.cli.limb.options import LawWords, NominalLimbWords
from clamber.cli.limb.sweep import CommandWords, make_bench
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.pictures.sweep import rims
from clamber.limb_bench.sweep import Boundary, LimbSweep
from clamber.limb_bench.sweep_point import Cell
from clamber.limb_bench.tune import Edge, Tuned, Tuning
from clamber.planning.axes import range_axis
from clamber.sim.flaw_texts import named_flaws
from clamber.viewing.output import SuffixError


def made_sweep(*, two: bool, divided: bool = True) -> LimbSweep:
    """Law "b" is better but unstable above kp = 250, law "a" above 350."""
    axes = [range_axis("kp=100..400:4")]
    if two:
        axes.insert(0, range_axis("delay=0..2:3" if not divided else "backlash=0deg..2deg:3"))
    points = tuple(
        {"a": Cell(0.002, 0.0, kp <= 350.0), "b": Cell(0.001, 0.0, kp <= 250.0)}
        for _ in range(3 if two else 1)
        for kp in (100.0, 200.0, 300.0, 400.0)
    )
    beside = (0.0, 1.0, 2.0) if two else (None,)
    boundaries = tuple(
        Boundary(label=label, key="kp", at=at, beside=other, steady_below=True)
        for other in beside
        for label, at in (("a", 350.0), ("b", 250.0))
    )
    return LimbSweep(
        bench=make_bench(CommandWords(), LawWords(), NominalLimbWords()),
        axes=tuple(axes),
        labels=("a", "b"),
        points=points,
        boundaries=boundaries,
        scan="kp",
    )


@pytest.mark.parametrize("two", [False, True])
def test_a_sweep_is_drawn_the_same_each_time(tmp_path: Path, two: bool) -> None:
    for name in ("one.svg", "two.svg"):
        made_sweep(two=two).draw(tmp_path / name)
    first, second = ((tmp_path / name).read_bytes() for name in ("one.svg", "two.svg"))
    strip = [line for line in first.splitlines() if b"<dc:date>" not in line]
    assert strip == [line for line in second.splitlines() if b"<dc:date>" not in line]


def test_the_best_law_changes_where_the_better_one_turns_unstable() -> None:
    assert [made_sweep(two=False).winner(k) for k in range(4)] == ["b", "b", "a", None]


def test_rims_lie_half_way_between_values() -> None:
    np.testing.assert_allclose(rims(np.array([0.0, 1.0, 3.0])), [-0.5, 0.5, 2.0, 4.0])


@pytest.mark.parametrize("draw", ["sweep", "tuning"])
def test_a_picture_of_no_known_kind_is_refused(tmp_path: Path, draw: str) -> None:
    result: Any = made_sweep(two=False) if draw == "sweep" else made_tuning()
    with pytest.raises(SuffixError, match=r"map\.doc"):
        result.draw(tmp_path / "map.doc")
    assert not list(tmp_path.iterdir())


def made_tuning() -> Tuning:
    edges = tuple(
        Edge(damping_time=time, kp=60.0 / time, beyond=61.0 / time, linear_kp=58.0 / time, situation="", overshoot=0.0)
        for time in (0.02, 0.04, 0.08)
    )
    law = Tuned(
        law="scct", edges=edges, damping_time=0.04, limit_kp=1500.0, linear_kp=1450.0, kp=750.0, kd=30.0, stiffness=(1.0, 2.0),
        peak_to_peak=1e-4, situation="", lower=1e-4, overshoot=0.1, iae=1e-3,
    )  # fmt: skip
    limb = bench_limb("libra")
    return Tuning(limb=limb, flaws=named_flaws("nominal", limb.robot), margin=2.0, laws=(law,))


def test_a_tuning_is_drawn(tmp_path: Path) -> None:
    made_tuning().draw(tmp_path / "tune.png")
    assert (tmp_path / "tune.png").read_bytes().startswith(b"\x89PNG")
