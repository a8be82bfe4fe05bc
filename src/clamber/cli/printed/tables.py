"""A schema as tables: one for each kind of object, its fields with what they hold and mean."""

from dataclasses import dataclass
from typing import Any

from ...types import Json

ANYTHING = "anything"
PLAIN = {"string": "text", "integer": "whole number", "number": "number", "boolean": "true or false", "null": "null"}


@dataclass(frozen=True, slots=True)
class ObjectTable:
    """One kind of object."""

    name: str
    meaning: str
    rows: tuple[tuple[str, str, str], ...]
    """Field, what it holds, what it means; a field that may be missing has a "?" at its end."""


def top_of(schema: Json) -> str:
    """What the whole value is, such as "Plan or Front"."""
    return _kind(_nameless(schema)) if "properties" not in schema else str(schema["title"])


def tables_of(schema: Json) -> list[ObjectTable]:
    """The objects of a schema, those that hold others before these."""
    objects = dict(schema.get("$defs", {}))
    tables = [_table(str(schema["title"]), schema)] if "properties" in schema else []
    order: list[str] = []
    _visit(schema, objects, order)
    return tables + [_table(name, objects[name]) for name in order]


def _visit(node: Any, objects: Json, order: list[str]) -> None:
    if isinstance(node, list):
        for each in node:
            _visit(each, objects, order)
    elif isinstance(node, dict):
        if (name := _referred(node)) is not None:
            if name not in order:
                order.append(name)
                _visit(objects[name], objects, order)
            return
        for key, each in node.items():
            if key != "$defs":
                _visit(each, objects, order)


def _table(name: str, node: Json) -> ObjectTable:
    required = node.get("required", [])
    rows = tuple(
        (field if field in required else f"{field}?", _kind(told), str(told.get("description", "")).replace("\n", " "))
        for field, told in node["properties"].items()
    )
    return ObjectTable(name, str(node.get("description", "")).replace("\n", " "), rows)


def _nameless(schema: Json) -> Json:
    return {key: value for key, value in schema.items() if key not in ("title", "description")}


def _referred(node: Json) -> str | None:
    reference = node.get("$ref")
    return None if reference is None else str(reference).rpartition("/")[2]


def _kind(node: Json) -> str:
    """What a value is, in words."""
    if (name := _referred(node)) is not None:
        return name
    if "anyOf" in node:
        return " or ".join(dict.fromkeys(_kind(each) for each in node["anyOf"]))
    if "const" in node:
        return f'"{node["const"]}"'
    if "enum" in node:
        return " or ".join(f'"{value}"' for value in node["enum"])
    if node.get("type") == "array":
        return f"list of {_kind(node['items'])}"
    if node.get("type") == "object":
        values = node["additionalProperties"]
        return f"name to {_kind(values) if isinstance(values, dict) else ANYTHING}"
    return PLAIN[node["type"]] if "type" in node else ANYTHING
