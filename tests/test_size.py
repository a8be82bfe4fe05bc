"""The size of the source, which may only shrink: `python tests/test_size.py` prints it beside its ceilings and where it shall come to."""

import ast
import statistics
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "src" / "clamber"
LONG = 400
"""Lines of a file."""
MANY = 8
"""Parameters of a function."""
CEILINGS = {
    "lines": 122_344,
    "files": 796,
    f"files above {LONG} lines": 0,
    f"functions with more than {MANY} parameters": 14,
    "median length of a line": 40,
    "90th percentile of the length of a line": 97,
}
"""As it is; lower them with every change that makes the source smaller. 23 000 of the lines are robots in space; there were 123 827 before
families shared their trials, noise, tasks and reports."""
AIMS = dict(zip(CEILINGS, (65_000, 500, 0, 20, 39, 97), strict=True))


def parameters(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Number of a function's parameters, without `self`."""
    args = function.args
    named = [arg.arg for arg in (*args.posonlyargs, *args.args, *args.kwonlyargs)]
    return len([name for name in named if name not in ("self", "cls")])


def sizes() -> dict[str, float]:
    """Each figure by its name in `CEILINGS`."""
    paths = sorted(PACKAGE.rglob("*.py"))
    texts = [path.read_text(encoding="utf-8") for path in paths]
    files = [text.splitlines() for text in texts]
    lengths = sorted(len(line) for file in files for line in file if line.strip())
    functions = [
        node
        for text in texts
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    ]
    found = (
        sum(len(file) for file in files),
        len(files),
        sum(len(file) > LONG for file in files),
        sum(parameters(function) > MANY for function in functions),
        statistics.median(lengths),
        lengths[len(lengths) * 9 // 10],
    )
    return dict(zip(CEILINGS, found, strict=True))


def test_the_source_does_not_grow() -> None:
    assert {name: size for name, size in sizes().items() if size > CEILINGS[name]} == {}


if __name__ == "__main__":
    for name, size in sizes().items():
        print(f"{name:42} {size:8g}   at most {CEILINGS[name]:8g}   aim {AIMS[name]:8g}")
