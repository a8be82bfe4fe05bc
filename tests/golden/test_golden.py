"""The figures of the golden commands are those of before."""

import json

import pytest
from outputs import HERE, commands, digest, frozen_outputs


def test_every_command_has_a_figure_to_keep() -> None:
    assert list(json.loads((HERE / "hashes.json").read_text())) == commands()


@pytest.mark.long
def test_no_figure_has_changed() -> None:
    hashes = json.loads((HERE / "hashes.json").read_text())
    differ = [line for line, text in frozen_outputs() if digest(text) != hashes[line]]
    assert not differ, "python tests/golden/outputs.py --keep FOLDER, in this tree and the one before, shows what"
