"""The benchmark of cooperative motion measures what it says; how fast, only the benchmark itself tells."""

import numpy as np
import pytest

from clamber.benchmarks.benches import BENCHES, hexapod_rows, peer_rows, reach_rows, step_rows, walker
from clamber.benchmarks.control_speed import installed
from clamber.families.walker.control.cooperative.limits import chain_of
from clamber.families.walker.control.cooperative.scratch import make_scratch, see_tool
from clamber.families.walker.control.cooperative.settings import own_speeds
from clamber.families.walker.trials.cooperative.chain_peers import CHAIN_PEERS, PERIOD

POSTURES = np.array(
    [
        [0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.2, 1.1, -1.0, -0.9],
        [0.02, -0.01, 0.38, 0.3, -0.1, 0.05, 1.2, 0.6, -0.4, 0.5],
    ]
)


def test_the_benchmark_is_found_by_its_name() -> None:
    assert BENCHES["hexapod"] is hexapod_rows


@pytest.mark.slow
def test_a_step_is_timed_for_every_set_of_freedoms() -> None:
    rows = step_rows(rounds=1, steps=20)
    aimed = [row for row in rows if row.aim is not None]
    assert [row.aim for row in aimed] == ["< 150"] * 4
    assert all(row.value > 0.0 and row.unit == "us" for row in rows)


def test_peers_and_searches_have_their_rows() -> None:
    assert {row.unit for row in peer_rows(rounds=1, steps=5)} <= {"us", "ratio"}
    assert all(row.value > 0.0 for row in reach_rows(rounds=1))


@pytest.mark.parametrize("limited", [False, True])
@pytest.mark.parametrize("peer", CHAIN_PEERS)
def test_a_peer_moves_the_same_tool(peer: str, limited: bool) -> None:
    """Its rates bring the tool, by our Jacobian, where it was asked to; so its chain is ours."""
    if not installed(peer):
        pytest.skip(f"{peer} comes with the extra `bench`")
    robot = walker()
    tick = CHAIN_PEERS[peer](robot, own_speeds(robot), limited=limited)
    w = make_scratch(4)
    for q in POSTURES:
        see_tool(chain_of(robot, balance=0.0), q, w)
        way = np.array([2e-5, -1e-5, 1.5e-5])
        rates = tick(q, w.place + way)
        np.testing.assert_allclose(w.jacobian @ rates * PERIOD, way, rtol=2e-3, atol=1e-9)
