"""Plain data as the text of a TOML file, for files that commands write and people go on editing."""

import json
from collections.abc import Mapping, Sequence
from typing import Any


def toml_text(data: Mapping[str, Any], comment: str = "") -> str:
    """The text of a TOML file: single values first, then tables and lists of tables, in the order in which they stand.

    Args:
        data: Tables, lists, texts, numbers and truth values; keys that are None are left out.
        comment: Lines that stand above, without "#".
    """
    lines = [f"# {line}" for line in comment.splitlines()]
    _table(lines, (), data)
    return "\n".join(lines) + "\n"


def toml_value(value: Any) -> str:
    """Plain data as a value on one line, such as an override needs it."""
    return _value(value, in_line=True)


def _table(lines: list[str], path: tuple[str, ...], table: Mapping[str, Any]) -> None:
    stated = {key: value for key, value in table.items() if value is not None}
    lines += [f"{_key(key)} = {_value(value)}" for key, value in stated.items() if not _stands_alone(value)]
    for key, value in stated.items():
        if not _stands_alone(value):
            continue
        title = ".".join(_key(word) for word in (*path, key))
        for inner in [value] if isinstance(value, Mapping) else value:
            lines += ["", f"[{title}]" if isinstance(value, Mapping) else f"[[{title}]]"]
            _table(lines, (*path, key), inner)


def _stands_alone(value: Any) -> bool:
    """Whether a value gets a heading of its own; lists of many small tables stay on lines of a list."""
    if isinstance(value, Mapping):
        return True
    is_tables = isinstance(value, list | tuple) and bool(value) and all(isinstance(item, Mapping) for item in value)
    return is_tables and any(_is_deep(item) for item in value)


def _is_deep(table: Mapping[str, Any]) -> bool:
    return len(table) > 4 or any(isinstance(value, Mapping | list | tuple) for value in table.values())


def _value(value: Any, *, in_line: bool = False) -> str:
    if isinstance(value, Mapping):
        if not value:
            return "{}"
        return "{ " + ", ".join(f"{_key(key)} = {_value(item, in_line=in_line)}" for key, item in value.items()) + " }"
    if isinstance(value, Sequence) and not isinstance(value, str):
        if value and all(isinstance(item, Mapping) for item in value) and not in_line:
            return "[\n" + "".join(f"    {_value(item)},\n" for item in value) + "]"
        return "[" + ", ".join(_value(item, in_line=in_line) for item in value) + "]"
    return json.dumps(value, ensure_ascii=False)  # TOML's basic strings, numbers and truth values are written as JSON's


def _key(word: str) -> str:
    plain = word.isascii() and word.replace("-", "").replace("_", "").isalnum()
    return word if plain else json.dumps(word, ensure_ascii=False)
