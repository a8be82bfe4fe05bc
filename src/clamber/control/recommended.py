"""Gains that `clamber limb tune` found, kept as data: for which robot, limb and law, how far from the limit, on what plant."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from ..errors import StatedError
from ..files import check_schema, read_toml, write_atomically
from ..json_form import Jsonable
from ..regular_files import is_there
from ..toml_text import toml_text
from ..types import Json

SCHEMA: Final = "clamber-gains-1"
SHIPPED: Final = Path(__file__).parent / "data" / "recommended.toml"
"""What comes with Clamber."""
COMMENT: Final = (
    "Written by `clamber limb tune --save`; see docs/limb-tuning.md. kp and kd are in each law's own units."
)


class RecommendationError(StatedError):
    """Gains are asked for that nobody found, or a file of them is wrong: names the file, what was asked for, what there is."""

    says = "{path}: {wanted}; {allowed}"
    path: str
    wanted: str
    allowed: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Recommended(Jsonable):
    """Gains of one law for one limb, with where they come from."""

    robot: str
    limb: str
    law: str
    """Name of the law, with its settings other than kp and kd, as on the command line."""
    kp: float
    """In the law's own unit."""
    kd: float
    limit_kp: float
    """Largest at which the limb came to rest, with kd in the same proportion."""
    margin: float
    """limit_kp over kp, at least [-]."""
    stiffness: tuple[float, float]
    """Of the tip along x and y, at the start (0.22, 0) m or where the limb was put [N/m]."""
    plant: Json
    """Backlash [rad], encoder counts, delay [samples], control rate [Hz] that they were found with."""


def read_recommended(path: Path = SHIPPED) -> list[Recommended]:
    """All gains of a file.

    Raises:
        FileError: If it cannot be read or is no TOML.
        SpecError: If it follows another schema.
        RecommendationError: If an entry lacks something.
    """
    document = read_toml(path, path.name)
    check_schema(document, SCHEMA)
    out = []
    for k, entry in enumerate(document.data.get("gains", [])):
        try:
            out.append(_recommended(entry))
        except (KeyError, TypeError, ValueError) as error:
            raise RecommendationError(
                str(path), f"gains.{k} cannot be read ({error})", "write it by `limb tune`"
            ) from None
    return out


def _recommended(entry: dict[str, Any]) -> Recommended:
    x, y = entry["stiffness"]
    return Recommended(
        robot=str(entry["robot"]),
        limb=str(entry["limb"]),
        law=str(entry["law"]),
        kp=float(entry["kp"]),
        kd=float(entry["kd"]),
        limit_kp=float(entry["limit_kp"]),
        margin=float(entry["margin"]),
        stiffness=(float(x), float(y)),
        plant=dict(entry["plant"]),
    )


def save_recommended(found: list[Recommended], path: Path) -> None:
    """Write gains into a file, in place of those of the same robot, limb and law; others stay.

    Raises:
        FileError: If it cannot be written, or what stands there cannot be read.
    """
    kept = {(entry.robot, entry.limb, entry.law): entry for entry in (read_recommended(path) if is_there(path) else ())}
    kept |= {(entry.robot, entry.limb, entry.law): entry for entry in found}
    gains = [kept[key].to_json() for key in sorted(kept)]
    write_atomically(path, toml_text({"schema": SCHEMA, "gains": gains}, COMMENT))
