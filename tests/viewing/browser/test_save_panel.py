"""The viewer's Save: all of its files are written, or all stay as they were."""

import os
from pathlib import Path

import pytest

from clamber.viewing.browser.save_panel import SavePanel

viser = pytest.importorskip("viser")


class Anything:
    """Stands for the page's server: whatever is made in it keeps what it was made with."""

    def __init__(self, *given: object, **_: object) -> None:
        self.value = given[1] if len(given) > 1 else ""
        self.content = ""

    @property
    def gui(self) -> "Anything":
        return self

    def __enter__(self) -> "Anything":
        return self

    def __exit__(self, *_: object) -> None: ...

    def add_folder(self, *given: object, **_: object) -> "Anything":
        return Anything(*given)

    add_text = add_button = add_html = add_folder

    def on_click(self, _: object) -> None: ...


def test_a_save_that_fails_half_way_leaves_every_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    texts = {"mine.toml": "first", "mine-board.toml": "first"}
    panel = SavePanel(Anything(), "mine", tmp_path, lambda _: dict(texts))  # type: ignore[arg-type]
    panel.save()
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == texts
    before = dict(texts)
    texts.update(dict.fromkeys(texts, "second"))
    rename = os.replace

    def fails_at_last(source: Path, target: Path) -> None:
        if Path(target).name == "mine-board.toml" and Path(source).read_text() == "second":
            raise OSError(28, "No space left on device")
        rename(source, target)

    with monkeypatch.context() as patched:
        patched.setattr(os, "replace", fails_at_last)
        panel.save()
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == before
    assert "No space left on device" in panel._words.content
    panel.save()
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == texts
