"""Batches over worker processes: order, deaths of workers and of the whole, stores that refuse what isn't theirs."""

import json
import os
import random
import shutil
import signal
import sqlite3
import subprocess
import sys
import threading
import time
from collections import Counter
from contextlib import suppress
from pathlib import Path

import pytest
from jobs_by_hand import batch, square

import clamber
from clamber.errors import FileError, SpecError
from clamber.jobs import StoreError, look_into, map_items, read_result
from clamber.jobs.release import release
from clamber.jobs.store import Store
from clamber.planning.sweep import Point
from clamber.sources import PACKAGE, package_hash


def ran(log: Path) -> Counter[int]:
    """How often each item was run."""
    return Counter(int(line.split()[0]) for line in log.read_text().splitlines()) if log.exists() else Counter()


def finished(store: Path) -> int:
    if not store.exists():
        return 0
    with sqlite3.connect(store, timeout=0.0) as file:
        return int(file.execute("SELECT count(*) FROM items WHERE error IS NULL").fetchone()[0])


@pytest.mark.parametrize("workers", [1, 2, 4])
def test_results_come_in_the_order_of_the_items(workers: int) -> None:
    items = [{"n": n, "sleep": 0.02 * (n % 3 == 0)} for n in range(12)]
    told = map_items(square, items, workers=workers)
    assert [one.result for one in told] == [{"square": n**2, "blas": "1"} for n in range(12)]


def test_equal_items_run_once(tmp_path: Path) -> None:
    item = {"n": 7, "log": str(tmp_path / "log")}
    assert [one.result["square"] for one in map_items(square, [item, item]) if one.result] == [49, 49]
    assert ran(tmp_path / "log") == {7: 1}


def test_a_killed_worker_loses_and_repeats_no_finished_item(tmp_path: Path) -> None:
    items = [{"n": n, "log": str(tmp_path / "log")} for n in range(10)]
    items[4]["die_once"] = str(tmp_path / "died")
    told = map_items(square, items, workers=2, store=tmp_path / "store.db")
    assert [one.result["square"] for one in told if one.result] == [n**2 for n in range(10)]
    assert ran(tmp_path / "log") == Counter(range(10)) + Counter([4])
    assert [one.tries for one in told] == [1, 1, 1, 1, 2, 1, 1, 1, 1, 1]


def test_what_always_kills_its_worker_or_raises_is_an_outcome_and_harms_no_other() -> None:
    told = map_items(square, [{"n": 1}, {"n": 2, "die": True}, {"n": 3, "raise": True}, {"n": 4}], workers=2)
    assert told[1].error == "its worker process died 3 times, with exit code 3" and told[1].tries == 3
    assert told[2].error == "ValueError: thirteen is not liked"
    assert [one.result is None for one in told] == [False, True, True, False]


@pytest.mark.slow
@pytest.mark.parametrize("stop", [signal.SIGKILL, signal.SIGINT])
def test_a_batch_stopped_at_several_moments_ends_with_the_same_results_and_runs_nothing_finished_again(
    tmp_path: Path, stop: signal.Signals
) -> None:
    store, log = tmp_path / "store.db", tmp_path / "log"
    n, sleep = 96, 0.04  # so long that a stop reaches it on a busy machine, too
    for enough in (1, 4, 9):
        process = start_batch(tmp_path, n, sleep)
        while process.poll() is None and sum(ran(log).values()) < enough:
            time.sleep(0.005)
        process.send_signal(stop)
        process.wait(30)
        time.sleep(0.1)  # its workers leave with it
        kept = finished(store)
        before = ran(log)
    assert 0 < kept < n
    with sqlite3.connect(store) as file:
        names = [row[0] for row in file.execute("SELECT json_extract(item, '$.n') FROM items")]
    told = map_items(square, batch(tmp_path, n, sleep), workers=2, store=store, about=None, resume=True)
    assert [one.result["square"] for one in told if one.result] == [k**2 for k in range(n)]
    assert [one.stored for one in told].count(True) == kept
    assert all(ran(log)[name] == before[name] for name in names), "a finished item was run again"
    assert finished(store) == n


def start_batch(folder: Path, *size: object) -> "subprocess.Popen[bytes]":
    path = os.pathsep.join((str(Path(clamber.__file__).parents[1]), str(Path(__file__).parent)))
    command = [sys.executable, str(Path(__file__).parent / "jobs_by_hand.py"), str(folder), *map(str, size)]
    return subprocess.Popen(command, env=os.environ | {"PYTHONPATH": path}, stderr=subprocess.PIPE)


MOMENTS = [3, pytest.param(20, marks=pytest.mark.slow)]


@pytest.mark.slow
@pytest.mark.parametrize("kills", MOMENTS)
def test_a_whole_batch_killed_at_random_moments_loses_and_repeats_no_finished_item(tmp_path: Path, kills: int) -> None:
    n, sleep = 12 * kills, 0.02
    store, log, chance = tmp_path / "store.db", tmp_path / "log", random.Random(kills)
    kept: set[int] = set()
    before: Counter[int] = Counter()
    for _ in range(kills):
        process = start_batch(tmp_path, n, sleep)
        least = sum(ran(log).values())
        while process.poll() is None and sum(ran(log).values()) == least:
            time.sleep(0.002)  # it has begun
        time.sleep(chance.uniform(0.0, 10.0 * sleep))
        process.kill()
        process.wait(30)
        time.sleep(0.1)  # its workers leave with it
        now = ran(log)
        assert all(now[k] == before[k] for k in kept), "a finished item was run again"
        rows = rows_of(store)
        assert kept <= set(rows), "a finished item was lost"
        kept, before = set(rows), now
    assert len(kept) > 0
    told = map_items(square, batch(tmp_path, n, sleep), workers=2, store=store, resume=True)
    assert all(ran(log)[k] == before[k] for k in kept)
    assert [one.stored for one in told] == [k in kept for k in range(n)]
    assert [one.result for one in told] == [one.result for one in map_items(square, [{"n": k} for k in range(n)])]


@pytest.mark.slow
@pytest.mark.parametrize("kills", MOMENTS)
def test_workers_killed_at_random_moments_lose_and_repeat_no_finished_item(tmp_path: Path, kills: int) -> None:
    n, sleep = 12 * kills, 0.02
    store, log, chance = tmp_path / "store.db", tmp_path / "log", random.Random(kills)
    process = start_batch(tmp_path, n, sleep)
    before: list[tuple[set[int], Counter[int]]] = []
    for moment in sorted(chance.sample(range(2, 10 * kills), kills)):
        while sum(ran(log).values()) < moment:
            time.sleep(0.002)
        time.sleep(chance.uniform(0.0, sleep))
        before.append((set(rows_of(store)), ran(log)))
        with suppress(ProcessLookupError):
            os.kill(int(log.read_text().splitlines()[-1].split()[1]), signal.SIGKILL)
    assert process.wait(60) == 0
    for kept, counts in before:
        assert all(ran(log)[k] == counts[k] for k in kept), "a finished item was run again"
    rows = rows_of(store)
    assert {k: json.loads(text)["square"] for k, text in rows.items()} == {k: k**2 for k in range(n)}
    assert sum(ran(log).values()) <= n + kills, "a killed worker takes one item with it"


def rows_of(store: Path) -> dict[int, str]:
    """Item -> result, of what a store has finished."""
    file = sqlite3.connect(store, timeout=5.0)
    query = "SELECT json_extract(item, '$.n'), result FROM items WHERE error IS NULL"
    rows: dict[int, str] = dict(file.execute(query)) if store.exists() and store.stat().st_size else {}
    file.close()
    return rows


def test_a_store_refuses_what_is_not_its_own(tmp_path: Path) -> None:
    store = tmp_path / "store.db"
    map_items(square, [{"n": 1}], store=store, about={"a": 1}, title="batch one")
    with pytest.raises(StoreError, match=r"store\.db: holds the results of batch one, not batch two; name another"):
        map_items(square, [{"n": 1}], store=store, about={"a": 2}, title="batch two", resume=True)
    with pytest.raises(StoreError, match="has 1 finished items of this batch; resume it, or name another file"):
        map_items(square, [{"n": 1}], store=store, about={"a": 1}, title="batch one")
    (tmp_path / "text").write_text("no database at all, but longer than a header of one hundred bytes" * 3)
    with pytest.raises(StoreError, match="is no store of results"):
        map_items(square, [{"n": 1}], store=tmp_path / "text")
    with pytest.raises(FileError, match="does not exist; make it first"):
        map_items(square, [{"n": 1}], store=tmp_path / "no" / "store.db")


def change(store: Path, words: str, *values: str) -> None:
    with sqlite3.connect(store) as file:
        file.execute(words, values)
    file.close()


def test_results_of_other_code_are_refused_by_name(tmp_path: Path) -> None:
    store = tmp_path / "store.db"
    told = {"about": {"a": 1}, "title": "batch one", "store": store, "resume": True}
    map_items(square, [{"n": 1}], **told)
    map_items(square, [{"n": 1}, {"n": 2}], **told)
    kept = release()
    assert kept["files"] and kept["python"] and kept["numpy"] and kept["mujoco"]
    for part in kept:
        other = json.dumps(kept | {part: "other"})
        change(store, "UPDATE about SET value = ? WHERE key = 'release'", other)
        allowed = "go on with the code that began it, or name another file"
        with pytest.raises(StoreError, match=rf"another release of Clamber \({part} other, not .*\); {allowed}"):
            map_items(square, [{"n": 1}], **told)
        with pytest.raises(StoreError, match=f"{part} other"):
            look_into(store, square, about={"a": 1}, title="batch one")
    change(store, "DELETE FROM about WHERE key = 'release'")  # as stores were before
    with pytest.raises(StoreError, match="another release of Clamber"):
        map_items(square, [{"n": 1}], **told)


@pytest.mark.parametrize(
    "name", ["cli/list.py", "families/climber/data/robots/libra.toml", "viewing/report/templates/base.html", "units.py"]
)
def test_a_release_knows_every_file_of_the_package(tmp_path: Path, name: str) -> None:
    copy = tmp_path / "clamber"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    assert package_hash(copy) == package_hash(PACKAGE)
    file = copy / name
    assert file.is_file()
    file.write_bytes(file.read_bytes() + b"\n")
    package_hash.cache_clear()
    assert package_hash(copy) != package_hash(PACKAGE)


@pytest.mark.parametrize(
    "row", ['{"square": NaN, "blas": "1"}', '{"square": 1e999}', '{"square": 1', "[1, 2]", "", "{" * 9000]
)
def test_a_damaged_row_is_refused_by_name(tmp_path: Path, row: str) -> None:
    store = tmp_path / "store.db"
    told = {"store": store, "resume": True, "title": "batch one"}
    map_items(square, [{"n": 1}], **told)
    change(store, "UPDATE items SET result = ?", row)
    with pytest.raises(StoreError, match=r"store\.db: finished item 1 is damaged; name another file"):
        map_items(square, [{"n": 1}], **told)


def test_a_result_without_its_fields_is_refused_by_name(tmp_path: Path) -> None:
    store = tmp_path / "store.db"
    with pytest.raises(SpecError, match=r"store\.db: a stored result: length = 'long': must be a"):
        read_result(Point, {"values": ["1"], "status": "found", "reason": "", "length": "long"}, store)
    with pytest.raises(SpecError, match="status: must be given"):
        read_result(Point, {"values": ["1"], "reason": ""}, store)


@pytest.mark.slow
def test_two_runs_at_once_on_one_store_are_refused(tmp_path: Path) -> None:
    store = tmp_path / "store.db"
    other = sqlite3.connect(store, isolation_level=None)
    other.execute("BEGIN EXCLUSIVE")
    with pytest.raises(StoreError, match="is in use by another process"):
        map_items(square, [{"n": 1}], store=store)
    other.close()


def test_a_store_keeps_its_first_note_and_shows_what_is_in_it(tmp_path: Path) -> None:
    store, batch_one = tmp_path / "store.db", {"about": {"a": 1}, "title": "batch one"}
    assert look_into(store, square, **batch_one) is None
    assert not store.exists()
    map_items(square, [{"n": 2}], store=store, note={"plan": 1}, **batch_one)
    map_items(square, [{"n": 2}, {"n": 3}], store=store, note={"plan": 2}, resume=True, **batch_one)
    kept = look_into(store, square, **batch_one)
    assert kept is not None
    assert kept.note == {"plan": 1}
    assert sorted(result["square"] for result in kept.results) == [4, 9]
    with pytest.raises(StoreError, match="holds the results of batch one"):
        look_into(store, square, about={"a": 2}, title="batch two")


@pytest.mark.slow
def test_a_result_waits_for_a_locked_store_and_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "store.db"
    with Store(path, "id", "batch", resume=False) as store:
        other = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
        other.execute("BEGIN IMMEDIATE")
        freed = threading.Timer(2.5, lambda: other.execute("ROLLBACK"))
        freed.start()
        store.keep("a", "{}", "{}", 1.0, None, 1)  # it was given up after a second
        freed.join()
        assert "is locked by another process; waiting for it" in capsys.readouterr().err
        other.execute("BEGIN IMMEDIATE")
        monkeypatch.setattr("clamber.jobs.store.PATIENCE", 0.5)
        with pytest.raises(StoreError, match=r"cannot be written \(database is locked\); what is in it stays"):
            store.keep("b", "{}", "{}", 1.0, None, 1)
        other.close()
        assert [key for key, *_ in store.finished()] == ["a"]


@pytest.mark.parametrize(
    ("column", "value"),
    [("result", "{"), ("result", None), ("result", '{"a": NaN}'), ("result", b"\xff"), ("seconds", "x"), ("tries", "x"),
     ("key", 3), ("result", "[" * 5000)],
)  # fmt: skip
def test_a_damaged_row_is_refused(tmp_path: Path, column: str, value: object) -> None:
    path = tmp_path / "store.db"
    with Store(path, "id", "batch", resume=False) as store:
        store.keep("a", "{}", "{}", 1.0, None, 1)
    with sqlite3.connect(path) as file, suppress(sqlite3.IntegrityError):
        file.execute(f"UPDATE items SET {column} = ?", (value,))
    with Store(path, "id", "batch", resume=True) as store:
        if column == "key":
            assert [key for key, *_ in store.finished()] == ["3"]  # SQLite makes a text of it
        else:
            with pytest.raises(StoreError, match="finished item 1 is damaged; name another file"):
                list(store.finished())
