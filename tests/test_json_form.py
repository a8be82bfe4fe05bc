"""Dataclasses as JSON: their fields are the keys, unless metadata or a mark says otherwise."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

import numpy as np

from clamber.json_form import HIDDEN, INLINE, Jsonable, Key, OrNull, entries_of, in_json, plain


@dataclass(frozen=True, slots=True)
class Place:
    x: Annotated[float, Key("x_m"), Key("x_mm", per=1e-3)]
    names: tuple[str, ...] = ("a", "b")


@dataclass(frozen=True, slots=True)
class Report(Jsonable):
    secret: Annotated[int, HIDDEN]
    place: Annotated[Place, INLINE]
    gap: OrNull
    done: bool = False
    late: Annotated[int, Key(after="x_m")] = 3
    note: Annotated[str | None, Key(may_be_missing=True)] = None
    size: Annotated[tuple[int, ...] | None, Key("count", get=len, kind=int)] = None
    rows: dict[str, list[Place]] = field(default_factory=dict)

    @property
    @in_json(after="done")
    def doubled(self) -> int:
        """Twice the secret."""
        return 2 * self.secret

    @in_json(key="total")
    def add_up(self) -> float:
        """All of it."""
        return self.secret + self.place.x


@dataclass(frozen=True, slots=True)
class Judged(Jsonable):
    report: Annotated[Report, INLINE]

    @in_json()
    def done(self) -> bool:
        """In place of what the report says."""
        return True


REPORT = Report(4, Place(0.5), float("inf"), rows={"r": [Place(1.0, ())]})


def test_fields_are_keys_in_order_but_where_they_say_otherwise() -> None:
    assert list(REPORT.to_json().items()) == [
        ("x_m", 0.5), ("late", 3), ("x_mm", 500.0), ("names", ["a", "b"]), ("gap", None), ("done", False), ("doubled", 8),
        ("count", None), ("rows", {"r": [{"x_m": 1.0, "x_mm": 1000.0, "names": []}]}), ("total", 4.5),
    ]  # fmt: skip


def test_what_may_be_missing_is_there_with_a_value() -> None:
    told = Report(1, Place(0.0), 1.0, note="so", size=(7, 8)).to_json()
    assert (told["note"], told["count"], told["gap"]) == ("so", 2, 1.0)


def test_a_key_of_the_class_takes_the_place_of_an_inlined_one() -> None:
    told = Judged(REPORT).to_json()
    assert list(told) == list(REPORT.to_json()) and told["done"] is True


def test_kinds_are_those_of_what_stands_in_json() -> None:
    kinds = {entry.key: entry.kind for entry in entries_of(Report)}
    assert (kinds["gap"], kinds["count"], kinds["doubled"]) == (float | None, int | None, int)


def test_any_value_becomes_plain() -> None:
    values = (np.float64(2.0), np.array([1.0, np.nan]), range(2), Path("a"), np.int32(3), None, True)
    assert plain(values) == [2.0, [1.0, None], [0, 1], "a", 3, None, True]
    assert [type(each) for each in plain(values)[:1]] == [float]
