"""Specs: frozen dataclasses that a file fills through pydantic; a problem names file, key, value, what is allowed."""

import types
import typing
from dataclasses import dataclass, fields, is_dataclass
from functools import cache
from typing import Annotated, Any, TypeVar, dataclass_transform, get_args, get_origin

from pydantic import ConfigDict, StringConstraints, TypeAdapter, ValidationError
from pydantic_core import ErrorDetails

from .errors import SpecError, describe_choices
from .files import Document, element_names
from .notebook import OneLine
from .types import Json
from .units import QUANTITY_KEYS

T = TypeVar("T")

UNKNOWN_KEY = frozenset({"unexpected_keyword_argument", "extra_forbidden"})
"""What pydantic calls it."""
MOST_PROBLEMS = 20
"""Of one file that are told; the others are counted."""
Name = Annotated[str, StringConstraints(strict=True, pattern=r"^[A-Za-z][A-Za-z0-9_-]*$", max_length=64)]
"""A name in a file: letters, digits, "_" and "-", a letter first."""


@dataclass_transform(kw_only_default=True, frozen_default=True)
def spec(cls: type[T]) -> type[T]:
    """Makes a class a frozen, slotted, keyword-only dataclass whose file may have no keys but its fields."""
    made = dataclass(frozen=True, slots=True, kw_only=True, repr=not issubclass(cls, OneLine))(cls)
    made.__pydantic_config__ = ConfigDict(extra="forbid")  # type: ignore[attr-defined]
    return made


@cache
def _adapter(cls: type[Any]) -> TypeAdapter[Any]:
    return TypeAdapter(cls)


def build_spec(cls: type[T], document: Document, without: tuple[str, ...] = ()) -> T:
    """A spec from a document; `without` names keys that are about the file (such as `schema`) and not of the spec.

    Raises:
        SpecError: If a key is missing or unknown, or a value is none that the key may have; all problems are listed.
    """
    table = {key: value for key, value in document.data.items() if key not in without}
    try:
        built: T = _adapter(cls).validate_python(table)  # type: ignore[arg-type]
    except ValidationError as error:
        # A misspelt key is the likelier cause of a missing one, so unknown keys come first.
        found = sorted(error.errors(), key=lambda details: details["type"] not in UNKNOWN_KEY)
        problems = [_problem(cls, document, details, without) for details in found[:MOST_PROBLEMS]]
        more = (f"{len(found) - MOST_PROBLEMS} problems more",) if len(found) > MOST_PROBLEMS else ()
        others = (*(problem.headline for problem in problems[1:]), *more)
        first = problems[0]
        raise SpecError(first.file, first.key, first.value, first.allowed, others) from None
    return built


def field_names(cls: type[Any]) -> tuple[str, ...]:
    """Names of a spec's fields, in order."""
    return tuple(field.name for field in fields(cls))


_PLAIN_WORDS = {
    "dataclass_type": "must be a table",
    "missing": "must be given",
    "dict_type": "must be a table",
    "tuple_type": "must be a list",
    "string_type": "must be a text in quotes",
    "int_type": "must be a whole number",
    "bool_type": "must be true or false",
    "string_pattern_mismatch": "must be letters, digits, '_' and '-', a letter first",
}


def _problem(cls: type[Any], document: Document, details: ErrorDetails, without: tuple[str, ...]) -> SpecError:
    loc = details["loc"]
    key = dotted(document.data, loc)
    if details["type"] in UNKNOWN_KEY:
        known = tuple(name for name in _keys_at(cls, loc[:-1]) if name not in without)
        return document.problem(key, f"unknown key; allowed are {describe_choices(str(loc[-1]), known)}")
    if details["type"] == "quantity":
        return document.problem(key, str(details["msg"]))
    if details["type"] == "literal_error":
        return document.problem(key, f"must be {details['ctx']['expected']}")
    words = details["msg"].replace("Input should be", "must be").replace("Input should", "must")
    return document.problem(key, _PLAIN_WORDS.get(details["type"], words))


def dotted(data: Json, loc: tuple[int | str, ...]) -> str:
    """A place in a table as a dotted key; elements of lists go by their names."""
    words: list[str] = []
    here: Any = data
    for step in loc:
        if isinstance(here, list) and isinstance(step, int) and step < len(here):
            words.append(element_names(here)[step])
            here = here[step]
        else:
            words.append(str(step))
            here = here.get(step) if isinstance(here, dict) else None
    return ".".join(words)


def _keys_at(cls: Any, loc: tuple[int | str, ...]) -> tuple[str, ...]:
    here = cls
    for step in loc:
        here = _bare(here)
        if is_dataclass(here):
            here = typing.get_type_hints(here).get(str(step))
        elif get_origin(here) is tuple:
            kinds = get_args(here)
            here = kinds[min(step, len(kinds) - 1)] if isinstance(step, int) and kinds[-1] is not ... else kinds[0]
        elif get_origin(here) is dict:
            here = get_args(here)[1]
    here = _bare(here)
    return field_names(here) if isinstance(here, type) and is_dataclass(here) else ()


def _bare(kind: Any) -> Any:
    """The type without `Annotated` and without `| None`."""
    if get_origin(kind) is Annotated:
        return _bare(get_args(kind)[0])
    if get_origin(kind) in {typing.Union, types.UnionType}:
        return _bare(next(option for option in get_args(kind) if option is not type(None)))
    return kind


@dataclass(frozen=True, slots=True, kw_only=True)
class Provenance:
    """A number as its file states it, and where it comes from."""

    value: float
    """In `unit`."""
    unit: str
    """As written; "1" for a ratio or a count."""
    source: str
    """Paper and table, datasheet, or how it was inferred or chosen."""


def collect_sources(data: object, prefix: str = "") -> dict[str, Provenance]:
    """Every `{ value, unit, source }` of a document by its dotted key."""
    if isinstance(data, list):
        pairs: list[tuple[str, object]] = list(zip(element_names(data), data, strict=True))
    elif isinstance(data, dict):
        pairs = list(data.items())
        if "value" in data and set(data) <= QUANTITY_KEYS:
            unit, source = str(data.get("unit", "1")), str(data.get("source", "not stated"))
            return {prefix: Provenance(value=data["value"], unit=unit, source=source)}
    else:
        return {}
    found: dict[str, Provenance] = {}
    for word, inner in pairs:
        found |= collect_sources(inner, f"{prefix}.{word}" if prefix else word)
    return found
