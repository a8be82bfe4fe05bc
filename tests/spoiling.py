"""Files spoilt at random, each by its seed: data with junk in it, texts and bytes cut, doubled and turned, rows of a store."""

import json
import math
import random
import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any

JUNK: tuple[Any, ...] = (
    math.nan, math.inf, -math.inf, 0, -1, 1, 2**31, -(2**63), 2**70, 10**400, 1e300, -1e300, 1e-320, 0.0, -0.0, True, False,
    "", " ", "nan in", "inf m", "-3 in", "3 parsec", "1e999 in", "3 in in", "3", "in", "9" * 300 + " m", "0 m", "1e300 m", "-1e9 m",
    "1e-300 m", "360 deg", "7 deg", "1e308 deg", "\x00", "é" * 50, "../../etc", "right", "nobody", "thesis", "x" * 5000,
    "\x1b]0;x\x07\x9b31m", "/dev/zero", "~nobody/x.toml", "$\\frac{1}{", " " * 3000 + "x", "9" * 5000, "a" * 300 + ".toml",
    [], [[]], [1, 2, 3], ["1 in"], ["1 in", "2 in"], [["0 m", "0 m"]] * 3, {}, {"value": 1}, {"value": "a", "unit": "in"},
    {"value": math.nan, "unit": "in"}, {"value": 3, "unit": "in", "source": 4}, {"unit": []}, {"value": 10**400, "unit": "in"},
)  # fmt: skip
CELLS = (
    "", " ", "nan", "inf", "1e999", "-1", "x" * 200_000, '"', "\r", "\n", "#", "1_000", "٣", "\x00", "1e308", "-1e308", "9" * 400, ";",
    "1,2",
    " " * 3000 + "x", "[", "x [in] ]", "\x1b[31m",
)  # fmt: skip


def toml(value: Any) -> str:
    """Plain data as a TOML value on one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float) and not math.isfinite(value):
        return "nan" if math.isnan(value) else ("inf" if value > 0 else "-inf")
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value)


def toml_file(data: dict[str, Any]) -> str:
    """Plain data as a TOML file."""
    return "".join(f"{json.dumps(key)} = {toml(value)}\n" for key, value in data.items())


def places(value: Any) -> list[tuple[Any, Any]]:
    """Every (container, key or index) of nested data."""
    keys: list[Any] = list(value) if isinstance(value, dict) else list(range(len(value)))
    found = [(value, key) for key in keys]
    for key in keys:
        if isinstance(value[key], dict | list):
            found += places(value[key])
    return found


def spoil_data(rng: random.Random, data: dict[str, Any]) -> None:
    """One change to the data: a key deleted, added, doubled or misspelt, a value of another kind or size, a table buried."""
    container, key = rng.choice(places(data))
    kind = rng.randrange(8)
    if kind == 0:
        del container[key]
    elif kind == 1 and isinstance(container, dict):
        container[rng.choice((f"{key}s", str(key).upper(), "?", "units", f"{key}.x"))] = container.pop(key)
    elif kind == 2 and isinstance(container, list):
        container.append(rng.choice((container[key], rng.choice(JUNK))))
    elif kind == 3:
        for _ in range(rng.choice((1, 5, 300))):
            container[key] = [container[key]] if rng.random() < 0.5 else {"value": container[key]}
    elif kind == 4 and isinstance(container[key], int | float) and not isinstance(container[key], bool):
        container[key] = container[key] * rng.choice((-1, 0, 1e-12, 1e12, 1e300, 1.5))
    elif kind == 5:
        other, name = rng.choice(places(data))
        container[key] = json.loads(json.dumps(other[name], default=str))
    else:
        container[key] = rng.choice(JUNK)


def spoil_bytes(rng: random.Random, text: bytes) -> bytes:
    """One change to a file's bytes: cut short, doubled, bits turned, junk put in, deeply nested."""
    raw = bytearray(text)
    at = rng.randrange(len(raw))
    kind = rng.randrange(7)
    if kind == 0:
        return bytes(raw[:at])
    if kind == 1:
        lines = text.splitlines(keepends=True)
        line = rng.randrange(len(lines))
        return b"".join([*lines[: line + 1], lines[line], *lines[line + 1 :]])
    if kind == 2:
        for _ in range(rng.choice((1, 10, 200))):
            raw[rng.randrange(len(raw))] ^= 1 << rng.randrange(8)
        return bytes(raw)
    if kind == 3:
        return bytes(raw[:at]) + rng.randbytes(rng.choice((1, 50, 1000))) + bytes(raw[at:])
    if kind == 4:
        deep = rng.choice((b"[", b"{", b'{"a":', b"a.", b"'.'.", b'"a".'))
        return b"deep = " + deep * rng.choice((10, 2000, 100000)) + bytes(raw)
    if kind == 5:
        return rng.choice((b"", b"\x00" * 100, b"\xff\xfe" + bytes(raw), b"\xef\xbb\xbf" + bytes(raw), b"[]", b"null"))
    end = min(len(raw), at + rng.choice((1, 20, 500)))
    return bytes(raw[:at] + raw[end:])


def spoilt(rng: random.Random, data: dict[str, Any], write: Callable[[dict[str, Any]], str]) -> bytes:
    """A file of plain data with one to five changes."""
    if rng.random() < 0.3:
        return spoil_bytes(rng, write(data).encode())
    for _ in range(rng.choice((1, 1, 1, 2, 5))):
        if data:
            spoil_data(rng, data)
    try:
        return write(data).encode("utf-8", "surrogatepass")
    except (ValueError, RecursionError):  # a number or a nesting that cannot even be written
        return spoil_bytes(rng, json.dumps(str(data)[:1000]).encode())


def spoilt_table(rng: random.Random, text: str) -> bytes:
    """A table with cells of junk, ends of line of other systems, rows and columns too many or too few."""
    if rng.random() < 0.3:
        return spoil_bytes(rng, text.encode())
    rows = [line.split(",") for line in text.splitlines()]
    for _ in range(rng.choice((1, 1, 3))):
        row = rng.choice(rows)
        at = rng.randrange(len(row))
        change = rng.randrange(6)
        if change == 0:
            row.pop(at)
        elif change == 1:
            row.insert(at, rng.choice(CELLS))
        elif change == 2:
            rows.insert(rng.randrange(len(rows)), list(row))
        elif change == 3:
            column = rng.choice(CELLS) if rng.random() < 0.5 else "5"
            for other in rows[1:]:
                if at < len(other):
                    other[at] = column
        else:
            row[at] = rng.choice(CELLS)
        rows = [row for row in rows if row] or [["x"]]
    ending = rng.choice(("\n", "\n", "\n", "\r\n", "\r", "\x0b", "\u2028"))
    return ending.join(",".join(row) for row in rows).encode("utf-8", "surrogatepass")


def spoil_store(rng: random.Random, path: Path) -> None:
    """A store with values of junk, or with its bytes spoilt."""
    if rng.random() < 0.3:
        path.write_bytes(spoil_bytes(rng, path.read_bytes()))
        return
    junk = rng.choice(
        (
            None,
            3,
            1e300,
            "x",
            "",
            "{}",
            "[]",
            "null",
            '{"a": NaN}',
            "[" * 5000,
            b"\xff\x00",
            -1,
            '{"status": "found"}',
            "9" * 5000,
            "\x1b[31m",
        )
    )
    table, column = rng.choice(
        [("items", name) for name in ("key", "item", "result", "seconds", "error", "tries")]
        + [("about", name) for name in ("key", "value")]
    )
    file = sqlite3.connect(path)
    try:
        with file:
            if rng.random() < 0.1:
                file.execute(f"DROP TABLE {table}")
            elif rng.random() < 0.2:
                file.execute(f"ALTER TABLE {table} RENAME COLUMN {column} TO other")
            else:
                rowid = rng.choice([number for (number,) in file.execute(f"SELECT rowid FROM {table}")])
                if rng.random() < 0.5 and column == "result":
                    (text,) = file.execute("SELECT result FROM items WHERE rowid = ?", (rowid,)).fetchone()
                    data = json.loads(text)
                    spoil_data(rng, data)
                    junk = json.dumps(data)
                file.execute(f"UPDATE {table} SET {column} = ? WHERE rowid = ?", (junk, rowid))
    except sqlite3.IntegrityError:
        pass
    finally:
        file.close()
