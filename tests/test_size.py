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
    "lines": 100_405,
    "files": 663,
    f"files above {LONG} lines": 0,
    f"functions with more than {MANY} parameters": 18,
    "median length of a line": 40,
    "90th percentile of the length of a line": 97,
}
"""As it is; lower them with every change that makes the source smaller. Lines were 94 971 before plans said whether they would be run,
robots and boards were shown alone, and output had units to choose; 96 186 before Python had every command and logs and the viewer a scene
in space, 97 933 before spatial runs, interrupts that end every command and poses of any number of coordinates; 100 387 before trials of
two works were compared, 100 439 before the laws of whole bodies were; 100 322 before control took climbers by their
weight."""
GROWING = PACKAGE / "families" / "spatial"
"""A family that is being built: its files and lines are counted apart, until it is whole; all other figures are of the whole package."""
GROWN = f"lines of {GROWING.name}", f"files of {GROWING.name}"
AIMS = dict(zip(CEILINGS, (65_000, 500, 0, 20, 39, 97), strict=True))


def parameters(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Number of a function's parameters, without `self`."""
    args = function.args
    named = [arg.arg for arg in (*args.posonlyargs, *args.args, *args.kwonlyargs)]
    return len([name for name in named if name not in ("self", "cls")])


def sizes() -> dict[str, float]:
    """Each figure by its name in `CEILINGS`, and those of the growing family."""
    paths = sorted(PACKAGE.rglob("*.py"))
    texts = [path.read_text(encoding="utf-8") for path in paths]
    young = [text for path, text in zip(paths, texts, strict=True) if path.is_relative_to(GROWING)]
    files = [text.splitlines() for text in texts]
    lengths = sorted(len(line) for file in files for line in file if line.strip())
    functions = [
        node
        for text in texts
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    ]
    found = (
        sum(len(file) for file in files) - sum(len(text.splitlines()) for text in young),
        len(files) - len(young),
        sum(len(file) > LONG for file in files),
        sum(parameters(function) > MANY for function in functions),
        statistics.median(lengths),
        lengths[len(lengths) * 9 // 10],
    )
    grown = (sum(len(text.splitlines()) for text in young), len(young))
    return dict(zip((*CEILINGS, *GROWN), (*found, *grown), strict=True))


def test_the_source_does_not_grow() -> None:
    found = sizes()
    assert {name: size for name, size in found.items() if size > CEILINGS.get(name, size)} == {}


if __name__ == "__main__":
    for name, size in sizes().items():
        held = f"   at most {CEILINGS[name]:8g}   aim {AIMS[name]:8g}" if name in CEILINGS else ""
        print(f"{name:42} {size:8g}{held}")
