"""Laws at the gains that were recommended for them on this limb, as texts that the other commands read."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from ..control.law_settings import WEIGHTED, LawSettings
from ..control.recommended import SHIPPED, RecommendationError, read_recommended
from ..errors import describe_choices
from .bench_limb import BenchLimb
from .entries import GAINS, read_law


def loop_of(law: LawSettings) -> LawSettings:
    """A law without what does not act in its loop at rest: its gains and what it feeds forward. Laws with equal loops are tuned alike."""
    plain = LawSettings(law=law.law)
    forward = ("feed_velocity", "feed_acceleration", "feed_bias", "feed_friction", "feed_force", "friction_speed")
    kept = {key: getattr(plain, key) for key in (*GAINS, "joint_kp", "joint_kd", *forward)}
    weight = law.weight
    if weight is None:
        weight = "inertia" if law.law in WEIGHTED else "none"
    return replace(law, **kept, weight=weight)


def with_recommended_gains(limb: BenchLimb, texts: Sequence[str], path: Path = SHIPPED) -> list[str]:
    """Texts of laws with kp and kd as recommended for the limb; those that state a gain stay as they are.

    Raises:
        RecommendationError: If nobody tuned such a law on this limb, or friction is fed forward by what the loop itself moves.
        UnknownNameError, LawError: If a text is no law.
    """
    known = [one for one in read_recommended(path) if (one.robot, one.limb) == (limb.robot.name, limb.name)]
    out = []
    for text in texts:
        law = read_law(text)
        said = text.partition(":")[2]
        if any(part.partition("=")[0].strip() in GAINS for part in said.split(",")):
            out.append(text)
            continue
        found = [one for one in known if loop_of(read_law(one.law)) == loop_of(law)]
        if not found or (law.feed_friction > 0.0 and law.friction_from != "aim"):
            there = describe_choices(text, [one.law for one in known]) if known else "none for this limb"
            raise RecommendationError(
                path.name, f"no gains of {text} for {limb.robot.name}'s {limb.name} limb",
                f"there are {there}; find them by `clamber limb tune`",
            )  # fmt: skip
        out.append(f"{text}{',' if said else ':'}kp={found[0].kp!r},kd={found[0].kd!r}")
    return out
