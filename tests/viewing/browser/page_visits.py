"""A page of the viewer that is open in a browser, as tests drive it."""

import math
import time
from typing import Any

import numpy as np
from page_pictures import take_picture

from clamber.types import Floats
from clamber.viewing.browser.app import App
from clamber.viewing.browser.solids import FOV

PATIENCE = 120_000  # [ms], far above what any step takes: pictures are drawn without a graphics card


class Visit:
    """A page that is open, with what its console said that is no plain log, and every address that it asked for."""

    def __init__(self, page: Any) -> None:
        self.page = page
        self.wrong: list[str] = []
        self.asked: list[str] = []
        page.set_default_timeout(PATIENCE)
        page.on("console", lambda said: self.wrong.append(said.text) if said.type == "error" else None)
        page.on("pageerror", lambda error: self.wrong.append(str(error)))
        page.on("request", lambda request: self.asked.append(request.url))

    def draws(self, seconds: float) -> bool:
        """Whether the page has a picture within some time [s]."""
        waited_from = time.monotonic()
        while time.monotonic() - waited_from < seconds:
            if self.page.locator("canvas[data-engine]").is_visible():
                return True
            self.page.wait_for_timeout(100)
        return False

    def picture(self, name: str) -> bytes:
        """Keep a picture of the page, and return that of its canvas."""
        take_picture(self.page, f"viewer-{name}")
        return take_picture(self.page.locator("canvas[data-engine]"))

    def says(self, words: str) -> None:
        """Wait until a text of ours has some words."""
        self.page.locator("[data-clamber]", has_text=words).first.wait_for()

    def vector(self, label: str) -> Any:
        """The fields of an input of several numbers."""
        return self.page.get_by_text(label, exact=True).locator("xpath=ancestor::*[3]").locator("input")

    def press(self, name: str) -> None:
        """Press a button."""
        self.page.get_by_role("button", name=name, exact=True).click()

    def errors(self) -> list[str]:
        """The messages that say what is wrong."""
        texts: list[str] = self.page.locator('[data-clamber="error"]').all_inner_texts()
        return texts


def wait_for(visit: Visit, holds: Any, seconds: float = 120.0) -> None:
    """Wait until something holds of the viewer behind a page."""
    for _ in range(int(10 * seconds)):
        if holds():
            return
        visit.page.wait_for_timeout(100)
    raise AssertionError(f"still not so after {seconds} s; the page says {visit.errors()}")


def pixel(app: App, visit: Visit, place: Floats) -> tuple[float, float]:
    """Where on the page a place in space is, as the camera looks at first."""
    box = visit.page.locator("canvas[data-engine]").bounding_box()
    camera = app.stage.scenery.camera()
    ahead = camera.look_at - camera.position
    ahead /= np.linalg.norm(ahead)
    right = np.cross(ahead, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    up = np.cross(right, ahead)
    way = np.asarray(place) - camera.position
    scale = 0.5 * box["height"] / math.tan(0.5 * FOV) / float(way @ ahead)
    return (
        box["x"] + 0.5 * box["width"] + scale * float(way @ right),
        box["y"] + 0.5 * box["height"] - scale * float(way @ up),
    )
