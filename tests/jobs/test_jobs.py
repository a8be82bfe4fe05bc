"""Batches over worker processes: order, deaths of workers and of the whole, stores that refuse what isn't theirs."""

import json
import os
import random
import signal
import sqlite3
import subprocess
import sys
import time
from collections import Counter
from contextlib import suppress
from pathlib import Path

import pytest
from jobs_by_hand import batch, square

import clamber
from clamber.jobs import StoreError, look_into, map_items


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


@pytest.mark.parametrize("stop", [signal.SIGKILL, signal.SIGINT])
def test_a_batch_stopped_at_several_moments_ends_with_the_same_results_and_runs_nothing_finished_again(
    tmp_path: Path, stop: signal.Signals
) -> None:
    store, log = tmp_path / "store.db", tmp_path / "log"
    for enough in (1, 4, 9):
        process = start_batch(tmp_path)
        while process.poll() is None and sum(ran(log).values()) < enough:
            time.sleep(0.005)
        process.send_signal(stop)
        process.wait(30)
        time.sleep(0.1)  # its workers leave with it
        kept = finished(store)
        before = ran(log)
    assert 0 < kept < 16
    with sqlite3.connect(store) as file:
        names = [row[0] for row in file.execute("SELECT json_extract(item, '$.n') FROM items")]
    told = map_items(square, batch(tmp_path), workers=2, store=store, about=None, resume=True)
    assert [one.result["square"] for one in told if one.result] == [n**2 for n in range(16)]
    assert [one.stored for one in told].count(True) == kept
    assert all(ran(log)[name] == before[name] for name in names), "a finished item was run again"
    assert finished(store) == 16


def start_batch(folder: Path, *size: object) -> "subprocess.Popen[bytes]":
    path = os.pathsep.join((str(Path(clamber.__file__).parents[1]), str(Path(__file__).parent)))
    command = [sys.executable, str(Path(__file__).parent / "jobs_by_hand.py"), str(folder), *map(str, size)]
    return subprocess.Popen(command, env=os.environ | {"PYTHONPATH": path}, stderr=subprocess.PIPE)


MOMENTS = [3, pytest.param(20, marks=pytest.mark.slow)]


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
    with pytest.raises(StoreError, match="does not exist; make it first"):
        map_items(square, [{"n": 1}], store=tmp_path / "no" / "store.db")


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
