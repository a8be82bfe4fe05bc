"""Hashes of the package's own files: of all of them, and of those parts that its kernels are made of.

Numba freezes what a kernel reads from outside (a constant, a record type, a helper) into the machine code. So the hash of the kernels
covers every file with kernels whole and, from there, each definition that such a file names in another file, and what that one names,
down to the last: an edit of any of them changes it, and an edit of a command's text does not.
"""

import __future__

import ast
import hashlib
import re
import secrets
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from types import CodeType
from typing import Final

PACKAGE: Final = Path(__file__).resolve().parent
KERNEL_MARK: Final = re.compile(
    rb"^[ \t]*(?:from|import)[ \t]+(?:[\w.]*\b(?:compiled|family_kernels)|numba)\b(?! import Handle$)", re.MULTILINE
)
"""Who imports a `Handle` alone calls kernels, and has none."""
INNER_IMPORT: Final = re.compile(r"^[ \t]+(?:from|import)\s", re.MULTILINE)
COMPILERS: Final = frozenset({"kernel", "inlined", "intrinsic", "overload", "numba"})
"""Names by which a function is compiled; one that names any of them is followed like a kernel."""


def package_files(package: Path = PACKAGE) -> list[Path]:
    """All files of a package, sources and data, sorted; compiled and hidden ones are left out."""
    found = (path for path in package.rglob("*") if path.suffix != ".pyc" and path.is_file())
    return sorted(path for path in found if not any(part.startswith(".") for part in path.relative_to(package).parts))


@cache
def package_hash(package: Path = PACKAGE) -> str:
    """SHA-256 of the names and contents of all files of a package, in hex."""
    return _hash_of(package, package_files(package))


def kernel_files(package: Path = PACKAGE) -> tuple[Path, ...]:
    """The source files of a package that are hashed whole: those that import the compiler, the family seam, or Numba."""
    return tuple(path for path in sorted(package.rglob("*.py")) if KERNEL_MARK.search(path.read_bytes()))


def kernel_sources_hash(package: Path = PACKAGE) -> str:
    """SHA-256 of all that kernels are made of: their files, and the definitions elsewhere that those name, in hex.

    Followed are imports and names as they stand in the sources. A value that another module assigns from outside, or reads from a data
    file as it is imported, is not seen.
    """
    files = kernel_files(package)
    digest = hashlib.sha256(_hash_of(package, files).encode())
    for piece in sorted(_Follower(package, files).pieces()):
        digest.update(piece.encode() + b"\0")
    return digest.hexdigest()


@cache
def outside_hash(file: Path) -> str:
    """SHA-256 of the sources of the package that a file outside ours belongs to, in hex.

    Of sources that are no file, such as a notebook's cell, it is another one in every process: what they were cannot be asked later.
    """
    if not file.is_file():
        return secrets.token_hex(32)
    top = file.parent
    while (top.parent / "__init__.py").exists():
        top = top.parent
    sources = sorted(top.rglob("*.py")) if (file.parent / "__init__.py").exists() else [file]
    return hashlib.sha256(b"\0".join(path.read_bytes() for path in sources)).hexdigest()


def _hash_of(package: Path, files: Iterable[Path]) -> str:
    digest = hashlib.sha256()
    for path in files:
        content = path.read_bytes()
        digest.update(f"{path.relative_to(package).as_posix()}\0{len(content)}\0".encode())
        digest.update(content)
    return digest.hexdigest()


class _Module:
    """A source file by its top-level statements."""

    def __init__(self, package: Path, path: Path) -> None:
        self.path = path
        self.text = path.read_text(encoding="utf-8")
        self.lines = self.text.splitlines()
        self.body = ast.parse(self.text).body
        self.imports: dict[str, tuple[Path, str | None]] = {}
        """Name -> file of the package that it comes from, and its name there; None for the module itself."""
        self.all_of: list[Path] = []
        """Files that all names are imported from."""
        self.bindings: dict[str, list[ast.stmt]] = {}
        """Name -> the statements that give it its value or change that."""
        inner_imports = INNER_IMPORT.search(self.text) is not None
        for statement in self.body:
            for inner in ast.walk(statement) if inner_imports else (statement,):
                if isinstance(inner, ast.Import | ast.ImportFrom):
                    self._note_import(package, inner)
            for name in _bound(statement):
                self.bindings.setdefault(name, []).append(statement)

    def _note_import(self, package: Path, statement: ast.Import | ast.ImportFrom) -> None:
        if isinstance(statement, ast.Import):
            for alias in statement.names:
                words = alias.name.split(".")
                # "import a.b" binds a, whose files are then all within reach by dots: the module that is named stands for it
                if words[0] == package.name and (file := _module_file(package, words[1:])) is not None:
                    self.imports[alias.asname or words[0]] = file, None
            return
        words = statement.module.split(".") if statement.module else []
        if statement.level:
            here = self.path.relative_to(package).parent.parts
            words = [*here[: len(here) - statement.level + 1], *words]
        elif words[:1] == [package.name]:
            words = words[1:]
        else:
            return
        for alias in statement.names:
            inner, outer = _module_file(package, [*words, alias.name]), _module_file(package, words)
            if alias.name == "*" and outer is not None:
                self.all_of.append(outer)
            elif inner is not None:
                self.imports[alias.asname or alias.name] = inner, None
            elif outer is not None:
                self.imports[alias.asname or alias.name] = outer, alias.name


class _Follower:
    """Follows names from files with kernels into others."""

    def __init__(self, package: Path, files: Iterable[Path]) -> None:
        self._package = package
        self._whole = set(files)
        self._modules: dict[Path, _Module] = {}
        self._seen: set[tuple[Path, str]] = set()
        self._pieces: set[str] = set()
        self._left: list[tuple[Path, str]] = []

    def pieces(self) -> set[str]:
        """Sources of the definitions outside of the files with kernels, each with the name of its file."""
        for path in sorted(self._whole):
            for statement in self._module(path).body:
                if _is_root(statement):
                    self._note_names(path, statement)
        while self._left:
            path, name = self._left.pop()
            if (path, name) not in self._seen:
                self._seen.add((path, name))
                self._follow(self._module(path), name)
        return self._pieces

    def _module(self, path: Path) -> _Module:
        if path not in self._modules:
            self._modules[path] = _Module(self._package, path)
        return self._modules[path]

    def _note_names(self, path: Path, statement: ast.stmt) -> None:
        self._left += [(path, name) for name in _names(statement)]

    def _follow(self, module: _Module, name: str) -> None:
        if name in module.imports:
            path, attribute = module.imports[name]
            if attribute is None:
                self._take_all(path)
            else:
                self._left.append((path, attribute))
        for statement in module.bindings.get(name, ()):
            if module.path not in self._whole:
                lines = module.lines[_first_line(statement) - 1 : statement.end_lineno]
                self._pieces.add("\n".join((module.path.relative_to(self._package).as_posix(), *lines)))
            self._note_names(module.path, statement)
        if name in module.imports or name in module.bindings:
            return
        for path in module.all_of:
            self._left.append((path, name))
        if "__getattr__" in module.bindings:
            self._take_all(module.path)

    def _take_all(self, path: Path) -> None:
        """A module that is read by dots: every statement of it."""
        if path in self._whole:
            return
        self._whole.add(path)
        module = self._module(path)
        self._pieces.add(f"{path.relative_to(self._package).as_posix()}\n{module.text}")
        for statement in module.body:
            self._note_names(path, statement)


def _module_file(package: Path, words: list[str]) -> Path | None:
    """The file of a module of a package, None if it has no such module."""
    base = package.joinpath(*words)
    for path in (base.with_suffix(".py"), base / "__init__.py") if words else (base / "__init__.py",):
        if path.is_file():
            return path
    return None


def _bound(statement: ast.stmt) -> set[str]:
    """Names at the top of a module that a statement binds, or whose value it may change."""
    if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return {statement.name}
    if isinstance(statement, ast.Import | ast.ImportFrom):
        return set()
    names: set[str] = set()
    for node in ast.walk(statement):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store | ast.Del):
            names.add(node.id)
        elif isinstance(node, ast.Name) and isinstance(statement, ast.Expr | ast.Assign | ast.AugAssign):
            # a call may change what it is called on or with, and so may an assignment to a part
            part = not isinstance(statement, ast.Assign) or any(
                not isinstance(to, ast.Name) for to in statement.targets
            )
            names |= {node.id} if part else set()
    return names


def _names(statement: ast.stmt) -> set[str]:
    """Names that a statement reads, attributes among them; what only annotates is left out."""
    module = ast.Module([statement], [])
    left = [compile(module, "", "exec", flags=__future__.annotations.compiler_flag, dont_inherit=True)]
    found: set[str] = set()
    while left:
        here = left.pop()
        found.update(here.co_names)
        left += [constant for constant in here.co_consts if isinstance(constant, CodeType)]
    return found


def _is_root(statement: ast.stmt) -> bool:
    """Whether a statement of a file with kernels may decide what is compiled: all but imports and functions that are not compiled."""
    if isinstance(statement, ast.Import | ast.ImportFrom):
        return False
    if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return bool(_names(statement) & COMPILERS)
    return True


def _first_line(statement: ast.stmt) -> int:
    decorators: list[ast.expr] = getattr(statement, "decorator_list", [])
    return min(statement.lineno, *(decorator.lineno for decorator in decorators)) if decorators else statement.lineno
