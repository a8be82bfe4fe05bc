"""Errata on docs/papers.md: the printed form and the right one computed beside what is true, found without either of them.

Each case gives three values: what is printed, what the page says instead, and the truth from first principles (numerical derivatives of
places, sums of forces and moments, a limb put together from its joints). The right form must agree with the truth, the printed one not.
"""

import math
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from clamber.families.climber.robot.robot import LimbedRobot
from clamber.studies.bevly_1997.printed_plans import limbed_task, replay_printed
from clamber.studies.library import STUDIES
from clamber.tasks.robots import load_robot
from clamber.units import INCH

PAGE = Path(__file__).parents[2] / "docs" / "papers.md"
A = npt.NDArray[np.float64]
L1, L2, L3 = 0.156, 0.155, 0.005
WEIGHT = 40.0
SMALL = 1e-5
Case = Callable[[np.random.Generator], tuple[object, object, object]]


def tip(q: A) -> A:
    """End point of a limb without its hook's offset, port frame [m]."""
    return np.array((L1 * np.cos(q[0]) + L2 * np.cos(q.sum()), L1 * np.sin(q[0]) + L2 * np.sin(q.sum())))


def jacobian(q: A) -> A:
    """By central differences [m]."""
    steps = SMALL * np.eye(2)
    return np.column_stack([(tip(q + d) - tip(q - d)) / (2.0 * SMALL) for d in steps])


def jacobian_rate(q: A, w: A) -> A:
    """Rate of the Jacobian along joint speeds, by central differences [m/s]."""
    return (jacobian(q + SMALL * w) - jacobian(q - SMALL * w)) / (2.0 * SMALL)


def acceleration(q: A, w: A, a: A) -> A:
    """Of the end point, by central differences of the fourth order of its place along a motion [m/s^2]."""
    h = 1e-3

    def place(t: float) -> A:
        return tip(q + t * w + 0.5 * t * t * a)

    near, far = place(h) + place(-h), place(2.0 * h) + place(-2.0 * h)
    return (16.0 * near - far - 30.0 * place(0.0)) / (12.0 * h * h)


def posture(rng: np.random.Generator) -> tuple[A, A, A, A, A, A]:
    """Joint angles [rad] and speeds [rad/s], inertia matrix, h and g, and torques."""
    q = np.array((rng.uniform(-1.0, 1.0), rng.choice((-1.0, 1.0)) * rng.uniform(0.6, 1.6)))
    root = rng.normal(size=(2, 2)) * 0.3 + np.eye(2)
    return q, rng.normal(size=2) * 2.0, root @ root.T, rng.normal(size=2), rng.normal(size=2), rng.normal(size=2) * 5.0


def legs(rng: np.random.Generator) -> tuple[A, A]:
    """Two pegs from the body's centre, one on either side [m]."""
    return np.array((rng.uniform(0.1, 0.3), rng.uniform(-0.2, 0.3))), np.array(
        (rng.uniform(-0.3, -0.1), rng.uniform(-0.2, 0.3))
    )


def wrench(r1: A, r2: A, forces: A) -> A:
    """Sum of forces and moment about the body's centre of forces (x1, y1, x2, y2) at two pegs [N], [N m]."""
    moment = r1[0] * forces[1] - r1[1] * forces[0] + r2[0] * forces[3] - r2[1] * forces[2]
    return np.array((forces[0] + forces[2], forces[1] + forces[3], moment))


def eq_2_12(rng: np.random.Generator) -> tuple[object, object, object]:
    """Vertical force on leg 2, from the sums of vertical forces and of moments, 2.10 and 2.11."""
    r1, r2 = legs(rng)
    wide = r1[0] - r2[0]
    true = np.linalg.solve(np.array(((1.0, 1.0), (r1[0], r2[0]))), (WEIGHT, 0.0))[1]
    return WEIGHT / wide, WEIGHT * r1[0] / wide, true


def eq_2_15(rng: np.random.Generator) -> tuple[object, object, object]:
    """Forces with leg 1 straight above the centre: the tangent's row has no value there, the row (r_y1, -r_x1) has."""
    r1, r2 = np.array((0.0, rng.uniform(0.1, 0.3))), np.array((rng.uniform(0.1, 0.3), rng.uniform(-0.3, 0.3)))
    sums = np.array([[1, 0, 1, 0], [0, 1, 0, 1], [-r1[1], r1[0], -r2[1], r2[0]]])
    given = np.array((0.0, WEIGHT, 0.0, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        row = np.array([r1[1] / r1[0], -1.0, 0.0, 0.0])
    printed = np.linalg.solve(np.vstack([sums, row]), given) if np.isfinite(row).all() else np.full(4, np.nan)
    right = np.linalg.solve(np.vstack([sums, [r1[1], -r1[0], 0.0, 0.0]]), given)
    # leg 1 alone is above the centre, so it carries all and leg 2, which is not, nothing
    return printed, right, np.array((0.0, WEIGHT, 0.0, 0.0))


def eq_3_4(rng: np.random.Generator) -> tuple[object, object, object]:
    q, w, *_ = posture(rng)
    true = jacobian(q)
    printed = np.array([[true[0, 0], true[1, 1]], [true[0, 0], true[1, 1]]])  # [[dx/d1, dy/d2], [dx/d1, dy/d2]]
    h = 1e-6
    return printed @ w, true @ w, (tip(q + h * w) - tip(q - h * w)) / (2.0 * h)


def eq_3_8(rng: np.random.Generator) -> tuple[object, object, object]:
    q, w, inertia, h, g, torque = posture(rng)
    a = np.linalg.solve(inertia, torque - h - g)
    j = jacobian(q)
    return j @ a + j @ w, j @ a + jacobian_rate(q, w) @ w, acceleration(q, w, a)


def eq_3_11(rng: np.random.Generator) -> tuple[object, object, object]:
    q, w, inertia, h, g, torque = posture(rng)
    at = acceleration(q, w, np.linalg.solve(inertia, torque - h - g))
    j = jacobian(q)
    back = np.linalg.inv(j)
    mass = back.T @ inertia @ back
    rest = mass @ at + back.T @ h + back.T @ g
    # the force that does the torques' work at the end point: J^T F = tau
    return rest - mass @ j @ w, rest - mass @ jacobian_rate(q, w) @ w, np.linalg.solve(j.T, torque)


def eq_3_13(rng: np.random.Generator) -> tuple[object, object, object]:
    q, w, inertia, h, g, asked = posture(rng)
    j, rate = jacobian(q), jacobian_rate(q, w)

    def comes(term: A) -> A:
        torque = inertia @ np.linalg.solve(j, asked - term) + h + g
        return acceleration(q, w, np.linalg.solve(inertia, torque - h - g))

    return comes(rate @ q), comes(rate @ w), asked


def eq_3_26(rng: np.random.Generator) -> tuple[object, object, object]:
    """Direction in which the end point starts from rest under K' J^-1 a, the joints' inertias as the squares of their gears."""
    q, _, _, _, _, asked = posture(rng)
    j, n = jacobian(q), np.array((574.0, 792.0))
    inertia = np.diag(rng.uniform(1e-7, 1e-5) * n**2)

    def starts(weights: A) -> A:
        way = acceleration(q, np.zeros(2), np.linalg.solve(inertia, weights @ np.linalg.solve(j, asked)))
        return way / np.hypot(*way)

    same = (n[0] / n[1]) ** 2
    return starts(np.diag((same, same))), starts(np.diag((same, 1.0))), asked / np.hypot(*asked)


def table_3_1(rng: np.random.Generator) -> tuple[object, object, object]:
    """Ratio of the joints' inertias at the output: 3.26 takes I N^2, but the table's I has N^2 in it already."""
    n1, n2, i1, i2 = 574.0, 792.0, 0.4020, 0.7652
    motor = rng.uniform(1e-7, 1e-5)  # the same for all joints, as the thesis says; the table has four digits
    return round(i1 * n1**2 / (i2 * n2**2), 3), round(i1 / i2, 3), round(motor * n1**2 / (motor * n2**2), 3)


def eq_3_28(rng: np.random.Generator) -> tuple[object, object, object]:
    """Whether a joint that moves without torque slows down."""
    inertia, d, friction = rng.uniform(0.3, 0.8), rng.uniform(0.2, 1.2), rng.uniform(0.1, 0.7)
    speed = rng.uniform(0.1, 2.0)
    printed = (0.0 + d * speed + friction) / inertia
    right = (0.0 - d * speed - friction) / inertia
    return printed < 0.0, right < 0.0, True  # friction takes work out of a joint that moves


def eq_4_8(rng: np.random.Generator) -> tuple[object, object, object]:
    """Wrench of the legs' shares of a desired wrench, rows x, y and moment of 4.8 to 4.11."""
    r1, r2 = legs(rng)
    asked = rng.normal(size=3)
    wide = r1[0] - r2[0]
    y1 = (asked[2] - r2[0] * asked[1]) / wide
    printed = np.array((-0.5 * asked[0], y1, -0.5 * asked[0], asked[1] - y1))
    return wrench(r1, r2, printed), wrench(r1, r2, shares(r1, r2) @ asked), asked


def shares(r1: A, r2: A) -> A:
    """The right T for forces of the wall on the legs, rows x1, y1, x2, y2."""
    wide, high = r1[0] - r2[0], 0.5 * (r1[1] + r2[1])
    return np.array(
        [[0.5, 0, 0], [high / wide, -r2[0] / wide, 1 / wide], [0.5, 0, 0], [-high / wide, r1[0] / wide, -1 / wide]]
    )


def eq_4_12(rng: np.random.Generator) -> tuple[object, object, object]:
    """Rows 2 and 4 for a wrench without x forces: y force and moment."""
    r1, r2 = legs(rng)
    wide = r1[0] - r2[0]
    printed = np.zeros((4, 3))
    printed[1], printed[3] = (0.0, r1[0] / wide, -1.0 / wide), (0.0, -r2[0] / wide, 1.0 / wide)
    asked = np.array((0.0, *rng.normal(size=2)))
    return wrench(r1, r2, printed @ asked), wrench(r1, r2, shares(r1, r2) @ asked), asked


def eq_4_4(rng: np.random.Generator) -> tuple[object, object, object]:
    """Acceleration of a held tip as the body sees it while it starts to turn: 4.4 takes the T of forces, where motion has r."""
    r1, r2 = legs(rng)
    up = rng.uniform(0.5, 2.0)
    printed = shares(r1, r2) @ np.array((0.0, 0.0, up))
    h = 1e-4

    def seen(t: float) -> A:
        angle = 0.5 * up * t * t
        c, s = math.cos(angle), math.sin(angle)
        return np.array(((c, s), (-s, c))) @ r1  # the peg stays, the body turns

    true = (seen(h) - 2.0 * seen(0.0) + seen(-h)) / (h * h)
    return printed[:2], -up * np.array((-r1[1], r1[0])), true


def eq_4_16(rng: np.random.Generator) -> tuple[object, object, object]:
    """Direction of the hook's offset in the world, from the places of both its ends; of leg 2, whose port is turned by 180 deg."""
    body, port, one, two, hook = rng.uniform(-0.5, 0.5), math.pi, *rng.uniform(-1.0, 1.0, 2), math.pi / 2.0
    turns = np.exp(1j * np.cumsum((body, port, one, two, hook)))
    wrist = L1 * turns[2] + L2 * turns[3]
    end = wrist + L3 * turns[4]
    along = (end - wrist) / abs(end - wrist)
    return np.exp(1j * (body + one + two + hook)), np.exp(1j * (body + port + one + two + hook)), along


def a_inverse(rng: np.random.Generator) -> tuple[object, object, object]:
    q, *_ = posture(rng)
    c1, s1, c2, s2 = math.cos(q[0]), math.sin(q[0]), math.cos(q[1]), math.sin(q[1])
    c12, s12 = math.cos(q.sum()), math.sin(q.sum())

    def inverse(c: float, s: float) -> A:
        top = np.array((c, s)) / (L1 * s2)
        return np.array((top, np.array((-L1 * c1 - L2 * c, -L1 * s1 - L2 * s)) / (L1 * L2 * s2)))

    return inverse(c2, s2), inverse(c12, s12), np.linalg.inv(jacobian(q))


def a_hook(_: np.random.Generator) -> tuple[object, object, object]:
    """Whether the hook of leg 1, its arm level to the right, opens so that it can hang from a peg: its grab direction points down."""
    robot = load_robot("libra")
    assert isinstance(robot, LimbedRobot)
    first, second = robot.limbs[:2]
    down = math.sin(second.port_angle + second.end.angle) < 0.0  # leg 2, printed +90 deg, can
    printed = math.sin(first.port_angle + math.radians(90.0)) < 0.0
    return printed, math.sin(first.port_angle + first.end.angle) < 0.0, down


def b_quadrant(rng: np.random.Generator) -> tuple[object, object, object]:
    """Whether all of 400 poses within the joints' limits come back from their end point."""
    solved = {"tan": True, "atan2": True}
    for _ in range(400):
        q1, q2 = math.radians(rng.uniform(-80.0, 140.0)), math.radians(rng.uniform(-110.0, 110.0))
        x, y = tip(np.array((q1, q2)))
        turn = math.copysign(math.acos((x * x + y * y - L1 * L1 - L2 * L2) / (2.0 * L1 * L2)), q2)
        q, r, t = L1 + L2 * math.cos(turn), -L2 * math.sin(turn), L2 * math.sin(turn)
        c = (y - q * x / r) / (t - q * q / r)
        s = x / r - q * c / r
        for name, angle in (("tan", math.atan(s / c)), ("atan2", math.atan2(s, c))):
            solved[name] &= bool(np.allclose(tip(np.array((angle, turn))), (x, y), atol=1e-9))
    return solved["tan"], solved["atan2"], True


def b_straight(rng: np.random.Generator) -> tuple[object, object, object]:
    """The first joint's angle of a stretched limb: R_1 is 0 there; the angle from sums of Q and T is not undefined."""
    q1 = rng.uniform(-1.0, 1.0)
    x, y = tip(np.array((q1, 0.0)))
    q, r, t = L1 + L2, -0.0, 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        c = np.divide(y - np.divide(q * x, r), t - np.divide(q * q, r))
        s = np.divide(x, r) - np.divide(q * c, r)
    return math.atan2(s, c), math.atan2(y * q - x * t, x * q + y * t), q1


def limb_length(_: np.random.Generator) -> tuple[object, object, object]:
    """Length of a limb [cm]; 4.3.2 says 31."""
    robot = load_robot("libra")
    assert isinstance(robot, LimbedRobot)
    return 32.0, 100.0 * (robot.limbs[0].l1 + robot.limbs[0].l2), 15.6 + 15.5


def a_leg_3(_: np.random.Generator) -> tuple[object, object, object]:
    """Whether the hand-made plan of the H holds, as the thesis says, with leg 3's second link as printed and as we have it."""
    printed, right = (replay_printed("h-hand", overrides).replay.ok for overrides in (("limbs.2.l2=15.0cm",), ()))
    return printed, right, True


def peg_7(_: np.random.Generator) -> tuple[object, object, object]:
    """Place of peg 7 in the H's left column [in]: between pegs 6 and 8, as every other is."""
    y = {hold.number: hold.y / INCH for hold in limbed_task("h").world.holds}
    assert all(y[k] == pytest.approx(0.5 * (y[k - 1] + y[k + 1])) for k in range(2, 6))
    return 26.0, y[7], 0.5 * (y[6] + y[8])


def hoshino_2(_: np.random.Generator) -> tuple[object, object, object]:
    """Directions of the longest step [deg]: six, by the mechanism's symmetry 60 deg apart."""
    every = [float((30 + 60 * n) % 360) for n in (1, -1, 2, -2, 3, -3)]
    return sorted(every), [float((30 + 60 * n) % 360) for n in range(6)], [30.0 + 60.0 * k for k in range(6)]


def hoshino_6(rng: np.random.Generator) -> tuple[object, object, object]:
    """Direction in which a plate with positive beta rises most, against the level part of its normal."""
    beta, gamma = rng.uniform(0.05, 0.4), rng.uniform(-0.4, 0.4)
    normal = np.array((math.sin(beta) * math.cos(gamma), -math.sin(gamma), math.cos(beta) * math.cos(gamma)))
    up = -normal[:2] / np.hypot(*normal[:2])
    printed = math.atan(-math.tan(gamma) / math.sin(beta))
    right = math.atan2(math.tan(gamma) / math.cos(beta), -math.tan(beta))
    return np.exp(1j * printed), np.exp(1j * right), complex(*up)


def hoshino_axes(rng: np.random.Generator) -> tuple[object, object, object]:
    """A plate tilted by beta alone still holds the axis that it turned about: how far x by the text, y by (8), is off the plane of (3)."""
    beta = rng.uniform(0.1, 1.0)

    def off(x: float, y: float) -> float:
        return math.sin(beta) * x - math.sin(0.0) * y

    return off(1.0, 0.0), off(0.0, 1.0), 0.0


def hoshino_12(rng: np.random.Generator) -> tuple[object, object, object]:
    """Whether the pseudo-inverse's rates are told from others, for a velocity out of reach, by a determinant of what is missing (that of
    a column times itself turned), or by its norm."""
    j = np.zeros((3, 10))
    j[:2] = rng.normal(size=(2, 10))
    asked = rng.normal(size=3)
    best = np.linalg.pinv(j) @ asked
    missing = [asked - j @ rates for rates in (best, *(best + rng.normal(size=(50, 10))))]
    determinants = [np.linalg.det(np.outer(one, one)) for one in missing]
    norms = [np.linalg.norm(one) for one in missing]
    return max(determinants) > 1e-9, all(norms[0] < one - 1e-9 for one in norms[1:]), True


def hoshino_15(rng: np.random.Generator) -> tuple[object, object, object]:
    """Whether a vector xi fits (12), whose Jacobian has a column for each component of q in (9)."""
    j = rng.normal(size=(3, 10))
    null = np.eye(10) - np.linalg.pinv(j) @ j

    def fits(components: int) -> bool:
        return null.shape[1] == components and np.shape(null @ rng.normal(size=components)) == (10,)

    return fits(8), fits(10), True


def hoshino_18(rng: np.random.Generator) -> tuple[object, object, object]:
    """Speed of a freedom that is switched off, by a 0 in T_q and by a 0 in T_q^-1."""
    off = np.diag((0.0, *rng.uniform(1.0, 3.0, 9)))
    j = rng.normal(size=(3, 10))
    asked = rng.normal(size=3)
    try:
        rates = np.linalg.inv(off) @ np.linalg.pinv(j @ np.linalg.inv(off)) @ asked
        printed = float(rates[0])
    except np.linalg.LinAlgError:
        printed = math.nan
    return printed, float((off @ np.linalg.pinv(j @ off) @ asked)[0]), 0.0


CASES: dict[str, Case] = {
    "1.2": limb_length,
    "2.12": eq_2_12,
    "2.15, 2.16": eq_2_15,
    "3.4": eq_3_4,
    "3.8, 3.9": eq_3_8,
    "3.11, 3.12": eq_3_11,
    "3.13": eq_3_13,
    "3.26, 3.27, 4.7": eq_3_26,
    "3.26 with Table 3.1": table_3_1,
    "3.28": eq_3_28,
    "4.4 with 4.12": eq_4_4,
    "4.8 to 4.11": eq_4_8,
    "4.12": eq_4_12,
    "4.16": eq_4_16,
    "A, inverse Jacobian": a_inverse,
    "A.1, hook of leg 1": a_hook,
    "A.1, second link of leg 3": a_leg_3,
    "B, first joint": b_quadrant,
    "B, stretched limb": b_straight,
    "C, peg 7 of the H": peg_7,
    "(2)": hoshino_2,
    "(6)": hoshino_6,
    "4.2, axes": hoshino_axes,
    "(12)": hoshino_12,
    "(15)": hoshino_15,
    "(18)": hoshino_18,
}
"""Place, as the page has it -> printed, right and true."""


def same(a: object, b: object) -> bool:
    one, other = np.asarray(a), np.asarray(b)
    if one.shape != other.shape:
        return False
    return bool(np.allclose(one, other, rtol=0.0, atol=1e-6 + 1e-4 * float(np.abs(other).max())))


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("place", CASES)
def test_the_printed_form_is_wrong_and_the_pages_right(place: str, seed: int) -> None:
    printed, right, true = CASES[place](np.random.default_rng(seed))
    assert same(right, true)
    assert not same(printed, true)


def tables(heading: str) -> list[list[list[str]]]:
    """Cells of each table of a section of the page, without its head."""
    text = PAGE.read_text(encoding="utf-8")
    section = re.split(r"^## ", text.split(f"\n## {heading}\n", 1)[1], maxsplit=1, flags=re.MULTILINE)[0]
    found = []
    for block in re.findall(r"(?:^\|.*\n)+", section, re.MULTILINE):
        rows = [[cell.strip() for cell in line.strip("|").split(" | ")] for line in block.splitlines()]
        found.append([[cell.strip(" |") for cell in row] for row in rows[2:]])
    return found


def test_every_erratum_of_the_page_is_computed_and_every_case_is_on_the_page() -> None:
    told = [row[0] for heading in ("thesis", "walker's paper") for row in tables(f"Errata of the {heading}")[0]]
    assert told == list(CASES)


@pytest.mark.parametrize(
    ("paper", "heading"),
    [
        ("bevly-1997", "What of the thesis is not reproduced"),
        ("hoshino-1995", "What of the walker's paper is not reproduced"),
    ],
)
def test_the_page_names_every_row_of_the_study_and_no_other(paper: str, heading: str) -> None:
    rows, without = tables(heading)
    named = [name for row in rows for name in re.findall(r"[a-z][\w-]+(?: of boards-exact)?", row[2])]
    own = [name for name in named if " of " not in name]
    assert sorted(own) == sorted(STUDIES[paper])
    assert {name.split(" of ")[0] for name in named if " of " in name} <= set(STUDIES["boards-exact"])
    assert all(len(row) == 3 and all(row) for row in (*rows, *without))
