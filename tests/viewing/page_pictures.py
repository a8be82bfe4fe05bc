"""Pictures that tests keep of pages that are open in a browser."""

from pathlib import Path
from typing import Any

PICTURES = Path(__file__).resolve().parents[2] / "out" / "screenshots"
REFUSED = "Unable to capture screenshot"


def take_picture(shown: Any, name: str | None = None) -> bytes:
    """A picture of a page or of a part of one, in PNG; kept as a file if it has a name.

    Chromium now and then refuses one capture with the words above, and takes the same one a moment later: it is asked
    twice. Whatever else goes wrong is raised at once.
    """
    path = None
    if name is not None:
        PICTURES.mkdir(parents=True, exist_ok=True)
        path = PICTURES / f"{name}.png"
    try:
        taken: bytes = shown.screenshot(path=path)
    except Exception as error:
        if REFUSED not in str(error):
            raise
        page = getattr(shown, "page", shown)
        page.wait_for_timeout(500)
        taken = shown.screenshot(path=path)
    return taken
