"""Overrides such as "start.y=6.2in": one key of a task, its robot or its board, set before anything is checked."""

import copy
import json
from collections.abc import Mapping, Sequence
from typing import Any

from ..errors import MISSING, SpecError, describe_choices
from ..files import Document, element_index, element_names, parse_toml
from ..types import Json
from ..units import QUANTITY_KEYS, split_quantity


def split_override(text: str) -> tuple[str, Any]:
    """Key and value of "key=value"; the value is read as TOML where it is TOML, else as a text.

    Raises:
        SpecError: If there is no key or no value.
    """
    key, equals, value = (part.strip() for part in text.partition("="))
    if not equals or not value or not all(key.split(".")):
        raise SpecError("--set", text or "(empty)", MISSING, "write key=value, such as start.y=6.2in")
    return key, _parse(value)


def _parse(text: str) -> Any:
    try:
        parsed = parse_toml(f"value = {text}")
    except ValueError:
        return text
    try:
        json.dumps(parsed)  # a date is TOML, but no plain data
    except TypeError:
        return text
    return parsed["value"] if len(parsed) == 1 else text


def apply_overrides(
    document: Document,
    overrides: Sequence[str],
    task_keys: Sequence[str],
    robot_keys: Sequence[str],
    short_keys: Mapping[str, str],
) -> Document:
    """A copy of a merged document with the overrides set, in order.

    A key starts with a key of the task, with "robot" or the world's key, or with a key of the robot.

    Args:
        document: The merged document.
        overrides: Texts "key=value".
        task_keys: Keys of the task itself, "robot" and the world's key included.
        robot_keys: Keys of the robot, which may stand first without "robot.".
        short_keys: Other words for whole keys.

    Raises:
        SpecError: If a key leads nowhere; unknown keys inside a table are found when the task is built.
    """
    data = copy.deepcopy(document.data)
    made: list[tuple[str, str]] = list(document.overrides)
    for text in overrides:
        key, value = split_override(text)
        words = short_keys.get(key, key).split(".")
        if words[0] not in task_keys:
            if words[0] not in robot_keys:
                known = (*task_keys, *(name for name in robot_keys if name not in task_keys))
                allowed = f"unknown key; a key starts with {describe_choices(words[0], known)}"
                raise SpecError(f"--set {text}", key, MISSING, allowed)
            words.insert(0, "robot")
        _set(data, words, value, text)
        made.append((".".join(words), text))
    return Document(document.label, data, tuple(made), document.folder)


def _set(data: Json, words: list[str], value: Any, text: str) -> None:
    here: Any = data
    for depth, word in enumerate(words[:-1]):
        so_far = ".".join(words[:depth])
        if isinstance(here, dict):
            here = here.setdefault(word, {})
        elif isinstance(here, list):
            here = here[_element(here, word, so_far, text)]
        else:
            raise SpecError(f"--set {text}", so_far, here, f"is a value, so it has no '{word}'; set {so_far} itself")
    last, so_far = words[-1], ".".join(words[:-1])
    if isinstance(here, dict):
        here[last] = _with_source(here.get(last), value)
    elif isinstance(here, list):
        index = _element(here, last, so_far, text)
        here[index] = _with_source(here[index], value)
    else:
        raise SpecError(f"--set {text}", so_far, here, f"is a value, so it has no '{last}'; set {so_far} itself")


def _element(elements: list[Any], word: str, key: str, text: str) -> int:
    index = element_index(elements, word)
    if index is None:
        allowed = f"has no '{word}'; it has {describe_choices(word, element_names(elements))}"
        raise SpecError(f"--set {text}", key, MISSING, allowed)
    return index


def _with_source(before: Any, value: Any) -> Any:
    """The new value; a quantity that stated its source now says that it was overridden."""
    was_quantity = isinstance(before, dict) and "value" in before and set(before) <= QUANTITY_KEYS
    if not was_quantity or isinstance(value, dict | list):
        return value
    parts = split_quantity(value) if isinstance(value, str) else None
    if parts is not None:
        return {"value": parts[0], "unit": parts[1], "source": "override"}
    if "unit" not in before and isinstance(value, int | float):
        return {"value": value, "source": "override"}
    return value
