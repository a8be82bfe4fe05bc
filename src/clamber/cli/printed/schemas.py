"""JSON Schema of dataclasses as `json_form` writes them: a model of each, made of its fields, their types and their docstrings."""

import inspect
import re
from collections.abc import Mapping
from dataclasses import is_dataclass
from functools import cache, reduce
from operator import or_
from types import UnionType
from typing import Annotated, Any, Final, Literal, Union, get_args, get_origin, get_type_hints

from pydantic import BaseModel, ConfigDict, Field, create_model

from ...json_form import Entry, Jsonable, entries_of
from ...spec_text import docs_of
from ...types import Json

LIST: Final[Any] = list  # of kinds that are known at run time only
DICT: Final[Any] = dict
STRICT: Final = ConfigDict(extra="forbid", strict=True)


def modelled(kind: Any) -> Any:
    """An annotation with models in place of dataclasses, and lists in place of tuples: what JSON has of it."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        return kind
    if isinstance(kind, type) and is_dataclass(kind):
        return _model_of(kind)
    origin, inner = get_origin(kind), get_args(kind)
    if origin is Literal:
        return kind
    if origin is Annotated:
        bounds = [each for each in inner[1:] if _is_bound(each)]
        return Annotated[modelled(inner[0]), *bounds] if bounds else modelled(inner[0])
    if origin in (Union, UnionType):
        return reduce(or_, (modelled(each) for each in inner))
    if origin is tuple:
        each = LIST[modelled(inner[0])]
        return each if inner[-1] is Ellipsis else Annotated[each, Field(min_length=len(inner), max_length=len(inner))]
    if origin is not None and issubclass(origin, Mapping):
        return DICT[inner[0], modelled(inner[1])]
    return LIST[modelled(inner[0])] if origin is not None else kind


def _is_bound(metadata: Any) -> bool:
    return type(metadata).__module__.split(".")[0] in ("annotated_types", "pydantic", "pydantic_core")


@cache
def _model_of(cls: type[Any]) -> Any:
    """What JSON has of a dataclass; where it writes itself, what its `to_json` says that it returns."""
    method = getattr(cls, "to_json", Jsonable.to_json)
    if method is not Jsonable.to_json:
        returned = get_type_hints(method, include_extras=True)["return"]
        return returned if returned == Json else modelled(returned)
    model = create_model(
        cls.__name__,
        __config__=STRICT,
        __doc__=_text(inspect.cleandoc(cls.__doc__ or "")),
        **{f"field_{number}": _field(entry) for number, entry in enumerate(entries_of(cls))},  # type: ignore[arg-type]
    )
    model.__module__ = cls.__module__
    return model


def _field(entry: Entry) -> Any:
    """Type and meaning of a field."""
    value = vars(entry.owner).get(entry.name)  # a property or method has a docstring, the slot of a field has none
    told = entry.meaning or docs_of(entry.owner).get(entry.name) or getattr(value, "__doc__", None)
    default: Any = None if entry.may_be_missing else ...
    return modelled(entry.kind), Field(default, alias=entry.key, description=_text(told) if told else None)


def _text(told: str) -> str:
    """A docstring in one line, in the words of JSON."""
    text = re.sub(r", shape \([^)]*\)", "", " ".join(told.split())).replace(" -> ", " to ")
    text = re.sub(r'(?<!")\b(None|inf|NaN|infinite|not finite)\b(?!")', "null", text)
    text = re.sub(r"\b(True|False)\b", lambda found: found[0].lower(), text)
    return text[:1].upper() + text[1:] if text.startswith("null") else text
