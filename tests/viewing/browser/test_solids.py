"""Solids are closed, face outwards, and have the volume that they should; quaternions turn as they say."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.families.climber.pictures.space import TURN, in_space, on_wall, turned
from clamber.types import Floats
from clamber.viewing.browser.solids import SIDES, Mesh, along_z, ball, prism, rod

NGON = 0.5 * SIDES * math.sin(math.tau / SIDES)  # area of the polygon that stands for a circle of radius 1


def volume(mesh: Mesh) -> float:
    """By the divergence theorem: positive where faces look outwards."""
    a, b, c = (mesh[0][mesh[1][:, k]] for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum()) / 6.0


def rotated(wxyz: Floats | tuple[float, ...], v: Floats) -> Floats:
    """A vector turned by a quaternion, as q v q* says."""
    w, u = wxyz[0], np.array(wxyz[1:])
    return v + 2.0 * np.cross(u, np.cross(u, v) + w * v)


def edges_are_shared(mesh: Mesh) -> bool:
    """Whether every edge is run along once in each direction, where corners at one place count as one."""
    _, same = np.unique(np.round(mesh[0], 9), axis=0, return_inverse=True)
    faces = same.ravel()[mesh[1]]
    ways: dict[tuple[int, int], int] = {}
    for a, b in np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).tolist():
        if a != b:
            ways[a, b] = ways.get((a, b), 0) + 1
    return all(count == ways.get((b, a), 0) for (a, b), count in ways.items())


def test_rod_is_a_cylinder_of_many_sides() -> None:
    assert volume(rod()) == pytest.approx(NGON)
    assert edges_are_shared(rod())


def test_ball_is_nearly_a_ball() -> None:
    assert volume(ball()) == pytest.approx(4.0 / 3.0 * math.pi, rel=0.05)
    assert np.linalg.norm(ball()[0], axis=1) == pytest.approx(1.0)
    assert edges_are_shared(ball())


@pytest.mark.parametrize(
    ("outline", "area"),
    [
        (((0, 0), (2, 0), (2, 1), (0, 1)), 2.0),
        (((0, 1), (2, 1), (2, 0), (0, 0)), 2.0),  # clockwise
        (((0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)), 5.0),  # an L
    ],
)
def test_prism_has_the_volume_of_its_outline(outline: tuple[tuple[int, int], ...], area: float) -> None:
    mesh = prism(np.array(outline, float), -0.5, 1.0)
    assert volume(mesh) == pytest.approx(1.5 * area)
    assert edges_are_shared(mesh)


@given(st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: math.hypot(*v) > 1e-3))
def test_z_is_turned_into_any_direction(way: tuple[float, float, float]) -> None:
    (turn,) = along_z(np.array([way]))
    assert np.linalg.norm(turn) == pytest.approx(1.0)
    assert rotated(turn, np.array((0.0, 0.0, 1.0))) == pytest.approx(np.array(way) / math.hypot(*way), abs=1e-6)


@given(st.floats(-7.0, 7.0), st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))
def test_bodies_turn_on_the_wall_as_their_points_do(angle: float, x: float, y: float) -> None:
    on_body = complex(x, y) * complex(math.cos(angle), math.sin(angle))
    there = in_space(np.array((on_body.real, on_body.imag)), 0.3)
    assert rotated(turned(angle), np.array((x, y, 0.3))) == pytest.approx(there, abs=1e-9)
    assert turned(0.0) == pytest.approx(TURN)
    assert on_wall(there) == pytest.approx((on_body.real, on_body.imag))
