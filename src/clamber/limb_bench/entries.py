r"""Laws as a user names them, such as jacobian-transpose:kp=1000,kd=100, and the usual set; gains matched unless stated.

What is matched is a law's stiffness at the tip, measured from the law itself: K_theta = -d tau / d q at rest on its aim, by central
differences of the controller's own torques, and S = J^-T K_theta J^-1 at the tip. SCCT's is J^-T K' J^-1 K_p, a full matrix even for equal
gains, J^T's is K_p: "the same stiffness" can mean the yy entry, the mean of both, or each diagonal entry, and the choice decides who wins.
"""

import re
from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any, Final, Literal, TypeAlias

import numpy as np

from ..control.chain import Chain
from ..control.controller import still_aim
from ..control.law_settings import LAWS, WEIGHTED, LawError, LawSettings, law_names
from ..control.outside_law import controller_of
from ..control.recommended import SHIPPED, RecommendationError, read_recommended
from ..errors import UnitError, UnknownNameError, describe_choices
from ..sim.bench_limb import BenchLimb
from ..sim.flaw_texts import YES_NO
from ..types import Floats
from ..units import parse_quantity, si_unit
from .bench_limb import LEAST_SIGMA
from .measures import Entry
from .scenario import Scenario

Match: TypeAlias = Literal["yy", "mean", "diagonal", "none"]
MATCHES: Final[tuple[Match, ...]] = ("yy", "mean", "diagonal", "none")
NUDGE: Final = 1e-6
"""Of a joint [rad]."""
HELD: Final = 200
"""Ticks that a nudge is held before its torques count: a filtered derivative has died away, what is left is the spring."""
LEAST_PART: Final = 1e-6
"""A stiffness smaller than this part of that along the other axis is none."""


def tip_stiffness(chain: Chain, settings: LawSettings, q: Floats) -> Floats:
    """Stiffness of a law at the tip in x and y, at rest on its aim, from its own torques, shape (2, 2) [N/m]."""
    # at rest a derivative term has died away; in the tick after a nudge it has not
    bare = settings.with_changes(feed_gravity=False, feed_friction=0.0, derivative=0.0)
    controller = controller_of(chain, bare, period=0.005)
    aim = still_aim(chain.place(q))
    states = np.zeros((1, 2, chain.n))

    def torques(angles: Floats) -> Floats:
        # A law that remembers its aim in joint angles is first asked at the aim
        controller.reset()
        states[0, 0] = q
        controller.command(aim, states)
        states[0, 0] = angles
        for _ in range(HELD):
            out: Floats = controller.command(aim, states)[0]
        return out.copy()

    joint = np.empty((chain.n, chain.n))
    for j, nudge in enumerate(NUDGE * np.eye(chain.n)):
        joint[:, j] = -(torques(q + nudge) - torques(q - nudge)) / (2 * NUDGE)
    inverse = np.linalg.pinv(chain.jacobian(q)[:2])
    stiffness: Floats = inverse.T @ joint @ inverse
    return stiffness


def match_gains(chain: Chain, settings: LawSettings, reference: LawSettings, q: Floats, how: Match) -> LawSettings:
    """`settings` with kp and kd scaled until its stiffness at `q` is that of `reference` in the sense of `how`.

    kd is scaled as kp is, so the ratio of both stays that of `reference`, whose gains are the starting point.

    "diagonal" goes by the axes of the task frame of `settings`; a law with one gain for all directions, as joint-pd, or with a servo gain
    of its own, is left unmatched by it: its stiffness tells.

    Raises:
        LawError: If either law has no stiffness in that sense, as along a row that carries a force.
    """
    if how == "none":
        return settings
    start = replace(settings, kp=reference.kp, kd=reference.kd)
    turn = settings.task_frame()[:2, :2] if how == "diagonal" else np.eye(2)
    ours, theirs = (turn.T @ tip_stiffness(chain, law, q) @ turn for law in (start, reference))
    for law, stiffness in ((settings, ours), (reference, theirs)):
        if not np.diag(stiffness).min() > LEAST_PART * np.diag(stiffness).max():
            raise LawError(
                law.law,
                "kp",
                "(matched)",
                f"has no stiffness of its own to match by '{how}': state kp and kd, or 'none'",
            )
    if how == "yy":
        factors = np.full(2, theirs[1, 1] / ours[1, 1])
    elif how == "mean":
        factors = np.full(2, np.trace(theirs) / np.trace(ours))
    else:
        factors = np.diag(theirs) / np.diag(ours)

    def scaled(value: float | tuple[float, ...]) -> float | tuple[float, ...]:
        pair = np.broadcast_to(np.asarray(value, dtype=np.float64), 2) * factors
        return float(pair[0]) if pair[0] == pair[1] else tuple(map(float, pair))

    return replace(start, kp=scaled(start.kp), kd=scaled(start.kd))


USUAL: Final = (
    "scct",
    "jacobian-transpose",
    "operational-space:feed_acceleration=yes,feed_friction=1",
    "resolved-rate:weight=inertia",
    "resolved-rate:weight=none",
    "joint-pd:weight=none",
)
"""Compared unless others are named."""
GAINS: Final = ("kp", "kd")
OTHER_GAINS: Final = {
    "jacobian-transpose": ("stiffness", "linear damping"),
    "operational-space": (None, None),
}
"""Law -> dimensions of kp and kd, where they are not those of a joint's servo; None: a plain number, in 1/s^2 and 1/s."""
DIMENSIONS: Final = {
    "angle": "angle",
    "frame": "angle",
    "joint_kp": "angular stiffness",
    "joint_kd": "damping",
    "feed_friction": "ratio",
    "friction_speed": "angular speed",
    "derivative": "time",
    "derivative_time": "time",
    "force_limit": "force",
    "force_damping": "linear damping",
    "torque_limit": "torque",
    "environment": "stiffness",
    "mass": "mass",
    "admittance_kp": "stiffness",
    "admittance_kd": "linear damping",
    "posture_kp": "angular stiffness",
    "posture_kd": "damping",
}
"""Setting -> its dimension; a number without a unit is in SI."""
WORDS: Final = ("weight", "friction_from", "torque_sensor")
LISTS: Final = ("axes", "forced")
PER_AXIS: Final = (*GAINS, "frame", "mass", "admittance_kp", "admittance_kd")
BETWEEN: Final = re.compile(r"/(?=[+-]?[\d.])")
"""Between the values of two axes; the slash of a unit is followed by a letter."""
SWITCHES: Final = ("feed_velocity", "feed_acceleration", "feed_gravity", "feed_bias", "feed_force", "scaled")


def read_law(text: str) -> LawSettings:
    """A law of a text NAME[:key=value,...]; a value for each axis is kp=200/50.

    Raises:
        UnknownNameError: If no law is called so.
        LawError: If a setting is unknown or its value not allowed.
    """
    return _parsed(text)[0]


def _parsed(text: str) -> tuple[LawSettings, dict[str, Any]]:
    """A law, and the settings that its text states."""
    law, _, said = text.partition(":")
    law = law.strip()
    if law not in law_names():
        raise UnknownNameError("controller", law, law_names())
    out: dict[str, Any] = {}
    known = tuple(field.name for field in fields(LawSettings) if field.name != "law")
    for part in filter(None, (word.strip() for word in said.split(","))):
        key, equals, value = (word.strip() for word in part.partition("="))
        if key not in known:
            raise LawError(law, key, value, f"no such setting; there are {describe_choices(key, known)}")
        if not equals or not value:
            raise LawError(law, key, value, "needs a value, as in kp=100")
        if key in out:
            raise LawError(law, key, value, "is stated twice")
        out[key] = _value(law, key, value)
    return LawSettings(law=law).with_changes(**out), out


def _value(law: str, key: str, text: str) -> Any:
    if key in WORDS:
        return text
    if key in LISTS:
        return tuple(text.split("/"))
    if key in SWITCHES:
        if text.lower() not in YES_NO:
            raise LawError(law, key, text, "must be yes or no")
        return YES_NO[text.lower()]
    parts = BETWEEN.split(text) if key in PER_AXIS else [text]
    numbers = tuple(_number(law, key, part) for part in parts)
    return numbers if len(numbers) > 1 else numbers[0]


def gain_dimension(law: str, key: str) -> str | None:
    """The dimension of a law's kp or kd; None for accelerations per metre, which have no unit of their own here."""
    return OTHER_GAINS.get(law, ("angular stiffness", "damping"))[GAINS.index(key)]


def gain_unit(law: str, key: str) -> str:
    """The SI unit of a law's kp or kd, as in "N/m"."""
    dimension = gain_dimension(law, key)
    return {"kp": "1/s^2", "kd": "1/s"}[key] if dimension is None else si_unit(dimension)


def _number(law: str, key: str, text: str) -> float:
    """A number in SI, or with a unit of the setting's dimension."""
    try:
        return float(text)
    except ValueError:
        pass
    dimension = gain_dimension(law, key) if key in GAINS else DIMENSIONS.get(key)
    if dimension is None:
        raise LawError(law, key, text, "must be a number without a unit")
    try:
        return parse_quantity(text, dimension)
    except UnitError as error:
        raise LawError(law, key, text, f"{error.problem}; {error.allowed}") from None


def match_pose(limb: BenchLimb, scenario: Scenario) -> Floats:
    """Joint angles at which stiffnesses are made equal: at a circle's centre where the limb is regular, else at the start [rad]."""
    if scenario.centre is None:
        return limb.q0
    branches = [np.array(q) for q in limb.branches(*scenario.centre)]
    nearest = min(branches, key=lambda q: float(np.abs(q - limb.q0).max()), default=limb.q0)
    regular = np.linalg.svd(limb.chain.jacobian(nearest)[:2], compute_uv=False).min() > LEAST_SIGMA
    return nearest if regular else limb.q0


def make_entries(limb: BenchLimb, texts: Sequence[str], reference: LawSettings, match: Match, q: Floats) -> list[Entry]:
    """Entries of `texts` with labels of their own; kp and kd of those that state neither are matched to `reference` at `q` [rad].

    With `match` "none" they are the numbers of `reference`, whatever each law's unit of them is.

    Raises:
        UnknownNameError: If a law is unknown.
        LawError: If a setting is not allowed.
    """
    out: list[Entry] = []
    chosen = [text.strip() for text in texts or USUAL]
    for text in chosen:
        settings, stated = _parsed(text)
        own = settings.law not in LAWS or any(key in stated for key in GAINS)
        if not own and match == "none":
            settings = replace(settings, kp=reference.kp, kd=reference.kd)
        elif not own:
            settings = match_gains(limb.chain, settings, reference, q, match)
        alone = sum(other.partition(":")[0].strip() == settings.law for other in chosen) == 1
        label = settings.law if alone else _short_label(settings.law, text.partition(":")[2])
        while any(entry.label == label for entry in out):
            label += "'"
        out.append(Entry(label, settings, own))
    return out


def _short_label(law: str, said: str) -> str:
    """A law with its settings, as in "scct kp=100" or "resolved-rate unweighted"."""
    words = [word.strip() for word in said.split(",") if word.strip()]
    short = {"weight=none": "unweighted", "weight=inertia": "by inertia", "weight=damping": "by damping"}
    return " ".join((law, *(short.get(word, word) for word in words)))


def reference_law(text: str, kp: float | None, kd: float | None) -> LawSettings:
    """The law that gains are matched to; `kp` and `kd` go before those in `text`.

    Raises:
        UnknownNameError: If no law is called so.
        LawError: If a gain is not allowed.
    """
    law, stated = _parsed(text)
    return replace(
        law, kp=stated.get("kp", 100.0) if kp is None else kp, kd=stated.get("kd", 10.0) if kd is None else kd
    )


def loop_of(law: LawSettings) -> LawSettings:
    """A law without what does not act in its loop at rest: its gains and what it feeds forward. Laws with equal loops are tuned alike."""
    plain = LawSettings(law=law.law)
    forward = ("feed_velocity", "feed_acceleration", "feed_bias", "feed_friction", "feed_force", "friction_speed")
    kept = {key: getattr(plain, key) for key in (*GAINS, "joint_kp", "joint_kd", *forward)}
    weight = law.weight
    if weight is None:
        weight = "inertia" if law.law in WEIGHTED else "none"
    return replace(law, **kept, weight=weight)


def with_recommended_gains(limb: BenchLimb, texts: Sequence[str]) -> list[str]:
    """Texts of laws with kp and kd as recommended for the limb; those that state a gain stay as they are.

    Raises:
        RecommendationError: If nobody tuned such a law on this limb, or friction is fed forward by what the loop itself moves.
        UnknownNameError, LawError: If a text is no law.
    """
    known = [one for one in read_recommended(SHIPPED) if (one.robot, one.limb) == (limb.robot.name, limb.name)]
    out = []
    for text in texts:
        law, stated = _parsed(text)
        if any(key in stated for key in GAINS):
            out.append(text)
            continue
        found = [one for one in known if loop_of(read_law(one.law)) == loop_of(law)]
        if not found or (law.feed_friction > 0.0 and law.friction_from != "aim"):
            there = describe_choices(text, [one.law for one in known]) if known else "none for this limb"
            raise RecommendationError(
                SHIPPED.name, f"no gains of {text} for {limb.robot.name}'s {limb.name} limb",
                f"there are {there}; find them by `clamber limb tune`",
            )  # fmt: skip
        out.append(f"{text}{',' if text.partition(':')[2] else ':'}kp={found[0].kp!r},kd={found[0].kd!r}")
    return out
