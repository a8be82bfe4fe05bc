"""Compiled kernels: a warm cache never answers for source that has changed, and threads and runs never change an answer."""

import ast
import gc
import importlib
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any, NamedTuple

import numpy as np
import pytest
from numba.core.registry import CPUDispatcher

from clamber.compiled import Handle, kernel, opened, ready
from clamber.families.climber.planning.problem import LimbedProblem
from clamber.kernel_cache import kernel_hash
from clamber.planning.problem import codes
from clamber.planning.problem.arrays import ActionTable
from clamber.planning.problem.codes import pack
from clamber.sources import PACKAGE, kernel_files, package_hash
from clamber.tasks import load_task

FAMILY = """
import numpy as np

from clamber.planning.problem.family_kernels import SCALARS, family_kernels
from clamber.planning.problem.tiny_rule import grown
from clamber.compiled import kernel

PARAMS = np.dtype([("gain", "f8")], align=True)
STANCE = np.dtype([("x", "f8")], align=True)


@kernel
def step(p, before, code, after, margins):
    after.x = grown(before.x, p.gain) + code
    return -1


@kernel
def nothing(p, s):
    return 0


family_kernels(PARAMS, **{name: step if name == "step" else nothing for name in SCALARS})
"""
RULE = """
from clamber.compiled import kernel


@kernel
def grown(x, gain):
    return x * gain
"""
RUN = """
import numpy as np
from clamber.planning.problem.loops import replay
from clamber.planning.problem.tiny import PARAMS, STANCE

params, start, stances = np.zeros(1, PARAMS), np.zeros(1, STANCE), np.zeros(4, STANCE)
params["gain"] = 3.0
replay(params[0], start, np.array([1, 0, 2], np.int32), True, stances, np.zeros((3, 1)), np.zeros(3, np.int32))
hits = sum(replay.stats.cache_hits.values())
print(stances["x"][-1], hits)
"""


def copied(folder: Path) -> Path:
    """The package without its data, and a family of a few lines in it whose step calls a kernel of another file."""
    package = folder / "clamber"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__", "data"))
    (package / "planning" / "problem" / "tiny.py").write_text(FAMILY)
    (package / "planning" / "problem" / "tiny_rule.py").write_text(RULE)
    return package


def answer(package: Path, cache: Path, run: str = RUN) -> tuple[float, int]:
    """What the copy computes in a process of its own, and how often its cache had the machine code."""
    environment = {
        **os.environ,
        "CLAMBER_CACHE": str(cache),
        "PYTHONPATH": str(package.parent),
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    done = subprocess.run([sys.executable, "-c", run], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    value, hits = done.stdout.split()
    return float(value), int(hits)


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


@pytest.mark.slow
def test_an_edited_kernel_answers_anew_though_the_cache_is_warm(tmp_path: Path) -> None:
    package, cache = copied(tmp_path), tmp_path / "cache"
    assert answer(package, cache) == (11.0, 0)
    assert answer(package, cache) == (11.0, 1)
    edit(package / "planning" / "problem" / "tiny_rule.py", "x * gain", "x * gain + 1.0")  # a helper in another file
    assert answer(package, cache) == (24.0, 0)
    edit(package / "planning" / "problem" / "tiny.py", "+ code", "- code")  # the step itself
    assert answer(package, cache) == (2.0, 0)
    edit(package / "planning" / "problem" / "tiny.py", "- code", "+ code")
    edit(package / "planning" / "problem" / "tiny_rule.py", "x * gain + 1.0", "x * gain")
    assert answer(package, cache) == (11.0, 1)  # the old sources find their old machine code


def hash_of(package: Path) -> str:
    """The hash of a package's kernels as its files are now."""
    kernel_hash.cache_clear()
    package_hash.cache_clear()
    return kernel_hash(package)


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        "planning/problem/family_kernels.py",
        "planning/problem/loops.py",
        "families/climber/statics/programme.py",
        "compiled.py",
    ],
)
def test_the_hash_follows_every_file_that_decides_what_is_compiled(tmp_path: Path, name: str) -> None:
    package = copied(tmp_path)
    before = hash_of(package)
    edit(package / name, "\n", "\n\n")
    assert hash_of(package) != before


@pytest.mark.slow
def test_the_hash_leaves_out_files_that_no_kernel_reads_from(tmp_path: Path) -> None:
    package = copied(tmp_path)
    before = hash_of(package)
    edit(package / "units.py", "\n", "\n\n")
    edit(package / "cli" / "doctor.py", '"system"', '"machine"')
    records = package / "planning" / "exact" / "records.py"
    edit(records, "What an exact search reads", "All that it reads")  # nor what it says beside its constants
    assert hash_of(package) == before
    assert package / "units.py" not in kernel_files(package)
    assert package / "planning" / "problem" / "family_kernels.py" in kernel_files(package)


def kernel_modules() -> list[ModuleType]:
    names = (path.relative_to(PACKAGE.parent).with_suffix("").parts for path in kernel_files())
    return [importlib.import_module(".".join(words).removesuffix(".__init__")) for words in names]


def codes_in(code: CodeType) -> Iterator[CodeType]:
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from codes_in(constant)


def defined_in(module: str, name: str) -> tuple[Path, str]:
    """The file in which a name of a module gets its value, and its name there."""
    found = importlib.import_module(module)
    assert found.__file__ is not None
    path = Path(found.__file__)
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.ImportFrom):
            for alias in node.names:
                if (alias.asname or alias.name) == name:
                    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
                    origin = importlib.util.resolve_name("." * node.level + (node.module or ""), package)
                    return defined_in(origin, alias.name) if origin.startswith("clamber") else (path, name)
    return path, name


def frozen_constants() -> set[tuple[Path, str]]:
    """File and name of every value, neither function nor module, that some kernel reads from outside of itself."""
    found = set()
    for module in kernel_modules():
        for compiled in (value for value in vars(module).values() if isinstance(value, CPUDispatcher)):
            function = compiled.py_func
            for code in codes_in(function.__code__):
                for name in code.co_names:
                    value = function.__globals__.get(name)
                    if isinstance(
                        value, int | float | complex | str | bytes | tuple | np.ndarray | np.dtype | np.generic
                    ):
                        found.add(defined_in(function.__module__, name))
    return found


@pytest.mark.long
def test_the_hash_follows_every_constant_that_a_kernel_reads_from_a_file_without_kernels(tmp_path: Path) -> None:
    package, whole = copied(tmp_path), set(kernel_files())
    found = frozen_constants()
    assert len(found) > 100
    elsewhere = sorted((path, name) for path, name in found if path not in whole)
    assert {name for _, name in elsewhere} >= {"FOUND", "EXHAUSTED", "NOTHING_LIMITS"}
    before = hash_of(package)
    for path, name in elsewhere:
        copy = package / path.relative_to(PACKAGE)
        text = copy.read_text()
        copy.write_text(f"{text}\n{name} = 12345\n")
        assert hash_of(package) != before, f"{name} in {path}"
        copy.write_text(text)
    assert hash_of(package) == before


FREEZING = """
from clamber.planning.problem.shape import PARTS, scale
from clamber.compiled import kernel
from clamber.planning.exact.records import EXHAUSTED, FOUND

GROWN = scale(2)


@kernel
def verdict(found):
    return (FOUND if found else EXHAUSTED) + GROWN + PARTS.first
"""
SHAPE = """
from typing import NamedTuple

from clamber.planning.problem.numbers import FACTOR


class Parts(NamedTuple):
    first: int


PARTS = Parts(100)


def scale(x):
    return x * FACTOR
"""
VERDICT = "from clamber.planning.problem.freezing import verdict; print(verdict(True), sum(verdict.stats.cache_hits.values()))"


@pytest.mark.slow
def test_a_constant_of_a_file_without_kernels_answers_anew_though_the_cache_is_warm(tmp_path: Path) -> None:
    package, cache = copied(tmp_path), tmp_path / "cache"
    (package / "planning" / "problem" / "freezing.py").write_text(FREEZING)
    (package / "planning" / "problem" / "shape.py").write_text(SHAPE)
    (package / "planning" / "problem" / "numbers.py").write_text("FACTOR = 10\n")
    assert answer(package, cache, VERDICT) == (121.0, 0)
    assert answer(package, cache, VERDICT) == (121.0, 1)
    edit(package / "planning" / "exact" / "records.py", "FOUND, EXHAUSTED,", "EXHAUSTED, FOUND,")
    assert answer(package, cache, VERDICT) == (122.0, 0)
    edit(package / "planning" / "problem" / "numbers.py", "10", "20")  # by way of a function, at import
    assert answer(package, cache, VERDICT) == (142.0, 0)
    edit(package / "planning" / "problem" / "shape.py", "Parts(100)", "Parts(200)")
    assert answer(package, cache, VERDICT) == (242.0, 0)


@pytest.mark.long
def test_the_exact_planner_answers_right_after_its_constants_were_exchanged(tmp_path: Path) -> None:
    package = tmp_path / "clamber"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__"))
    plan = (
        "import clamber; found = clamber.plan('ladder', 'exact', threads=1, max_stances=200_000);"
        "print(found.length if found.status == 'optimal' else -1, 0)"
    )
    length, _ = answer(package, tmp_path / "cache", plan)
    assert length > 0
    edit(package / "planning" / "exact" / "records.py", "FOUND, EXHAUSTED,", "EXHAUSTED, FOUND,")
    assert answer(package, tmp_path / "cache", plan) == (length, 0)


def table(limbs: int) -> ActionTable:
    """Every body move, release, nearest and random grab."""
    entries = [(f"move {axis}", [pack(codes.MOVE, 0, axis)], True) for axis in range(6)]
    for i in range(limbs):
        entries.append((f"release {i}", [pack(codes.RELEASE, i)], False))
        entries.append((f"random {i}", [pack(codes.RANDOM, i)], False))
        entries += [(f"nearest {i} {k}", [pack(codes.NEAREST, i, k)], False) for k in (1, 2, 3)]
    return ActionTable.build(entries)


def plans(n: int, entries: int, longest: int = 60) -> tuple[Any, Any]:
    rng = np.random.default_rng(7)
    return rng.integers(0, entries, (n, longest)).astype(np.int32), rng.integers(1, longest + 1, n).astype(np.int32)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ladder", "circle", "gecko-climb"])
def test_any_number_of_threads_gives_the_same_bits(name: str) -> None:
    task: Any = load_task(name)
    actions = table(len(task.robot.limbs))
    genes, lengths = plans(4000, len(actions))
    answers = []
    for threads in (1, 2, 4):
        problem = LimbedProblem(task, actions, threads=threads)
        answers.append(problem.rollout(genes, lengths, np.ones(len(problem.features)), 60).tobytes())
    assert answers[0] == answers[1] == answers[2]


def test_random_grabs_are_the_same_every_time_and_differ_with_the_seed() -> None:
    plan = np.array(
        [pack(codes.RANDOM, 2), pack(codes.MOVE, 0, 2), pack(codes.RANDOM, 0), pack(codes.RANDOM, 1)] * 8, np.int32
    )
    taken = {}
    for seed in (0, 0, 1, 2, 3, 2**62):
        task: Any = load_task("circle", (f"seed={seed}",))
        resolved = LimbedProblem(task, table(3)).replay(plan, go_on=True).stances["resolved"].tolist()
        assert taken.setdefault(seed, resolved) == resolved
    assert len({tuple(resolved) for resolved in taken.values()}) > 2


class Held(NamedTuple):
    """What a handle may hold, one within the other."""

    place: Any
    rates: tuple[float, float]
    records: Any


@kernel
def turned(handle: Any, factor: float) -> Any:
    held, counts, k, share = opened(handle)
    held.place[1, 2] *= factor * held.rates[1]
    held.records[1].hold += k
    counts[counts.size - 1] += 1
    return held.place.shape[0] * 10 + held.place.shape[1] + share


def test_kernels_open_a_handle_to_what_it_holds_and_it_keeps_that_alive() -> None:
    record = np.dtype([("hold", "i8"), ("normal", "f8", (3,))], align=True)
    handle = Handle(
        Held(np.arange(12.0).reshape(3, 4), (1.0, 0.5), np.zeros(2, record)), np.zeros(5, np.int32), 7, 0.25
    )
    gc.collect()
    filled = [np.full((3, 4), -1.0) for _ in range(100)]  # would take the memory of arrays that are gone
    assert [turned(handle, 4.0) for _ in range(3)] == [34.25] * 3
    held, counts, *_ = handle.held
    assert np.array_equal(held.place, np.where(np.arange(12.0) == 6.0, 48.0, np.arange(12.0)).reshape(3, 4))
    assert held.records["hold"].tolist() == [0, 21] and counts.tolist() == [0, 0, 0, 0, 3]
    assert all((array == -1.0).all() for array in filled)


def test_a_kernel_that_is_ready_gives_the_same_and_keeps_its_handle_alive() -> None:
    held = Held(np.arange(12.0).reshape(3, 4), (1.0, 0.5), np.zeros(2, np.dtype([("hold", "i8")], align=True)))
    counts = np.zeros(5, np.int32)
    at_once = ready(turned, Handle(held, counts, 7, 0.25), 1.0)
    kinds = len(turned.overloads)  # type: ignore[attr-defined]
    gc.collect()
    filled = [np.full((3, 4), -1.0) for _ in range(100)]
    assert [at_once(4.0) for _ in range(3)] == [34.25] * 3
    assert held.place[1, 2] == 48.0 and held.records["hold"].tolist() == [0, 21] and counts[4] == 3
    assert at_once(2) == 34.25 and held.place[1, 2] == 48.0  # a whole number where a real one is meant is that one
    assert turned(Handle(held, counts, 7, 0.25), 1.0) == 34.25 and len(turned.overloads) == kinds  # type: ignore[attr-defined]
    assert all((array == -1.0).all() for array in filled)
    with pytest.raises(TypeError):
        at_once("fast")


@pytest.mark.parametrize("value", ["text", None, True, [1.0], object()])
def test_a_handle_refuses_what_kernels_could_not_read(value: object) -> None:
    with pytest.raises(TypeError, match=f"not {type(value).__name__}"):
        Handle(np.zeros(3), (value,))
