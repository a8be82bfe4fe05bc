"""What users name is read and written if it is a regular file, and left as it is if it is anything else."""

import ast
import os
import socket
import stat
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import clamber as package
from clamber.errors import FileError
from clamber.files import MOST_PARTS, MOST_TEXT, parse_toml, read_text
from clamber.regular_files import check_target, is_file, is_there, make_folder, write_atomically, write_together

SOURCES = Path(package.__file__).parent
Clamber = Callable[..., tuple[int, str, str]]


@pytest.fixture
def odd(tmp_path: Path) -> Iterator[dict[str, Path]]:
    """A name of each kind that is no regular file."""
    places = {kind: tmp_path / f"{kind}.toml" for kind in ("folder", "pipe", "socket", "circle")}
    places["folder"].mkdir()
    os.mkfifo(places["pipe"])
    places["circle"].symlink_to(places["circle"])
    here = Path.cwd()
    with socket.socket(socket.AF_UNIX) as listening:
        os.chdir(tmp_path)  # a socket's whole path may have no more than a hundred letters
        try:
            listening.bind(places["socket"].name)
        finally:
            os.chdir(here)
        places["device"] = tmp_path / "device.toml"
        places["device"].symlink_to("/dev/zero")
        yield places


WORDS = {
    "folder": "is a folder",
    "pipe": "is a pipe",
    "socket": "is a socket",
    "device": "is a character device",
}


@pytest.mark.parametrize("kind", [*WORDS, "circle"])
def test_only_regular_files_are_read(odd: dict[str, Path], kind: str) -> None:
    with pytest.raises(FileError, match=WORDS.get(kind, "cannot be read")) as refused:
        read_text(odd[kind])
    assert refused.value.path == str(odd[kind])


@pytest.mark.parametrize("kind", [*WORDS, "circle"])
def test_only_regular_files_are_replaced(odd: dict[str, Path], kind: str) -> None:
    before = odd[kind].lstat()
    with pytest.raises(FileError, match=WORDS.get(kind, "is a link that leads in a circle")):
        write_atomically(odd[kind], "x")
    assert (odd[kind].lstat().st_ino, odd[kind].lstat().st_mode) == (before.st_ino, before.st_mode)
    assert not list(odd[kind].parent.glob(".clamber-*"))


@pytest.mark.parametrize(
    ("name", "words"),
    [("/dev/null", "is a character device"), ("/dev/stdout", "is no file"), ("/dev/fd/1", "is no file"), ("-", "is no file"),
     ("/proc/self/fd/1", "is no file"), ("x" * 300, "File name too long"), ("nowhere/x", "make it first")],
)  # fmt: skip
def test_names_that_are_no_files_are_refused_with_what_to_do(name: str, words: str) -> None:
    with pytest.raises(FileError, match=words) as refused:
        check_target(Path(name))
    assert ("--json prints the result to standard output" in str(refused.value)) == (words == "is no file")


def test_a_link_is_followed_and_stays_a_link(tmp_path: Path) -> None:
    there = tmp_path / "elsewhere" / "target.json"
    there.parent.mkdir()
    for link, first in ((tmp_path / "link.json", "old"), (tmp_path / "to-nothing.json", None)):
        target = there.with_name(f"of-{link.name}")
        if first is not None:
            target.write_text(first)
            target.chmod(0o640)
        link.symlink_to(target)
        write_atomically(link, "new")
        assert link.is_symlink() and target.read_text() == "new" and not target.is_symlink()
        if first is not None:
            assert stat.S_IMODE(target.stat().st_mode) == 0o640


def test_several_files_are_written_together_or_not_at_all(odd: dict[str, Path], tmp_path: Path) -> None:
    good, late = tmp_path / "a.toml", tmp_path / "b.toml"
    good.write_text("before")
    with pytest.raises(FileError, match="is a pipe"):
        write_together({good: "after", late: "after", odd["pipe"]: "after"})
    assert good.read_text() == "before" and not late.exists()
    write_together({good: "after", late: b"after"})
    assert good.read_text() == late.read_text() == "after"


@pytest.mark.parametrize("links", [True, False])
@pytest.mark.parametrize("failure", [PermissionError(13, "Permission denied"), KeyboardInterrupt()])
def test_a_rename_that_fails_leaves_what_was_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, failure: BaseException, links: bool
) -> None:
    there, new, last = (tmp_path / name for name in ("a.toml", "b.toml", "c.toml"))
    there.write_text("before")
    last.write_text("last")
    there.chmod(0o640)
    rename = os.replace

    def replace(source: Path, target: Path) -> None:
        if Path(target) == last:
            raise failure
        rename(source, target)

    def link(source: Path, target: Path) -> None:
        raise OSError(95, "Operation not supported")

    with monkeypatch.context() as patched:
        patched.setattr(os, "replace", replace)
        if not links:
            patched.setattr(os, "link", link)
        with pytest.raises((FileError, KeyboardInterrupt)) as refused:
            write_together({there: "after", new: "after", last: "after"})
    assert refused.type is KeyboardInterrupt or str(last) in str(refused.value)
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"a.toml": "before", "c.toml": "last"}
    assert there.stat().st_mode & 0o777 == 0o640
    write_together({there: "after", new: "after", last: "after"})
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == dict.fromkeys(
        ("a.toml", "b.toml", "c.toml"), "after"
    )


def test_what_is_too_large_or_has_no_end_is_not_read(tmp_path: Path) -> None:
    large = tmp_path / "large.toml"
    with large.open("wb") as file:
        file.truncate(MOST_TEXT + 1)
    with pytest.raises(FileError, match=f"has {MOST_TEXT + 1} bytes; at most {MOST_TEXT} are read"):
        read_text(large)
    endless = Path("/proc/self/environ")  # a regular file without a size
    if endless.exists():
        with pytest.raises(FileError, match="has no end"):
            read_text(endless, 3)


def test_a_name_that_the_system_does_not_take_is_no_file() -> None:
    for name in ("x" * 300 + ".toml", "a\0b.toml"):
        assert not is_file(Path(name)) and not is_there(Path(name))
        with pytest.raises(FileError):
            read_text(Path(name))
    with pytest.raises(FileError, match="cannot be made"):
        make_folder(Path("x" * 300))


@pytest.mark.parametrize("kind", ["pipe", "device", "folder", "socket"])
@pytest.mark.parametrize("command", ["check", "plan", "run", "show", "view --seconds 0 --no-browser"])
def test_commands_neither_hang_nor_fill_memory(clamber: Clamber, odd: dict[str, Path], kind: str, command: str) -> None:
    code, out, err = clamber(*command.split(), str(odd[kind]))
    assert (code, out) == (2, "")
    assert WORDS[kind] in err


def test_a_robot_that_a_file_names_is_a_regular_file(clamber: Clamber, odd: dict[str, Path], tmp_path: Path) -> None:
    for kind, path in odd.items():
        task = tmp_path / f"task-{kind}.toml"
        task.write_text(
            (SOURCES / "families/climber/data/tasks/ladder.toml").read_text().replace('"libra"', f'"{path}"')
        )
        code, _, err = clamber("check", str(task))
        assert code == 2 and str(path) in err and WORDS.get(kind, "cannot be read") in err


@pytest.mark.parametrize("kind", ["pipe", "device", "folder"])
@pytest.mark.parametrize(
    "words", ["trials ladder-hand -n 1 --store", "sweep ladder --vary step.length=2in..3in:2 --store"]
)
def test_a_store_is_a_regular_file(clamber: Clamber, odd: dict[str, Path], words: str, kind: str) -> None:
    before = odd[kind].lstat()
    code, out, err = clamber(*words.split(), str(odd[kind]))
    assert (code, out) == (2, "") and str(odd[kind]) in err and WORDS[kind] in err
    assert (odd[kind].lstat().st_ino, odd[kind].lstat().st_mode) == (before.st_ino, before.st_mode)


def test_keys_with_too_many_parts_are_refused_before_they_are_parsed() -> None:
    deep = ".".join("a" * 20_000)
    hidden = '"""a"""", ' + deep + ' = 1, b = "'
    quoted = ".".join(["'.'"] * 20_000)
    for text in (f"{deep} = 1", f"[{deep}]", f"x = {{ {deep} = 1 }}", f"x = {{ y = {hidden} }}", f"{quoted} = 1"):
        with pytest.raises(ValueError, match=f"a key has more than {MOST_PARTS} parts"):
            parse_toml(text)
    for text in ("[" * 100_000, "x = " + "[" * 100_000, 'x = "' + deep + '"', f"# {deep}", f"x = [{'1.5, ' * 20_000}]"):
        try:
            parse_toml(text)
        except ValueError as error:
            assert "parts" not in str(error)


def calls(path: Path) -> Iterator[str]:
    """What a module calls, by the last word of its name."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Call):
            if isinstance(node.func, ast.Attribute):
                owner = f"{node.func.value.id}." if isinstance(node.func.value, ast.Name) else "."
                modes = [word.value for word in node.args if isinstance(word, ast.Constant)]
                opens = node.func.attr == "open" and modes and set(str(modes[0])) <= set("rwaxbt+")
                yield "open" if opens else f"{owner}{node.func.attr}"
            elif isinstance(node.func, ast.Name):
                yield node.func.id


WAYS = (
    *(".write_text", ".write_bytes", ".read_text", ".read_bytes", ".rename", ".touch"),
    *("os.open", "os.replace", "os.rename", "mkstemp"),
)
OTHER_WAYS = {
    "regular_files.py": "is the one way",
    "sealed.py": "asks of what it opened whose it is, in the cache",
    "sources.py": "reads the package itself",
    "viewing/report/pages.py": "reads the package itself",
    "cli/commands.py": "reads the package itself",
    "viewing/browser/page.py": "reads the package itself",
    "benchmarks/starts.py": "asks the system for its processor",
    "jobs/store.py": "locks a file whose name was checked",
    "jobs/cluster.py": "opens the null device",
    "execution/link/token.py": "keeps a secret in a folder that only its user can reach",
    "turns.py": "locks a file in the cache",
    "notebook.py": "reads the picture that was drawn into a folder of ours",
    "viewing/animation.py": "reads the film that ffmpeg wrote into a folder of ours",
    "execution/log_stream.py": "renames what it wrote by the one way",
}


def test_no_module_goes_round_the_one_way() -> None:
    found = {
        path.relative_to(SOURCES).as_posix()
        for path in sorted(SOURCES.rglob("*.py"))
        if any(call.endswith(WAYS) or call in {"open", "io.open"} for call in calls(path))
    }
    assert found <= set(OTHER_WAYS), "reads or writes past regular_files"
    assert set(OTHER_WAYS) <= found, "goes no other way any more"
