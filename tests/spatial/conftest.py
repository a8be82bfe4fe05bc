"""The family in space, until it has tasks and so a place among those that come with Clamber."""

import pytest

from clamber import family


@pytest.fixture
def spatial(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(family.BUILT_IN, "spatial", "clamber.families.spatial.family:SPATIAL")  # type: ignore[misc]
