"""What the panel says: the worst check is marked, and nothing that a file says becomes a part of the page."""

from dataclasses import replace

import numpy as np

from clamber.families.walker.pictures.walker_loads import leg_force_gauges
from clamber.families.walker.robot import WalkerRobot
from clamber.tasks.robots import load_robot
from clamber.viewing import style
from clamber.viewing.browser.panel_html import head_html, loads_html, margins_html, message_html, strip_html
from clamber.viewing.browser.viewer_content import open_exhibit
from clamber.viewing.recording import MarginRow


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
        loads_html(film.gauges, (np.zeros(len(film.gauges[0].names)),)),
    ]
    assert all("<script" not in page for page in pages)


def test_strip_marks_the_worst_step() -> None:
    film = open_exhibit(["ladder-hand"]).plan_film
    assert film is not None and film.worst is not None
    page = strip_html(film, 5, "margins")
    assert f"step {film.worst}" in page
    assert f'x="{film.worst - 1}" y="0" width="1"' in page
    assert 'x1="4.5"' in page


def test_what_is_not_told_has_no_bar_and_a_limit_only_where_one_is_known() -> None:
    robot = load_robot("hoshino")
    assert isinstance(robot, WalkerRobot)
    forces = np.array((100.0, 0.0, np.nan, 400.0, 400.0, 400.0))
    page = loads_html((leg_force_gauges(robot, 800.0),), (forces,))
    assert "400 N" in page and "&ndash;" in page and "nan" not in page
    assert "red line" not in page and "its file states no limit" in page
    limited = leg_force_gauges(replace(robot, legs=replace(robot.legs, force=420.0)), 800.0)
    page = loads_html((limited,), (forces,))
    assert "red line: limit" in page and "states no limit" not in page
    assert page.count(f"background:{style.ALERT};height:8px;width:95.2%") == 3  # 400 of 420 N
