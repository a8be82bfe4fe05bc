"""Which column of a log is what: "shoulder angle [rad]", "q1", "tau_2" or a mapping that is stated; numbers leave in SI units."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from ..control.identification.samples import JointSamples
from ..errors import UnitError, describe_choices
from ..types import Floats
from ..units import UNITS, convert, si_unit, split_title
from .log import Log, LogError


def read_mapping(texts: Iterable[str], chosen: Mapping[str, str | None]) -> dict[str, str]:
    """Column -> role, from texts such as "pos_3=left elbow angle [deg]" and from columns chosen for the roles of one joint.

    Args:
        texts: COLUMN=ROLE; a column's name may hold "=" itself, the last one counts.
        chosen: Role -> column, None where none is chosen.

    Raises:
        LogError: If a text lacks a part, or a column is named twice.
    """
    out: dict[str, str] = {}
    pairs = [(column, role) for role, column in chosen.items() if column is not None]
    for text in texts:
        column, equals, role = text.rpartition("=")
        if not equals or not column.strip() or not role.strip():
            raise LogError("--column", None, None, repr(text), "must be COLUMN=ROLE, such as 'q1=shoulder angle [deg]'")
        pairs.insert(0, (column.strip(), role.strip()))
    for column, role in pairs:
        if column in out:
            raise LogError("--column", column, None, repr(role), f"is '{out[column]}' already")
        out[column] = role
    return out


ROLES: Final[dict[str, tuple[str, str]]] = {
    "time": ("time", "time"),
    "angle": ("angle", "angle"),
    "torque": ("torque", "torque"),
    "command": ("command", "voltage"),
    "current": ("current", "current"),
    "output angle": ("output_angle", "angle"),
    "torque sensed": ("sensed_torque", "torque"),
}
"""Role -> field of `JointSamples` and dimension."""
DRIVES: Final = frozenset({"torque", "command", "current", "torque sensed"})
"""What drives a joint: an angle without one, such as a body's, is no joint's."""
_NAMES: Final[dict[str | None, str]] = {
    "output angle": "output angle, output position, load angle, load position, link angle",
    "torque sensed": "torque sensed, sensed torque, measured torque, torque measured",
    None: "torque commanded, commanded torque, output speed",
    "time": "timestamp, time, t",
    "angle": "angle, position, pos, theta, q",
    "torque": "torque, effort, tau",
    "command": "command, voltage, volts, cmd, u",
    "current": "current, amps, i",
}
"""Role -> what columns of it are called; of None they are passed over."""
_WORDS: Final = {tuple(name.split()): role for role, names in _NAMES.items() for name in names.split(", ")}
"""Words of a column's name -> its role; the longer ones are looked for first, None is passed over."""
LEAST_ROWS: Final = 20
"""Of fewer samples nothing is identified."""


@dataclass(frozen=True, slots=True, eq=False)
class LimbSamples:
    """The samples of the joints that a log has, and what had to be assumed."""

    joints: tuple[JointSamples, ...]
    notes: tuple[str, ...]


def samples_of(log: Log, mapping: Mapping[str, str] | None = None) -> LimbSamples:
    """The samples of every joint in a log, in SI units.

    Args:
        log: As read.
        mapping: Column's name -> what it is, such as "shoulder angle [deg]" or "time"; goes before what the names say.

    Raises:
        LogError: If there is no time or no angle, two columns have the same role, a unit is not one of the role's, time
            does not increase, or there are too few rows.
    """
    found, units, notes = _assign(log, mapping or {})
    if ("", "time") not in found:
        allowed = f"no column is the time; name it 'time [s]' or state which is; there are {describe_choices('time', log.columns)}"
        raise LogError(log.label, None, None, None, allowed)
    time = _in_si(log, found["", "time"], "time", units, notes)
    _check_time(log, found["", "time"], time)
    names = list(dict.fromkeys(joint for joint, role in found if role == "angle"))
    if not names:
        known = describe_choices("angle", log.columns)
        allowed = f"no column is a joint's angle; name it 'NAME angle [rad]' or state which is; there are {known}"
        raise LogError(log.label, None, None, None, allowed)
    driven = {joint for joint, role in found if role in DRIVES}
    if passed := [
        joint for joint in names if driven and joint not in driven and found[joint, "angle"] not in (mapping or {})
    ]:
        names = [joint for joint in names if joint not in passed]
        notes.append(f"passed over, as the log has no torque, current or command of it: {', '.join(passed)}")
    out = []
    for joint in names:
        fields: dict[str, Floats] = {}
        for role, (field, _) in ROLES.items():
            if role != "time" and (joint, role) in found:
                fields[field] = _in_si(log, found[joint, role], role, units, notes)
        out.append(JointSamples(name=joint, time=time, **fields))
    if log.cut:
        notes.append(f"{log.label} ends in the middle: the {log.rows} samples before that are used")
    return LimbSamples(tuple(out), tuple(notes))


def role_of(name: str) -> tuple[str, str] | None:
    """Joint and role that a column's name says; None if it says none. Time's joint is empty."""
    words = [word.lower() for word in re.findall(r"[A-Za-z]+|\d+", name)]
    for key, role in _WORDS.items():
        for k in range(len(words) - len(key) + 1):
            if tuple(words[k : k + len(key)]) == key:
                if role is None:
                    return None
                rest = " ".join(words[:k] + words[k + len(key) :])
                return ("", "time") if role == "time" else (rest or "joint", role)
    return None


def _assign(log: Log, mapping: Mapping[str, str]) -> tuple[dict[tuple[str, str], str], dict[str, str], list[str]]:
    """(joint, role) -> column, column -> unit stated in the mapping, and an empty list of notes."""
    found: dict[tuple[str, str], str] = {}
    units: dict[str, str] = {}
    for column, title in mapping.items():
        log.column(column)
        name, unit = split_title(title)
        place = role_of(name)
        if place is None:
            raise LogError(
                log.label, column, None, repr(title), f"must be one of: time, or a joint's {', '.join(list(ROLES)[1:])}"
            )
        if place in found:
            raise LogError(log.label, column, None, repr(title), f"is column '{found[place]}' already")
        found[place] = column
        if unit is not None:
            units[column] = unit
    stated = set(found)
    for column in log.columns:
        place = role_of(column)
        if column in mapping or place is None or place in stated:
            continue
        if place in found:
            allowed = f"reads as the same thing as column '{found[place]}'; state which column is what"
            raise LogError(log.label, column, None, None, allowed)
        found[place] = column
    return found, units, []


def _in_si(log: Log, column: str, role: str, units: Mapping[str, str], notes: list[str]) -> Floats:
    dimension = ROLES[role][1]
    unit = units.get(column, log.units.get(column))
    if unit is None:
        unit = si_unit(dimension)
        note = f"column '{column}' states no unit: read as {unit}"
        if note not in notes:
            notes.append(note)
    try:
        size = convert(1.0, unit, dimension)
    except UnitError:
        allowed = f"is no unit of {dimension}; allowed are {describe_choices(unit, UNITS[dimension])}"
        raise LogError(log.label, column, None, f"[{unit}]", allowed) from None
    return np.asarray(log.columns[column], dtype=np.float64) * size


def _check_time(log: Log, column: str, time: Floats) -> None:
    if time.size < LEAST_ROWS:
        raise LogError(log.label, None, None, f"{time.size} rows", f"must have {LEAST_ROWS} samples or more")
    back = np.flatnonzero(~(np.diff(time) > 0.0))
    if back.size:
        k = int(back[0])
        raise LogError(
            log.label, column, k + 2, f"{time[k + 1]:.9g} s", f"must be later than the row before, {time[k]:.9g} s"
        )
