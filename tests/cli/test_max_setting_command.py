"""`clamber max-setting`: what it prints, how it leaves, what it refuses."""

import json
from functools import partial
from typing import Any

import pytest


@pytest.fixture
def most(clamber: Any) -> Any:
    return partial(clamber, "max-setting", "level-walk", "--set", "way.0.distance=2cm")


@pytest.mark.slow
def test_the_heaviest_payload_stands_beside_the_next_that_is_not_borne(most: Any) -> None:
    code, out, _ = most("--vary", "payload=5kg..40kg:2", "--json", "-q")
    said = json.loads(out)
    assert code == 0
    assert (said["key"], said["borne"], said["refused"]) == ("payload", "5 kg", "40 kg")
    assert [each["borne"] for each in said["tried"]] == [True, False]
    assert said["tried"][1]["reason"]


def test_where_nothing_is_borne_it_leaves_with_1(most: Any) -> None:
    code, out, err = most("--vary", "payload=30kg..35kg:6")
    assert code == 1
    assert "does not bear even payload = 30 kg" in out
    assert "payload = 35 kg" not in err  # no walk in vain
    assert max(map(len, out.splitlines())) <= 80


@pytest.mark.parametrize(
    ("vary", "said"),
    [
        ("payload=5kg", "is no range"),
        ("payload=5kg..1kg", "empty"),
        ("weight=1kg..2kg", "payload"),
        ("plant.backlash=1deg..2deg", "friction"),
    ],
)
def test_bad_input_is_one_message(most: Any, vary: str, said: str) -> None:
    code, out, err = most("--vary", vary, "-q")
    assert (code, out) == (2, "")
    assert said in err and "Traceback" not in err
