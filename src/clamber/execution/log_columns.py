"""The user's words for which column of a log is what, as a mapping from columns to roles."""

from collections.abc import Iterable, Mapping

from .log import LogError


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
