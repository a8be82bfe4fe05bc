"""Holds in space are edited on the viewer's page by clicks and numbers, and saved; forces and margins are shown while a plan plays."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from page_visits import Visit, pixel, wait_for

from clamber.families.spatial.pictures.hold_editor import HoldPanel
from clamber.planning.beam import plan_beam
from clamber.tasks import load_task
from clamber.viewing.browser.app import App
from clamber.viewing.browser.viewer_content import exhibit_of, open_exhibit

Open = Callable[[str], Visit]
Serve = Callable[..., App]


@pytest.mark.long
def test_holds_are_picked_moved_added_removed_and_saved_by_clicks(serve: Serve, visit: Open, tmp_path: Path) -> None:
    app = serve(open_exhibit(["wall-gripper"]), folder=tmp_path)
    shown, panel = visit(app.url), app.editor
    assert isinstance(panel, HoldPanel)
    page, draft = shown.page, panel.draft
    page.get_by_role("tab", name="World").click()
    page.get_by_label("edit in the scene").check()
    count = len(draft.holds)

    hold = draft.holds[149]
    page.mouse.click(*pixel(app, shown, np.array(hold.at)))
    wait_for(shown, lambda: panel.picked() == 150)
    place = shown.vector(f"its place [{panel.unit}]")
    place.nth(1).fill("12.5")
    place.nth(1).press("Enter")
    wait_for(shown, lambda: draft.holds[149].at[1] == pytest.approx(12.5 * panel.size))
    normal = shown.vector("its normal")
    normal.nth(2).fill("0.5")
    normal.nth(2).press("Enter")
    wait_for(shown, lambda: abs(draft.holds[149].normal[2]) > 0.3)
    shown.picture("holds-picked")

    shown.press("add")
    wait_for(shown, lambda: len(draft.holds) == count + 1)
    shown.press("remove")
    wait_for(shown, lambda: len(draft.holds) == count)

    shown.press("Save")
    shown.says("written to")
    saved = load_task(str(tmp_path / "wall-gripper-edited.toml"))
    assert len(saved.world.holds) == count
    assert saved.world.holds[149].at == pytest.approx(draft.holds[149].at, abs=1e-8)
    assert shown.wrong == []


@pytest.mark.long
def test_forces_are_arrows_and_margins_bars_while_a_plan_plays(serve: Serve, visit: Open) -> None:
    task = load_task("wall-gripper", ["goal={ along_min = '0.2 m' }"])
    found = plan_beam(task, width=20, threads=1)
    app = serve(exhibit_of(task, found.plan))
    shown = visit(app.url)
    shown.says("Start")
    shown.press("step ▶")
    shown.says("Step 1 of")
    shown.page.wait_for_timeout(1500)
    shown.picture("space-step")
    margins = shown.page.locator('[data-clamber="margins"] tr')
    assert margins.count() >= 6
    assert shown.page.get_by_text("Share of each limit that is left").count() >= 1
    assert any("equilibrium" in words for words in margins.all_inner_texts())
    shown.press("Play")
    wait_for(shown, lambda: app.playback.time > 0.6)
    shown.press("Pause")
    assert shown.wrong == []
