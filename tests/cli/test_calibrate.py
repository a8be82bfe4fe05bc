"""`clamber calibrate`."""

import json
from collections.abc import Callable

import pytest

Clamber = Callable[..., tuple[int, str, str]]


@pytest.mark.slow
def test_calibrate_lists_fits_and_rivals(clamber: Clamber) -> None:
    code, out, _ = clamber("calibrate", "--seeds", "1", "--json")
    assert code == 0
    told = json.loads(out)
    assert told[0]["free"] == ["radius", "shortest"]
    assert told[0]["fits"][0]["radius_delta_m"] == pytest.approx(0.2382, abs=2e-4)
    assert all(rivals["seeds"] == 1 for rivals in told)
    code, out, _ = clamber("calibrate", "--seeds", "1")
    assert code == 0
    assert "(1) 1 of 1 starts: equal circles, neighbouring tips; step: chord through the centre" in " ".join(
        out.split()
    )


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--least", "3 deg"), "either side of 0 deg"),
        (("--step", "0 mm"), "more than 0"),
        (("--stroke", "250"), "lacks its unit"),
    ],
)
def test_calibrate_names_what_is_wrong(clamber: Clamber, words: tuple[str, ...], told: str) -> None:
    code, _, err = clamber("calibrate", *words)
    assert code == 2
    assert told in " ".join(err.replace("│", " ").split())
