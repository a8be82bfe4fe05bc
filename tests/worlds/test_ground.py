"""Grounds: their exact heights against closed forms, a plain reading of the blocks, and rays through MuJoCo's boxes."""

import math
from pathlib import Path

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from clamber.errors import SpecError
from clamber.families.walker.sim.walker_model import add_ground
from clamber.families.walker.world.ground import Block, Ground, Rough, build_ground, ground_names, load_ground
from clamber.files import Document

RECTANGLES = st.lists(
    st.tuples(st.integers(-12, 11), st.integers(1, 8), st.integers(-12, 11), st.integers(1, 8), st.integers(-3, 3)),
    max_size=6,
)


def ground_of(rectangles: list[tuple[int, ...]], **keys: float) -> Ground:
    """Blocks on a grid of 0.1 m, some of which stick out of the ground's ends."""
    blocks = tuple(
        Block(x_min=x / 10, x_max=(x + wide) / 10, y_min=y / 10, y_max=(y + deep) / 10, height=top / 100)
        for x, wide, y, deep, top in rectangles
    )
    return Ground(name="made", blocks=blocks, x_min=-1.0, x_max=1.0, y_min=-1.0, y_max=1.0, **keys)


@pytest.mark.parametrize("slope", [0.0, 10.0, 25.0])
@pytest.mark.parametrize("uphill", [0.0, 90.0, 180.0, 33.0])
def test_a_slope_is_a_plane_through_the_origin(slope: float, uphill: float) -> None:
    ground = Ground(name="plane", slope=math.radians(slope), uphill=math.radians(uphill))
    places = np.random.default_rng(0).uniform(-3.0, 3.0, (50, 2))
    along = places @ np.array((math.cos(math.radians(uphill)), math.sin(math.radians(uphill))))
    np.testing.assert_allclose(ground.heights(places), math.tan(math.radians(slope)) * along, atol=1e-12)
    assert len(ground.tiles()) == 1


@given(rectangles=RECTANGLES, seed=st.integers(0, 100))
@settings(max_examples=60, deadline=None)
def test_a_place_is_as_high_as_the_last_block_that_covers_it(rectangles: list[tuple[int, ...]], seed: int) -> None:
    ground = ground_of(rectangles)
    places = np.random.default_rng(seed).uniform(-0.999, 0.999, (40, 2))
    wanted = np.zeros(len(places))
    for block in ground.blocks:
        x, y = places.T
        wanted[(block.x_min < x) & (x < block.x_max) & (block.y_min < y) & (y < block.y_max)] = block.height
    np.testing.assert_allclose(ground.heights(places), wanted, atol=1e-12)


@given(rectangles=RECTANGLES)
@settings(max_examples=60, deadline=None)
def test_bricks_fill_the_ground_without_overlap(rectangles: list[tuple[int, ...]]) -> None:
    tiles = ground_of(rectangles).tiles()
    areas = (tiles[:, 1] - tiles[:, 0]) * (tiles[:, 3] - tiles[:, 2])
    assert (areas > 0.0).all()
    assert areas.sum() == pytest.approx(4.0)
    for i, one in enumerate(tiles):
        for other in tiles[:i]:
            wide = min(one[1], other[1]) - max(one[0], other[0])
            deep = min(one[3], other[3]) - max(one[2], other[2])
            assert min(wide, deep) < 1e-12


@pytest.mark.parametrize("seed", range(4))
def test_heights_are_where_rays_from_above_meet_the_bricks(seed: int) -> None:
    rng = np.random.default_rng(seed)
    blocks = rng.integers((-8, 1, -8, 1, -9), (8, 6, 8, 6, 9), (5, 5)).tolist()
    ground = ground_of(blocks, slope=rng.uniform(0.0, 0.4), uphill=rng.uniform(-3.0, 3.0), depth=0.5)
    spec = mujoco.MjSpec()
    add_ground(mujoco, spec, ground, 0.5)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    places = rng.uniform(-0.8, 0.8, (300, 2))
    met = np.zeros(1, np.int32)
    for (x, y), height in zip(places, ground.heights(places), strict=True):
        way = mujoco.mj_ray(model, data, np.array((x, y, 3.0)), np.array((0.0, 0.0, -1.0)), None, 1, -1, met)
        assert way >= 0.0
        assert height == pytest.approx(3.0 - way, abs=1e-9)


def test_a_ditch_in_a_slope_has_walls_that_are_right_angled_to_it() -> None:
    slope, deep = math.radians(20.0), 0.3
    ditch = Block(x_min=0.2, x_max=0.5, y_min=-1.0, y_max=1.0, height=-deep)
    ground = Ground(name="ditch", slope=slope, blocks=(ditch,))
    # the upper wall leans over the ditch: seen from above it ends at 0.5 cos, its foot at 0.5 cos + deep sin
    edge = 0.5 * math.cos(slope)
    assert ground.heights((edge + 1e-6, 0.0)) == pytest.approx(0.5 * math.sin(slope), abs=1e-5)
    bottom = (0.3 * math.cos(slope) + deep * math.sin(slope), 0.0)
    assert ground.heights(bottom) == pytest.approx(0.3 * math.sin(slope) - deep * math.cos(slope))


def test_there_is_nothing_beyond_the_ends() -> None:
    ground = Ground(name="small", x_min=-0.1, x_max=0.1)
    np.testing.assert_array_equal(ground.heights([(0.11, 0.0), (-0.2, 0.0)]), -np.inf)
    assert ground.heights(np.zeros((2, 3, 2))).shape == (2, 3)


def test_rough_tiles_are_drawn_evenly_from_their_seed() -> None:
    patch = Rough(x_min=0.0, x_max=4.05, y_min=0.0, y_max=4.0, tile=0.1, height=0.02, seed=3)
    heights = np.array([block.height for block in patch.blocks()])
    assert len(heights) == 41 * 40
    assert patch.blocks()[-1].x_max == 4.05
    assert np.abs(heights).max() <= 0.02
    # variance of even numbers, within four standard errors of it
    assert heights.var() == pytest.approx(0.02**2 / 3.0, rel=4 * math.sqrt(0.8 / len(heights)))
    assert heights.tolist() == [block.height for block in patch.blocks()]


@pytest.mark.parametrize("name", ground_names())
def test_every_shipped_ground_can_be_stood_on_where_walks_begin(name: str) -> None:
    places = np.random.default_rng(1).uniform(-0.5, 0.5, (100, 2))
    assert np.isfinite(load_ground(name).heights(places)).all()


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"slope": "70 deg"}, "slope"),
        ({"x_min": "11 m"}, "x_min.*less than x_max"),
        ({"blocks": [{"x_min": "1 m", "x_max": "1 m", "y_min": "0 m", "y_max": "1 m", "height": "0 m"}]}, "blocks.0.x_min"),
        ({"blocks": [{"x_min": "0 m", "x_max": "1 m", "y_min": "0 m", "y_max": "1 m", "height": "-2 m"}]}, "bottom"),
        ({"rough": [{"x_min": "0 m", "x_max": "9 m", "y_min": "0 m", "y_max": "9 m", "tile": "1 mm", "height": "0 m"}]}, "tiles"),
        ({"friction": 0}, "friction"),
        ({"stones": 3}, "unknown key"),
    ],
)  # fmt: skip
def test_bad_grounds_are_named(keys: dict[str, object], words: str, tmp_path: Path) -> None:
    with pytest.raises(SpecError, match=words):
        build_ground(Document("my.toml", {"schema": "clamber-ground-1", "name": "mine"} | keys))
