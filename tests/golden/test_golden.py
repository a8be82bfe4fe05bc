"""The figures of the golden commands are those of before."""

import json

import pytest
from outputs import HERE, commands, digest, frozen_outputs


@pytest.mark.slow
def test_no_figure_has_changed() -> None:
    hashes = json.loads((HERE / "hashes.json").read_text())
    assert list(hashes) == commands()
    differ = [line for line, text in frozen_outputs() if digest(text) != hashes[line]]
    assert not differ, "python tests/golden/outputs.py --keep FOLDER, in this tree and the one before, shows what"
