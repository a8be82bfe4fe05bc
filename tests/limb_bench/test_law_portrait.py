"""A law's portrait as a picture: every law's equation can be set, the same portrait gives the same bytes, and few of them."""

import struct
from pathlib import Path

import pytest
from matplotlib.mathtext import MathTextParser

from clamber.control.law_settings import LAWS, LawSettings
from clamber.limb_bench.pictures.portrait import LAW_EQUATIONS, draw_portrait
from clamber.limb_bench.portrait import paint_portraits
from clamber.viewing.output import SuffixError


def test_every_law_has_an_equation() -> None:
    assert set(LAW_EQUATIONS) == set(LAWS)
    for equation in LAW_EQUATIONS.values():
        assert MathTextParser("path").parse(equation).width < 400.0


@pytest.mark.slow
@pytest.mark.locked
def test_portraits_are_small_pictures_of_one_size_and_the_same_each_time(tmp_path: Path) -> None:
    for each in paint_portraits(["jacobian-transpose", "admittance"]):
        for name in ("a.png", "b.png"):
            draw_portrait(each, tmp_path / name)
        picture = (tmp_path / "a.png").read_bytes()
        assert picture == (tmp_path / "b.png").read_bytes()
        assert len(picture) < 60_000
        assert struct.unpack(">II", picture[16:24]) == (902, 401)


def test_a_law_that_goes_unstable_is_drawn_too(tmp_path: Path) -> None:
    (wild,) = paint_portraits(["hybrid"], matched=LawSettings(law="scct", kp=6000.0, kd=0.0))
    draw_portrait(wild, tmp_path / "wild.svg")
    assert "unstable" in (tmp_path / "wild.svg").read_text()
    with pytest.raises(SuffixError):
        draw_portrait(wild, tmp_path / "wild.txt")
