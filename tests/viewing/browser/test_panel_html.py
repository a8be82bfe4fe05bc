"""What the panel says: the worst check is marked, and nothing that a file says becomes a part of the page."""

import numpy as np

from clamber.viewing.browser.exhibit import open_exhibit
from clamber.viewing.browser.film import MarginRow
from clamber.viewing.browser.panel_html import bars_html, head_html, margins_html, message_html, strip_html


def row(name: str, share: float, **keys: bool) -> MarginRow:
    return MarginRow(name, "+1 cm", share, keys.get("hard", True), keys.get("worst", False), "what <it> says")


def test_hard_checks_come_first_and_the_worst_is_bold() -> None:
    page = margins_html([row("slack", 0.9), row("tight", 0.01, worst=True), row("told", -0.5, hard=False)])
    assert page.index("tight") < page.index("slack") < page.index("told")
    assert page.count("font-weight:700") == 1
    assert page.index("font-weight:700") < page.index("tight") < page.index("slack")


def test_texts_of_files_stay_texts() -> None:
    bad = "<script>alert(1)</script>"
    film = open_exhibit(["ladder"]).plan_film
    assert film is not None
    film.steps = (bad,)
    film.words = (bad,) * 4  # type: ignore[assignment]
    pages = [
        head_html(film, 0, film.at(0.0)),
        strip_html(film, 0, bad),
        margins_html([row(bad, 0.1)]),
        message_html(bad, bad=True),
        bars_html(film.gauges, np.zeros(len(film.gauges.names))),
    ]
    assert all("<script" not in page for page in pages)


def test_strip_marks_the_worst_step() -> None:
    film = open_exhibit(["ladder-hand"]).plan_film
    assert film is not None and film.worst is not None
    page = strip_html(film, 5, "margins")
    assert f"step {film.worst}" in page
    assert f'x="{film.worst - 1}" y="0" width="1"' in page
    assert 'x1="4.5"' in page
