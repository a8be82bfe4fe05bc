"""Holds the table of docs/architecture.md against the imports of src/clamber, read from the syntax trees."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

from clamber.sources import kernel_files

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "src" / "clamber"
PAGE = ROOT / "docs" / "architecture.md"
BASE = "base"
# Slow to import, or optional. `pyproject.toml` bans the same at module level (TID253).
HEAVY = {
    "matplotlib",
    "mujoco",
    "ray",
    "deap",
    "pymoo",
    "pygad",
    "imageio_ffmpeg",
    "mcap",
    "mink",
    "pink",
    "pinocchio",
    "viser",
}
MAY_LOAD_HEAVY = {"viewing": {"matplotlib"}, "pictures": {"matplotlib"}, "sim": {"mujoco"}}
COMPILERS = {"njit", "jit", "vectorize", "guvectorize", "cfunc", "stencil", "generated_jit"}
CHOOSERS = {PACKAGE / "planning" / "problem" / "family_kernels.py"}  # hold no kernel, but choose one while compiling
READS_MODELS = PACKAGE / "families" / "spatial" / "robot" / "model.py"
SEAM = PACKAGE / "family.py"  # names for type checkers what a family hands out, and imports none of it
FILES = sorted(PACKAGE.rglob("*.py"))


class Import(NamedTuple):
    """One imported module, by its full name, and where."""

    module: str
    line: int
    at_module_level: bool


class Table(NamedTuple):
    """The table as the page has it."""

    base: frozenset[str]
    """Modules that lie directly in src/clamber."""
    direct: dict[str, frozenset[str]]
    """Folder -> folders named in its last column."""

    def row(self, parts: tuple[str, ...]) -> str | None:
        """The row of a module of ours, split at its dots: the longest one that its folders match."""
        for end in range(len(parts) - 1, 0, -1):
            folder = "/".join(parts[1 : 1 + end])
            for row in self.direct:
                if re.fullmatch(row.replace("*", "[^/]+"), folder):
                    return row
        return None

    def reach(self, folder: str) -> frozenset[str]:
        """Rows that `folder` may import: those named, what those may import, itself and the base."""
        found = {folder, BASE}
        todo = list(self.direct[folder])
        while todo:
            name = todo.pop()
            if name not in found:
                found.add(name)
                todo.extend(self.direct[name])
        return frozenset(found)


def parse(page: str) -> Table:
    """Reads the rows of the table that starts with `| folder |`."""
    lines = iter(page.splitlines())
    for line in lines:
        if line.startswith("| folder |"):
            break
    else:
        raise AssertionError(f"{PAGE.name} has no table that starts with '| folder |'")
    next(lines)  # the rule below the header
    base: frozenset[str] = frozenset()
    direct: dict[str, frozenset[str]] = {}
    for line in lines:
        if not line.startswith("|"):
            break
        folder, _, imports = (cell.strip() for cell in line.strip().strip("|").split("|"))
        allowed = frozenset() if imports == "nothing" else frozenset(name.strip() for name in imports.split(","))
        if folder.startswith("base:"):
            base = frozenset(folder.removeprefix("base:").strip().strip("`").split())
            direct[BASE] = allowed
        else:
            direct[folder.strip("`").rstrip("/")] = allowed
    return Table(base, direct)


@cache
def table() -> Table:
    return parse(PAGE.read_text(encoding="utf-8"))


def module_parts(path: Path) -> tuple[str, ...]:
    """Name of the module in `path`, split at its dots; a package's own file keeps `__init__`."""
    return ("clamber", *path.relative_to(PACKAGE).with_suffix("").parts)


def imports_of(tree: ast.Module, parts: tuple[str, ...]) -> Iterator[Import]:
    """All imports in `tree`, relative ones made absolute; `from a import b` counts as `a.b`, for b may be a module."""
    inside_functions = {
        id(node)
        for block in ast.walk(tree)
        if isinstance(block, ast.FunctionDef | ast.AsyncFunctionDef) or is_for_types_only(block)
        for node in ast.walk(block)
    }
    for node in ast.walk(tree):
        outer = id(node) not in inside_functions
        if isinstance(node, ast.Import):
            yield from (Import(alias.name, node.lineno, outer) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            package = ".".join(parts[: -node.level]) if node.level else ""
            source = ".".join(name for name in (package, node.module or "") if name)
            yield from (Import(f"{source}.{alias.name}", node.lineno, outer) for alias in node.names)


def is_for_types_only(block: ast.AST) -> bool:
    """Whether only type checkers read it, so that nothing in it is ever imported."""
    return isinstance(block, ast.If) and ast.unparse(block.test) == "TYPE_CHECKING"


@cache
def imports_in(path: Path) -> tuple[Import, ...]:
    return tuple(imports_of(ast.parse(path.read_bytes(), str(path)), module_parts(path)))


def folder_of(parts: tuple[str, ...]) -> str | None:
    """The table's row for a module of ours; None for the package itself, whose file names what the package offers."""
    if len(parts) < 2 or parts[1] in {"__init__", "__version__"}:
        return None
    if parts[1] in table().base:
        return BASE
    return "cli" if parts[1] == "__main__" else table().row(parts)


def family_in(parts: tuple[str, ...]) -> str | None:
    """The family in whose folder a module is."""
    return parts[2] if parts[1:2] == ("families",) and len(parts) > 3 else None


def heavy_in(parts: tuple[str, ...]) -> set[str]:
    """Slow packages that a module may load at once, by the name of its room or folder."""
    return set().union(*(MAY_LOAD_HEAVY.get(part, set()) for part in parts[1:]))


def where(path: Path, line: int) -> str:
    return f"{path.relative_to(ROOT)}:{line}"


def test_every_folder_is_in_the_table_and_the_other_way_round() -> None:
    rows = {folder_of(module_parts(path)) for path in FILES}
    assert rows - {None} == set(table().direct)


def test_every_base_module_is_in_the_table_and_the_other_way_round() -> None:
    modules = {path.stem for path in PACKAGE.glob("*.py")} - {"__init__", "__main__"}
    assert modules == table().base


def test_the_table_names_only_its_own_rows_and_has_no_cycle() -> None:
    for folder, allowed in table().direct.items():
        assert allowed <= set(table().direct), (
            f"{folder} may import {sorted(allowed - set(table().direct))}: no such row"
        )
        for name in allowed:
            assert folder == name or folder not in table().reach(name), f"{folder} and {name} may import each other"


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_imports_follow_the_table(path: Path) -> None:
    folder = folder_of(module_parts(path))
    # the package's own file names things for type checkers; tests/api holds that it loads none of them
    allowed = table().reach(folder) if folder else frozenset({BASE, *table().direct})
    wrong = [
        f"{where(path, found.line)}: {folder or 'clamber'} imports {found.module}"
        for found in imports_in(path)
        if found.module.split(".")[0] == "clamber"
        and not (path == SEAM and not found.at_module_level)
        and (target := folder_of(tuple(found.module.split(".")))) is not None
        and target not in allowed
    ]
    family = family_in(module_parts(path))
    wrong += [
        f"{where(path, found.line)}: a family imports another: {found.module}"
        for found in imports_in(path)
        if family is not None and family_in((*found.module.split("."), "")) not in (None, family)
    ]
    assert not wrong, "\n".join(wrong)


def test_no_file_is_named_utils() -> None:
    vague = re.compile(r"_?(utils?|helpers?|misc|common)")
    wrong = [
        str(path.relative_to(ROOT))
        for path in FILES
        if any(vague.fullmatch(part) for part in path.relative_to(PACKAGE).with_suffix("").parts)
    ]
    assert not wrong, f"name the domain instead: {wrong}"


def test_mujoco_is_imported_in_sim_and_where_models_are_read_only() -> None:
    wrong = [
        where(path, found.line)
        for path in FILES
        if "sim" not in module_parts(path) and path != READS_MODELS
        for found in imports_in(path)
        if found.module.split(".")[0] == "mujoco"
    ]
    assert not wrong, wrong


def test_heavy_modules_are_imported_inside_functions() -> None:
    wrong = [
        f"{where(path, found.line)}: {found.module}"
        for path in FILES
        for found in imports_in(path)
        if found.at_module_level
        and (top := found.module.split(".")[0]) in HEAVY
        and top not in heavy_in(module_parts(path))
    ]
    assert not wrong, "\n".join(wrong)


def test_numba_is_imported_only_where_kernels_are() -> None:
    """Outside `compiled.py` and its cache only beside `clamber.compiled`: its cache hashes exactly the files that import that."""
    wrong = [
        where(path, found.line)
        for path in FILES
        if path not in {PACKAGE / "compiled.py", PACKAGE / "kernel_cache.py"}
        and path not in CHOOSERS
        and "clamber.compiled.kernel" not in {found.module for found in imports_in(path)}
        for found in imports_in(path)
        if found.module.split(".")[0] in {"numba", "llvmlite"}
    ]
    assert not wrong, f"take `kernel` from clamber.compiled: {wrong}"


def test_nothing_outside_families_asks_of_what_kind_a_robot_is() -> None:
    """No `isinstance` with a class of a family: what differs by robot is a question to its family."""
    wrong = []
    for path in FILES:
        if "families" in module_parts(path):
            continue
        theirs = {found.module.split(".")[-1] for found in imports_in(path) if ".families." in f".{found.module}"}
        for node in ast.walk(ast.parse(path.read_bytes())):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in {"isinstance", "issubclass"}:
                asked = {name.id for name in ast.walk(node.args[1]) if isinstance(name, ast.Name)}
                wrong += [f"{where(path, node.lineno)}: {name}" for name in asked & theirs]
    assert not wrong, "\n".join(wrong)


def test_only_kernel_compiles() -> None:
    """`numba.njit` and its like elsewhere would use Numba's own cache, which misses changes in called functions."""
    wrong = []
    for path in FILES:
        if path == PACKAGE / "compiled.py":
            continue
        for found in imports_in(path):
            if found.module.split(".")[0] == "numba" and found.module.split(".")[-1] in COMPILERS:
                wrong.append(where(path, found.line))
        for node in ast.walk(ast.parse(path.read_bytes())):
            if isinstance(node, ast.Attribute) and ast.unparse(node) in {f"numba.{name}" for name in COMPILERS}:
                wrong.append(where(path, node.lineno))
    assert not wrong, f"use clamber.compiled.kernel: {wrong}"


def test_every_kernel_file_is_known_to_the_cache() -> None:
    """The cache finds kernel files by the text of their imports; the syntax tree must agree."""
    known = {path.resolve() for path in kernel_files()}
    wrong = [
        where(path, found.line)
        for path in FILES
        for found in imports_in(path)
        if found.module.startswith(("clamber.compiled.kernel", "clamber.compiled.inlined", "numba"))
        and path.resolve() not in known
    ]
    assert not wrong, f"clamber.sources.kernel_files misses {wrong}"


def test_relative_imports_are_resolved() -> None:
    source = "from . import a\nfrom ..units import metre\nimport numpy as np\ndef f():\n    import matplotlib.pyplot\n"
    found = list(imports_of(ast.parse(source), ("clamber", "robots", "limbed")))
    assert [one.module for one in found] == [
        "clamber.robots.a",
        "clamber.units.metre",
        "numpy",
        "matplotlib.pyplot",
    ]
    assert [one.at_module_level for one in found] == [True, True, True, False]


def test_reach_takes_what_the_named_folders_may_import() -> None:
    page = (
        "| folder | holds | may import |\n|---|---|---|\n| base: `errors units` | x | nothing |\n"
        "| `a/` | x | base |\n| `b/` | x | a |\n| `c/` | x | b |\n\n| other |\n"
    )
    made = parse(page)
    assert made.base == {"errors", "units"}
    assert made.reach("c") == {"c", "b", "a", BASE}
    assert made.reach(BASE) == {BASE}
