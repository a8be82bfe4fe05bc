"""The site of studies in a real browser, made by the command."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from clamber.cli import main


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("report") / "site"
    for words in (("bevly-1997", "ladder-plan"), ("hoshino-1995", "table"), ("bevly-1997", "inventory-size")):
        with pytest.raises(SystemExit) as left:
            main(["study", *words, "--report", str(folder), "--quiet"])
        assert not left.value.code
    return folder


def test_the_index_leads_to_every_result_and_back(site: Path, visit: Callable[..., Any]) -> None:
    page = visit(site / "index.html", "studies-index")
    names = page.eval_on_selector_all(".list a", "all => all.map(one => one.textContent)")
    assert names == ["inventory-size", "ladder-plan", "table"]
    for name in names:
        page.click(f".list a:text-is('{name}')")
        assert name in page.inner_text("h1")
        page.click("nav >> text=All results")
    assert page.title() == "Published results, repeated"


@pytest.mark.parametrize("dark", [False, True])
def test_a_result_fits_a_phone_and_a_desk(site: Path, visit: Callable[..., Any], dark: bool) -> None:
    for width in (390, 1100):
        page = visit(site / "bevly-1997" / "ladder-plan.html", f"study-{width}-{dark}", width=width, dark=dark)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        paper = page.evaluate("getComputedStyle(document.body).backgroundColor")
        assert paper == ("rgb(20, 25, 30)" if dark else "rgb(255, 255, 255)")
        assert page.inner_text("pre") == "clamber study bevly-1997 ladder-plan"
