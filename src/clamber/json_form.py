"""JSON of dataclasses: their fields are the keys, and `Key` beside a field's type says where the two differ.

What commands print, what files hold and what `clamber schema` describes come from the same fields.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Final, TypeAlias, TypeVar, get_args, get_type_hints

from annotated_types import Ge

from .types import Json

F = TypeVar("F", bound=Callable[..., Any])


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """One key of a class's JSON."""

    key: str
    name: str
    """Of the field, property or method that holds the value."""
    get: Callable[[Any], Any]
    """The value of an object, before it is made plain."""
    kind: Any
    """Annotation of that value."""
    owner: type[Any]
    """Class that has it."""
    meaning: str = ""
    """Empty: what the docstring says."""
    after: str = ""
    """Key behind which it stands; empty: in order."""
    may_be_missing: bool = False
    """Whether the key is left out where the value is None."""


@dataclass(frozen=True, slots=True)
class Key:
    """Metadata of a field's annotation: how its value stands in JSON. A field with two of them stands there twice."""

    name: str = ""
    """The key; empty: the field's name."""
    per: float | None = None
    """Unit in which a number stands there, in SI."""
    get: Callable[[Any], Any] | None = None
    """What stands there of a value that is not None; None: the value."""
    kind: Any = None
    """Annotation of what stands there; None: the field's."""
    meaning: str = ""
    """Empty: what the docstring below the field says."""
    after: str = ""
    """Key behind which it stands; empty: in the order of the fields."""
    may_be_missing: bool = False
    """Whether the key is left out where the value is None."""

    def of(self, value: Any) -> Any:
        """What stands there of a field's value."""
        if value is None:
            return None
        value = value if self.get is None else self.get(value)
        return value if self.per is None else value / self.per


HIDDEN: Final = "hidden"
"""Metadata of a field that is not in the JSON."""
INLINE: Final = "inline"
"""Metadata of a field whose keys stand among those of the class itself."""
Count: TypeAlias = Annotated[int, Ge(0)]
OrNull: TypeAlias = Annotated[float, Key(kind=float | None)]
"""A number that is null in JSON where it is not finite."""


class Jsonable:
    """Base of dataclasses whose JSON is made of their fields and of the properties that are `in_json`."""

    __slots__ = ()

    def to_json(self) -> Json:
        """Plain data; numbers that are not finite are None."""
        return {
            entry.key: plain(value)
            for entry in entries_of(type(self))  # type: ignore[arg-type]  # a class is hashable whatever its objects are
            if (value := entry.get(self)) is not None or not entry.may_be_missing
        }


def in_json(*, after: str = "", key: str = "") -> Callable[[F], F]:
    """Put a method without arguments, or a property (decorated below `@property`), into the JSON of its class.

    Args:
        after: Key behind which it stands; empty: behind all others.
        key: Its own; empty: its name.
    """

    def mark(getter: F) -> F:
        getter.in_json = (key or getter.__name__, after)  # type: ignore[attr-defined]
        return getter

    return mark


def plain(value: Any) -> Any:
    """A value as strings, numbers, booleans, lists and tables; numbers that are not finite are None."""
    if value is None or isinstance(value, str | int):
        return value
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, Path):
        return str(value)
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if is_dataclass(value):
        return value.to_json() if hasattr(value, "to_json") else Jsonable.to_json(value)  # type: ignore[arg-type]
    assert isinstance(value, Iterable), value
    return [plain(each) for each in value]


@cache
def entries_of(cls: type[Any]) -> tuple[Entry, ...]:
    """The keys of the JSON of a dataclass, in order."""
    hints = get_type_hints(cls, include_extras=True)
    found = [entry for field in fields(cls) for entry in _of_field(cls, field.name, hints[field.name])]
    for owner in reversed(cls.__mro__):
        for name, value in vars(owner).items():
            getter = getattr(value, "fget", value)
            if hasattr(getter, "in_json"):
                key, after = getter.in_json
                hint = get_type_hints(getter, include_extras=True)["return"]
                kind = _kind_of(hint, next(_keys_of(hint), Key()))
                found.append(Entry(key=key, name=name, get=getter, kind=kind, owner=owner, after=after))
    return tuple(_in_order(found))


def _in_order(found: list[Entry]) -> Iterator[Entry]:
    """Entries behind those that they are to follow; of two with one key, the later takes the place of the earlier."""
    last = {entry.key: entry for entry in found}
    followers: dict[str, list[str]] = {}
    for entry in found:
        followers.setdefault(entry.after, []).append(entry.key)
    waiting = list(dict.fromkeys(followers.pop("", [])))
    while waiting:
        key = waiting.pop(0)
        yield last[key]
        waiting[:0] = followers.pop(key, [])
    assert not followers, f"no keys {', '.join(followers)}"


def _of_field(cls: type[Any], name: str, hint: Any) -> list[Entry]:
    """The keys of one field: none if it is hidden, those of its own class if it is inlined."""
    kind, *metadata = _parts(hint)
    if HIDDEN in metadata:
        return []
    if INLINE in metadata:
        return [replace(entry, get=_through(name, entry.get), after="") for entry in entries_of(kind)]
    keys = list(_keys_of(hint)) or [Key()]
    return [
        Entry(
            key=key.name or name, name=name, get=_through(name, key.of), kind=_kind_of(hint, key), owner=cls,
            meaning=key.meaning, after=key.after, may_be_missing=key.may_be_missing,
        )
        for key in keys
    ]  # fmt: skip


def _through(name: str, get: Callable[[Any], Any]) -> Callable[[Any], Any]:
    return lambda value: get(getattr(value, name))


def _parts(hint: Any) -> tuple[Any, ...]:
    """The type of an annotation, and its metadata."""
    return get_args(hint) if hasattr(hint, "__metadata__") else (hint,)


def _keys_of(hint: Any) -> Iterator[Key]:
    return (each for each in _parts(hint)[1:] if isinstance(each, Key))


def _kind_of(hint: Any, key: Key) -> Any:
    """Annotation of what stands under a key."""
    if key.kind is None:
        return hint
    return key.kind | None if type(None) in get_args(_parts(hint)[0]) else key.kind
