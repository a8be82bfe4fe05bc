"""Contacts: every polytope lies within the exact body of its kind, and covers most of it."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linprog

from clamber.errors import SpecError
from clamber.families.spatial.robot.contact_kinds import (
    KINDS,
    AreaFoot,
    Hook,
    Magnet,
    Spine,
    Suction,
    build_contact,
    contact_names,
    read_contact,
)
from clamber.families.spatial.robot.contacts import Contact
from clamber.files import Document
from clamber.types import Floats

PUSH = 3.0
"""Largest normal force [N] that cones are cut at, so that they have a support in every direction."""
Support = Callable[[Floats], float]


def shipped(name: str) -> Contact:
    return build_contact(read_contact(name)).contact()


def support(contact: Contact, direction: Floats, most: float) -> float:
    """Largest direction . wrench of a contact's polytope with at most the normal force `most`."""
    n = contact.components
    matrix, bound = contact.polytope(math.inf, math.inf)
    matrix = np.vstack([matrix[:, :n], np.eye(6)[0, :n]])
    found = linprog(-direction[:n], matrix, [*bound, most], bounds=(None, None), method="highs")
    assert found.status == 0
    return -float(found.fun)


def cone_support(mu: float, pull: float, most: float) -> Support:
    """Of a friction cone with its apex at minus the pull."""

    def of(d: Floats) -> float:
        across = mu * (most + pull) * math.hypot(d[1], d[2])
        return max(-d[0] * pull, d[0] * most + across)

    return of


def pad_support(mu: float, pull: float, most: float, halves: tuple[float, float]) -> Support:
    """Of all pressures and frictions on a rectangle that pulls at its middle: those of single forces at its corners."""

    def of(d: Floats) -> float:
        load = most + pull
        corners = [
            mu * math.hypot(d[1] - d[3] * y, d[2] + d[3] * x) + d[4] * y - d[5] * x + d[0]
            for x in (halves[0], -halves[0])
            for y in (halves[1], -halves[1])
        ]
        return max(0.0, load * max(corners)) - d[0] * pull

    return of


def clamp_support(clamp: Contact, bending: float, twisting: float, press: float) -> Support:
    force = cone_support(clamp.friction, clamp.pull, press)
    return lambda d: force(d) + bending * math.hypot(d[4], d[5]) + twisting * abs(d[3])


def hook_support(mu: float, opening: float, strength: float, most: float) -> Support:
    """Of a hook: forces as long as its strength or `most` lets each direction be, by many directions."""
    found = [np.zeros(3)]
    for angle in np.linspace(-opening, opening, 2001):
        for slide in (-mu, 0.0, mu):
            direction = np.array([1.0, slide, math.tan(angle)])
            found.append(direction * min(most, strength / float(np.linalg.norm(direction))))
    points = np.array(found)
    return lambda d: float((points @ d[:3]).max())


def spine_support(mu: float, angle: float, strength: float, most: float) -> Support:
    """Of spines: corners where they are drawn, a half disc of friction where they are not."""
    corners = [np.zeros(3)]
    for n in (-strength * math.tan(angle), most):
        held = n + strength * math.tan(angle)
        corners += [np.array([n, strength, sign * mu * held]) for sign in (1.0, -1.0)]

    def of(d: Floats) -> float:
        rubbing = d[0] * most + mu * most * (math.hypot(d[1], d[2]) if d[1] < 0.0 else abs(d[2]))
        return max(rubbing, *(float(corner @ d[:3]) for corner in corners))

    return of


def exact(name: str) -> tuple[Support, float]:
    """Support of the exact body of a shipped contact, and the normal force that it is cut at."""
    kind = build_contact(read_contact(name))
    contact = kind.contact()
    mu, pull = contact.friction, contact.pull
    most = max(PUSH, 0.5 * pull)
    if isinstance(kind, AreaFoot):
        return pad_support(mu, 0.0, most, (kind.length / 2, kind.width / 2)), most
    if kind.kind == "clamp":
        return clamp_support(contact, kind.bending, kind.twisting, most), most
    if isinstance(kind, Hook):
        return hook_support(mu, kind.opening, pull, 1.5 * pull), 1.5 * pull
    if isinstance(kind, Spine):
        return spine_support(mu, kind.angle, pull, most), most
    return cone_support(mu, pull, most), most


@pytest.mark.slow
@pytest.mark.parametrize("name", contact_names())
def test_a_polytope_lies_within_its_exact_body_and_covers_most_of_it(name: str) -> None:
    contact = shipped(name)
    of, most = exact(name)
    rng = np.random.default_rng(7)
    scale = np.array([1.0, 1.0, 1.0, 30.0, 30.0, 30.0])
    shares = []
    for _ in range(300):
        direction = rng.normal(size=6) * scale
        direction[contact.components :] = 0.0
        inside, body = support(contact, direction, most), of(direction)
        assert inside <= body + 1e-7 * most * float(np.linalg.norm(direction))
        widths = inside + support(contact, -direction, most), body + of(-direction)
        shares.append(widths[0] / widths[1])
    print(f"{name}: {len(contact.rows)} rows, width {np.mean(shares):.3f} of the exact one, least {np.min(shares):.3f}")
    assert np.mean(shares) > 0.95


def test_pads_that_pull_and_have_no_ankle_are_as_safe() -> None:
    magnet = build_contact(read_contact("magnet"))
    assert isinstance(magnet, Magnet)
    contact = replace(magnet, ankle=False, half_tilt=0.1).contact()
    assert contact.components == 6 and contact.aligned and contact.tilt_loss == 5.0
    side = magnet.radius / math.sqrt(2.0)
    of = pad_support(contact.friction, contact.pull, 100.0, (side, side))
    rng = np.random.default_rng(8)
    for _ in range(200):
        direction = rng.normal(size=6) * [1.0, 1.0, 1.0, 30.0, 30.0, 30.0]
        assert support(contact, direction, 100.0) <= of(direction) + 1e-6 * float(np.linalg.norm(direction))


def test_a_gap_takes_a_magnets_pull_and_a_safety_factor_a_cups() -> None:
    magnet, cup = build_contact(read_contact("magnet")), build_contact(read_contact("suction"))
    assert isinstance(magnet, Magnet) and isinstance(cup, Suction)
    pulls = [replace(magnet, gap=gap).contact().pull for gap in (0.0, magnet.quarter_gap, 3.0 * magnet.quarter_gap)]
    assert pulls == pytest.approx([magnet.pull, magnet.pull / 4.0, magnet.pull / 16.0])
    assert cup.contact().pull == pytest.approx(60e3 * math.pi * 0.03**2 / 2.0)


def test_a_weak_hold_makes_the_polytope_smaller() -> None:
    contact = shipped("gripper")
    rng = np.random.default_rng(9)
    whole, bound = contact.polytope(math.inf, math.inf)
    weak, weak_bound = contact.polytope(0.4, 3.0)
    points = rng.uniform(-10.0, 10.0, (20_000, 6))
    fits = np.all(points @ whole.T <= bound, axis=1)
    fits_weak = np.all(points @ weak.T <= weak_bound, axis=1)
    assert 0 < fits_weak.sum() < fits.sum()
    assert not np.any(fits_weak & ~fits)


def test_every_kind_is_shipped_and_every_number_has_its_source() -> None:
    assert {build_contact(read_contact(name)).kind for name in contact_names()} == set(KINDS)
    for name in contact_names():
        for key, value in read_contact(name).data.items():
            if isinstance(value, dict):
                assert value["source"], f"{name}.{key}"


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"kind": "glue"}, "must be one of|clamp"),
        ({"pull": "9 kg"}, "is no unit of force"),
        ({"pul": "9 N"}, "unknown key"),
    ],
)
def test_what_is_wrong_in_a_file_is_named(change: dict[str, object], words: str) -> None:
    document = read_contact("gripper")
    with pytest.raises(SpecError, match=words):
        build_contact(Document("mine.toml", {**document.data, **change}))
