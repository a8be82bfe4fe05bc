"""Every law has a colour of its own, and every matching a line."""

from clamber.control.law_settings import LAWS
from clamber.limb_bench.entries import MATCHES
from clamber.viewing.style import LAW_COLOURS, MATCH_LINES


def test_every_law_has_a_colour_of_its_own() -> None:
    assert set(LAW_COLOURS) == set(LAWS)
    assert len(set(LAW_COLOURS.values())) == len(LAWS)


def test_every_matching_has_a_line_of_its_own() -> None:
    assert set(MATCH_LINES) == set(MATCHES)
    assert len(set(map(str, MATCH_LINES.values()))) == len(MATCHES)
