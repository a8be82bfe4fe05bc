"""A plan of a robot in space as a page that a browser opens."""

from collections.abc import Callable
from pathlib import Path

from page_visits import Visit

from clamber.planning.beam import plan_beam
from clamber.tasks import load_task
from clamber.viewing.browser.page import write_page
from clamber.viewing.browser.viewer_content import exhibit_of


def test_a_page_shows_a_plan_with_its_steps_and_margins(visit: Callable[[str], Visit], tmp_path: Path) -> None:
    task = load_task("wall-gripper", ["goal={ along_min = '0.2 m' }"])
    found = plan_beam(task, width=20, threads=1)
    assert found.plan is not None, found.reason
    write_page(exhibit_of(task, found.plan), tmp_path / "plan.html")
    page = visit((tmp_path / "plan.html").as_uri())
    steps = page.page.locator("#clamber li")
    assert steps.count() == 1 + len(found.plan.actions)
    assert any("to hold" in words for words in steps.all_inner_texts())
    steps.nth(2).click()
    page.page.locator('#clamber [data-part="head"]', has_text="Step 2").wait_for()
    assert "along" in page.page.locator('#clamber [data-part="head"]').inner_text()
    assert "Contact forces" in page.page.locator('#clamber [data-part="bars"]').inner_text()
    page.page.wait_for_timeout(1000)
    at_two = page.picture("robot-in-space")
    steps.nth(steps.count() - 1).click()
    page.page.locator('#clamber [data-part="head"]', has_text=f"Step {steps.count() - 1}").wait_for()
    page.page.wait_for_timeout(1000)
    assert page.picture("robot-in-space-end") != at_two
    assert page.wrong == []
