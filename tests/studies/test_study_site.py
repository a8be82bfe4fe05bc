"""A site of studies: a page for each result and a table of all, whole after every result, safe against what is in the way."""

import json
import time
from pathlib import Path

import pytest

from clamber.errors import FileError
from clamber.studies import site as sites
from clamber.studies.library import STUDIES, TITLES
from clamber.studies.result import Compared, Figure, StudyResult, Table
from clamber.studies.site import StudySite, read_result, seeds_in_words

PIXEL = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108060000001f15c4890000000d49444154789c63f8ffff3f0005fe02fea73581840000000049454e44ae426082"
)


def made(name: str = "ladder-plan", **changes: object) -> StudyResult:
    usual: dict[str, object] = {
        "paper": "bevly-1997",
        "result": name,
        "claim": "<script>alert(1)</script> & more",
        "verdict": "differs",
        "compared": (Compared("length [m]", 1.25, 1.5), Compared("words", "a < b")),
        "deviations": ("none & all",),
        "table": Table(("step", "value"), ((1, float("inf")), (2, None))),
        "figures": (Figure("dot", "A dot.", lambda path: path.write_bytes(PIXEL)),),
        "seeds": range(3),
    }
    return StudyResult(**(usual | changes))  # type: ignore[arg-type]


def test_a_result_becomes_a_page_that_says_all_of_it(tmp_path: Path) -> None:
    StudySite(tmp_path / "site").add(made(), time.perf_counter())
    page = (tmp_path / "site" / "bevly-1997" / "ladder-plan.html").read_text(encoding="utf-8")
    for words in (
        "differs",
        "1.25",
        "1.5",
        "none &amp; all",
        "clamber study bevly-1997 ladder-plan",
        "0 to 2",
        "A dot.",
    ):
        assert words in page
    index = (tmp_path / "site" / "index.html").read_text(encoding="utf-8")
    assert 'href="bevly-1997/ladder-plan.html"' in index
    assert TITLES["bevly-1997"] in index


def test_what_a_result_says_is_shown_as_text_and_never_run(tmp_path: Path) -> None:
    StudySite(tmp_path).add(made(), time.perf_counter())
    for page in ("index.html", "bevly-1997/ladder-plan.html"):
        words = (tmp_path / page).read_text(encoding="utf-8")
        assert "<script" not in words
        assert "&lt;script&gt;alert(1)&lt;/script&gt; &amp; more" in words


def test_a_site_that_was_stopped_knows_what_it_has(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    StudySite(tmp_path).add(made(), time.perf_counter())
    again = StudySite(tmp_path)
    assert again.has("bevly-1997", "ladder-plan")
    assert not again.has("bevly-1997", "circle-plan")
    again.add(made("circle-plan"), time.perf_counter())
    assert "ladder-plan.html" in (tmp_path / "index.html").read_text(encoding="utf-8")
    monkeypatch.setattr(sites, "sources", lambda: "changed")
    assert not StudySite(tmp_path).has("bevly-1997", "ladder-plan")


def test_pages_lead_to_their_neighbours(tmp_path: Path) -> None:
    site = StudySite(tmp_path)
    first, second = list(STUDIES["bevly-1997"])[:2]
    site.add(made(second), time.perf_counter())
    site.add(made(first), time.perf_counter())
    assert f'{second}.html" rel="next"' in (tmp_path / f"bevly-1997/{first}.html").read_text(encoding="utf-8")
    assert f'{first}.html" rel="prev"' in (tmp_path / f"bevly-1997/{second}.html").read_text(encoding="utf-8")


def test_a_folder_with_other_files_is_refused_and_left_alone(tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text("mine")
    with pytest.raises(FileError, match="holds files and is no report"):
        StudySite(tmp_path)
    assert (tmp_path / "index.html").read_text() == "mine"
    with pytest.raises(FileError, match="is a file"):
        StudySite(tmp_path / "index.html")


def test_a_report_of_another_kind_is_refused(tmp_path: Path) -> None:
    (tmp_path / "report.json").write_text('{"schema": "clamber-report-1", "kind": "climb"}')
    with pytest.raises(FileError, match="of the kind 'climb'"):
        StudySite(tmp_path)
    for words in ("[]", "{", '{"schema": "other", "kind": "studies"}', '{"schema": "clamber-report-1"}', "[" * 100_000):
        (tmp_path / "report.json").write_text(words)
        with pytest.raises(FileError, match="does not say schema"):
            StudySite(tmp_path)


@pytest.mark.parametrize("file", ["../../secret.png", "/etc/x.png", "a.html", 'a".png'])
def test_a_stored_result_that_names_files_elsewhere_is_refused(tmp_path: Path, file: str) -> None:
    StudySite(tmp_path).add(made(), time.perf_counter())
    path = tmp_path / "bevly-1997" / "ladder-plan.json"
    data = json.loads(path.read_text())
    data["figures"][0]["file"] = file
    path.write_text(json.dumps(data))
    with pytest.raises(FileError, match=r"figures\.0\.file"):
        read_result(path)


def test_seeds_are_told_in_words() -> None:
    words = [seeds_in_words(seeds) for seeds in (range(0), range(20), range(19, 20))]
    assert words == ["none: nothing is drawn", "0 to 19", "19"]
    assert set(TITLES) == set(STUDIES)
