"""What phases leave of the plate: fades without a jump, and heights within the room of a step."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from spring_walks import ROBOT

from clamber.families.walker.control.gait import Limits, room_at
from clamber.families.walker.execution.free_base_freedoms import FADE, FreeBaseFreedoms, open_share

PERIOD = 0.02


@given(st.floats(0.1, 60.0))
def test_a_freedom_is_faded_in_and_out_without_a_jump_of_weight_or_rate(seconds: float) -> None:
    times = np.linspace(0.0, seconds, 2001)
    shares = np.array([open_share(float(time), float(seconds - time)) for time in times])
    assert shares[0] == shares[-1] == 0.0
    assert ((shares >= 0.0) & (shares <= 1.0)).all()
    gap = times[1]
    rates = np.diff(shares) / gap
    assert np.abs(rates).max() <= 15.0 / 8.0 / FADE + 1e-6  # of a quintic from rest to rest, the other factor at most 1
    # its largest second derivative is 10 / sqrt(3) a square of the fade; where both factors change, twice their slopes' product more
    bend = (2.0 * 10.0 / np.sqrt(3.0) + 2.0 * (15.0 / 8.0) ** 2) / FADE**2
    assert np.abs(np.diff(rates)).max() <= bend * gap + 1e-9
    assert abs(rates[0]) <= bend * gap
    assert abs(rates[-1]) <= bend * gap
    np.testing.assert_allclose(shares, shares[::-1], atol=1e-12)


def test_a_long_phase_leaves_the_freedom_whole_in_its_middle() -> None:
    assert open_share(FADE, FADE) == 1.0
    assert open_share(5.0, FADE) == 1.0
    assert open_share(0.5 * FADE, 5.0) == pytest.approx(0.5)


@given(st.floats(0.3, 0.4), st.floats(0.0, 0.06), st.floats(-0.1, 0.1))
def test_a_wish_is_granted_as_far_as_the_legs_have_room(own: float, room: float, wish: float) -> None:
    lowest, highest = own - 0.2 * room, own + 0.8 * room
    plate = FreeBaseFreedoms()
    height = plate.hold(own, lowest, highest, wish)
    assert lowest <= height <= highest
    assert plate.raised == pytest.approx(height - own, abs=1e-15)
    if lowest <= own + wish <= highest:
        assert height == own + wish
    else:
        assert height in (lowest, highest)


def test_frames_beside_each_other_make_shorter_steps() -> None:
    """What a plate would cost that lands 30 mm nearer to a point at its left, while the other frame keeps to the way."""
    lengths = {}
    for aside in (0.0, -0.03):
        along = np.linspace(-0.1, 0.1, 2001)
        places = np.column_stack([along, np.full(2001, aside), np.zeros(2001)])
        lengths[aside] = float(np.ptp(along[room_at(ROBOT, places, Limits()) >= 0.0]))
    assert lengths[0.0] == pytest.approx(0.133, abs=5e-4)
    assert lengths[-0.03] == pytest.approx(0.103, abs=5e-4)


def test_without_room_the_plate_is_as_walking_has_it() -> None:
    plate = FreeBaseFreedoms()
    assert plate.hold(0.35, 0.36, 0.34, 0.02) == 0.35
    assert (plate.lowest, plate.highest, plate.raised) == (0.35, 0.35, 0.0)
