"""A file to start from: every key of a spec, with what its docstring says, what is allowed, and what holds without it.

All words come from the spec itself, so such a file can't fall behind. Keys that are not stated stand there too, behind a "#" without a
blank: taking that away states them.
"""

import ast
import inspect
import textwrap
import types
import typing
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import MISSING, dataclass, field, fields, is_dataclass
from typing import Annotated, Any, Final, Literal, get_args, get_origin

from annotated_types import Ge, Le
from pydantic import StringConstraints
from pydantic.fields import FieldInfo

from .toml_text import toml_value
from .types import Json
from .units import DEGREE, UNITS, Quantity, si_unit

WIDTH: Final = 118
"""Of a comment, with its "# "."""
LEFT_OUT: Final = ("sources",)
"""Fields that no file states."""
Examples = Mapping[tuple[str, str], Any]
"""Name of a spec's class and its key -> a value to show where the key is not stated."""


@dataclass(frozen=True, slots=True)
class Key:
    """One key of a spec."""

    name: str
    kind: Any
    """Its annotation."""
    meaning: str
    """From the docstring below the field, or of the spec that it holds; empty where there is none."""
    default: Any
    """`dataclasses.MISSING` where it must be given."""

    @property
    def inner(self) -> type[Any] | None:
        """The spec of a table, or of each table of a list; None of a plain value."""
        bare = _bare(self.kind)
        if get_origin(bare) is tuple:
            bare = _bare(get_args(bare)[0])
        return bare if isinstance(bare, type) and is_dataclass(bare) else None

    @property
    def is_list(self) -> bool:
        """Whether it lists tables."""
        return get_origin(_bare(self.kind)) is tuple and self.inner is not None


def keys_of(cls: type[Any]) -> tuple[Key, ...]:
    """The keys of a spec, in order."""
    if cls not in _KNOWN:
        _KNOWN[cls] = tuple(_read_keys(cls))
    return _KNOWN[cls]


_KNOWN: Final[dict[type[Any], tuple[Key, ...]]] = {}
"""Sources are parsed once."""


def _read_keys(cls: type[Any]) -> Iterator[Key]:
    hints, docs = typing.get_type_hints(cls, include_extras=True), docs_of(cls)
    for each in fields(cls):
        if each.name in LEFT_OUT:
            continue
        default = each.default if each.default_factory is MISSING else each.default_factory()
        yield Key(each.name, hints[each.name], docs.get(each.name, ""), default)


def docs_of(cls: type[Any]) -> dict[str, str]:
    """Field -> the text below it, from the sources of the class and of those that it is derived from."""
    found: dict[str, str] = {}
    for base in reversed(cls.__mro__):
        if not is_dataclass(base):
            continue
        tree = ast.parse(textwrap.dedent(inspect.getsource(base))).body[0]
        assert isinstance(tree, ast.ClassDef)
        found |= field_docs(tree)
    return found


def field_docs(tree: ast.ClassDef) -> dict[str, str]:
    """Field -> the text below it, in one line, of those fields of a class that have one."""
    return {
        before.target.id: " ".join(inspect.cleandoc(after.value.value).split())  # type: ignore[attr-defined]
        for before, after in zip(tree.body, tree.body[1:], strict=False)
        if isinstance(before, ast.AnnAssign) and isinstance(before.target, ast.Name) and _is_text(after)
    }


def _is_text(node: ast.stmt) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def spec_text(
    cls: type[Any],
    data: Json,
    *,
    header: str,
    lead: Sequence[tuple[str, Any, str]] = (),
    examples: Examples | None = None,
) -> str:
    """The text of a TOML file that states `data` and tells of every key of the spec `cls`.

    Args:
        cls: The spec.
        data: What the file states; keys that the spec does not have are left out.
        header: Stands above, without "#".
        lead: Key, value and comment of what stands first and is not the spec's, such as `schema`.
        examples: Values of keys that are not stated and have no default that could be shown.
    """
    lines = _comment(header)
    for name, value, said in lead:
        lines += [*_comment(said), f"{name} = {toml_value(value)}"]
    _Writer(lines, examples or {}).table((), cls, data, live=True, told=False)
    return "\n".join(lines) + "\n"


@dataclass(frozen=True, slots=True)
class _Writer:
    """Writes tables; a spec whose keys were told once is not told again."""

    lines: list[str]
    examples: Examples
    known: set[type[Any]] = field(default_factory=set)
    """Specs whose tables were told key by key."""
    listed: set[type[Any]] = field(default_factory=set)
    """Specs whose keys were listed, for lists of small tables."""

    def table(self, path: tuple[str, ...], cls: type[Any], data: Json, *, live: bool, told: bool) -> None:
        """The keys of a table: plain values, then the tables in it. `told`: without comments and without what is not stated."""
        self.known.add(cls)
        later: list[Key] = []
        for key in keys_of(cls):
            if key.inner is not None and _stands_alone(key):
                later.append(key)
            elif key.name in data or not told:
                self._value(cls, key, data, live=live, told=told)
        for key in later:
            if key.name in data or not told:
                self._inner((*path, key.name), key, data.get(key.name), live=live, told=told)

    def _value(self, cls: type[Any], key: Key, data: Json, *, live: bool, told: bool) -> None:
        stated = key.name in data
        value = data[key.name] if stated else _shown(cls, key, self.examples)
        mark = "" if live and (stated or key.default is MISSING) else "#"
        if not told:
            self.lines.extend(("", *_comment(_told(key)), *self._tables_told(key)))
        rows = stated and key.inner is not None and value
        written = "[\n" + "".join(f"    {toml_value(row)},\n" for row in value) + "]" if rows else toml_value(value)
        self.lines.append(f"{mark}{key.name} = {written}")

    def _tables_told(self, key: Key) -> list[str]:
        """Of a list of small tables: a line for each of their keys."""
        if key.inner is None:
            return []
        if key.inner in self.listed:
            return ["# Each is a table with the same keys."]
        self.listed.add(key.inner)
        lines = ["# Each is a table of:"]
        for inner in keys_of(key.inner):
            words = "; ".join(word.rstrip(".") for word in (inner.meaning, allowed(inner.kind), _must(inner)) if word)
            lines += textwrap.wrap(
                f"{inner.name}: {words}.", WIDTH, initial_indent="#   ", subsequent_indent="#       "
            )
        return lines

    def _inner(self, path: tuple[str, ...], key: Key, value: Any, *, live: bool, told: bool) -> None:
        assert key.inner is not None
        stated = value is not None
        mark, title = "" if live and stated else "#", ".".join(path)
        told = told or key.inner in self.known
        for index, table in enumerate(value if key.is_list and stated else [value or {}]):
            self.lines.append("")
            if not told and index == 0:
                self.lines.extend(_comment(_told(key)))
            self.lines.append(f"{mark}[[{title}]]" if key.is_list else f"{mark}[{title}]")
            self.table(path, key.inner, table, live=live and stated, told=told or index > 0)


def _stands_alone(key: Key) -> bool:
    """Whether a key gets headings of its own; lists of small tables stay lists, so that many holds stay readable."""
    assert key.inner is not None
    return not key.is_list or any(inner.inner is not None for inner in keys_of(key.inner))


def _shown(cls: type[Any], key: Key, examples: Examples) -> Any:
    """A value for a key that is not stated: its default, an example, or the least surprising one of its kind."""
    if (cls.__name__, key.name) in examples:
        return examples[cls.__name__, key.name]
    if key.default is not MISSING and key.default is not None:
        return _as_written(key.kind, key.default)
    return _sample(key.kind)


def _as_written(kind: Any, value: Any) -> Any:
    """A default as a file states it: quantities with their SI unit."""
    quantity = _quantity(kind)
    if quantity is not None:
        return _with_unit(quantity, value)
    if get_origin(_bare(kind)) is tuple and isinstance(value, tuple):
        inner = get_args(_bare(kind))
        return [_as_written(inner[0], item) for item in value]
    return dict(value) if isinstance(value, Mapping) else value


def _with_unit(quantity: Quantity, value: float) -> Any:
    if quantity.dimension == "angle":
        return f"{value / DEGREE:.9g} deg"
    return float(f"{value:.9g}") if quantity.dimension == "ratio" else f"{value:.9g} {si_unit(quantity.dimension)}"


def _sample(kind: Any) -> Any:
    """Some value of a kind."""
    quantity, bare = _quantity(kind), _bare(kind)
    if quantity is not None:
        plain = 10.0 * DEGREE if quantity.dimension == "angle" else 1.0
        return _with_unit(quantity, min(plain, plain if quantity.at_most is None else quantity.at_most))
    if get_origin(bare) is Literal:
        return get_args(bare)[0]
    if get_origin(bare) is tuple:
        inner = get_args(bare)
        return [_sample(each) for each in inner if each is not Ellipsis] if Ellipsis not in inner else []
    if get_origin(bare) in {dict, Mapping}:
        return {}
    return {bool: True, int: 1, str: ""}.get(bare, "")


def _told(key: Key) -> str:
    """What a comment says of a key: its meaning, what is allowed, what holds without it."""
    words = [key.meaning] if key.meaning else []
    if key.inner is None:
        words.append(allowed(key.kind).capitalize() if not key.meaning else _first_upper(allowed(key.kind)))
    else:
        words.append(inspect.getdoc(key.inner) or "")
    if key.default is MISSING:
        words.append(_must(key).capitalize())
    elif key.inner is None and key.default not in (None, "", (), {}):
        words.append(f"{toml_value(_as_written(key.kind, key.default))} unless stated")
    else:
        words.append("May be left out")
    return " ".join(f"{word.rstrip('.')}." for word in words if word)


def _must(key: Key) -> str:
    """Whether a key has to be there; empty where its meaning says so."""
    if "unless stated" in key.meaning:
        return ""
    return "must be given" if key.default is MISSING else "may be left out"


def _first_upper(text: str) -> str:
    return text[:1].upper() + text[1:]


def allowed(kind: Any) -> str:
    """What a value of a kind may be, in words."""
    quantity, bare = _quantity(kind), _bare(kind)
    if quantity is not None:
        return _quantity_words(quantity)
    if get_origin(bare) is Literal:
        return f"one of {', '.join(toml_value(word) for word in get_args(bare))}"
    if get_origin(bare) is tuple:
        return _tuple_words(get_args(bare))
    if get_origin(bare) in {dict, Mapping}:
        return f"a table of names, each with {allowed(get_args(bare)[1])}"
    if get_origin(bare) in {typing.Union, types.UnionType}:
        return " or ".join(allowed(each) for each in get_args(bare))
    if isinstance(bare, type) and is_dataclass(bare):
        return f"a table with {', '.join(key.name for key in keys_of(bare))}"
    if any(isinstance(note, StringConstraints) for note in _notes(kind)):
        return "a name of letters, digits, '_' and '-', a letter first"
    words = {bool: "true or false", int: "a whole number", str: "a text in quotes"}.get(
        bare, "a whole number, 0 or more"
    )
    return words + _bounds(kind)


def _quantity_words(quantity: Quantity) -> str:
    units = UNITS[quantity.dimension]
    words = "a number" if quantity.dimension == "ratio" else f"{quantity.dimension} with its unit ({', '.join(units)})"
    for form, bound in (
        ("more than ", quantity.above),
        ("at least ", quantity.at_least),
        ("at most ", quantity.at_most),
    ):
        words += "" if bound is None else f", {form}{str(_with_unit(quantity, bound)).removesuffix('.0')}"
    return words


def _tuple_words(inner: tuple[Any, ...]) -> str:
    if Ellipsis in inner:
        return f"a list, each {allowed(inner[0])}"
    same = all(each == inner[0] for each in inner)
    return f"a list of {len(inner)}, each {allowed(inner[0])}" if same else f"a list: {', '.join(map(allowed, inner))}"


def _bounds(kind: Any) -> str:
    words = ""
    for note in _notes(kind):
        for bound in note.metadata if isinstance(note, FieldInfo) else ():
            words += f", {bound.ge} or more" if isinstance(bound, Ge) else ""
            words += f", {bound.le} or less" if isinstance(bound, Le) else ""
    return words


def _quantity(kind: Any) -> Quantity | None:
    return next((note for note in _notes(kind) if isinstance(note, Quantity)), None)


def _notes(kind: Any) -> tuple[Any, ...]:
    """What `Annotated` says of a kind, through `| None`."""
    if get_origin(kind) is Annotated:
        inner, *notes = get_args(kind)
        return (*notes, *_notes(inner))
    options = _options(kind)
    return _notes(options[0]) if len(options) == 1 else ()


def _bare(kind: Any) -> Any:
    """The kind without `Annotated` and without `| None`."""
    if get_origin(kind) is Annotated:
        return _bare(get_args(kind)[0])
    options = _options(kind)
    return _bare(options[0]) if len(options) == 1 else kind


def _options(kind: Any) -> tuple[Any, ...]:
    if get_origin(kind) not in {typing.Union, types.UnionType}:
        return ()
    return tuple(each for each in get_args(kind) if each is not type(None))


def _comment(text: str) -> list[str]:
    return [f"# {line}" for part in text.splitlines() for line in textwrap.wrap(part, WIDTH - 2)]
