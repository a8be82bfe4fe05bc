"""Every result of every study has a test that computes its verdict, and expects the one that its page tells."""

from pathlib import Path

import pytest
import test_bevly_body
import test_bevly_claims
import test_bevly_control
import test_bevly_limb
import test_boards_exact
import test_hoshino_arm
import test_hoshino_geometry
import test_hoshino_level
import test_hoshino_walking
import test_studies

from clamber.studies.library import STUDIES

PAGES = Path(__file__).resolve().parents[2] / "docs" / "studies"
TABLES = {
    "bevly-1997": (
        test_studies.QUICK,
        test_studies.LONG,
        test_bevly_limb.FIGURES,
        test_bevly_claims.VERDICTS,
        test_bevly_body.QUICK,
        test_bevly_body.LONG,
        test_bevly_control.VERDICTS,
        test_bevly_control.LONG,
    ),
    "boards-exact": (test_boards_exact.VERDICTS,),
    "hoshino-1995": (
        test_hoshino_geometry.VERDICTS,
        test_hoshino_level.VERDICTS,
        test_hoshino_walking.VERDICTS,
        test_hoshino_arm.VERDICTS,
        test_hoshino_arm.OF_THE_MEASURE,
    ),
}
"""Study -> tables of result and verdict, each of whose rows a test computes."""


@pytest.mark.parametrize("study", STUDIES)
def test_every_result_of_a_study_has_one_expected_verdict(study: str) -> None:
    assert sorted(name for table in TABLES[study] for name in table) == sorted(STUDIES[study])


@pytest.mark.parametrize("study", STUDIES)
def test_expected_verdicts_are_those_of_the_pages(study: str) -> None:
    expected = {name: verdict for table in TABLES[study] for name, verdict in table.items()}
    heads = {name: (PAGES / study / f"{name}.md").read_text(encoding="utf-8").partition("\n")[0] for name in expected}
    assert heads == {name: f"# {name}: {verdict}" for name, verdict in expected.items()}
