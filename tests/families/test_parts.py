"""What a family says of where its parts are is true."""

import pytest

from clamber.family import BUILT_IN, Part, family_named


@pytest.mark.parametrize("name", BUILT_IN)
def test_every_part_that_a_family_names_is_one_and_is_there(name: str) -> None:
    family = family_named(name)
    parts = {part for kind in type(family).__mro__ for part, value in vars(kind).items() if isinstance(value, Part)}
    assert set(family.parts) <= parts
    assert all(getattr(family, part) is not None for part in family.parts)
