"""The one way to the file system for what users name: regular files only are read, made and replaced, whole or not at all."""

import contextlib
import os
import secrets
import shutil
import stat
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Final

from .errors import FileError, describe_choices

OTHER_KINDS: Final = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISCHR, "a character device"),
    (stat.S_ISBLK, "a block device"),
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISLNK, "a link that leads in a circle"),
)
"""What a name may stand for besides a regular file."""
STREAMS: Final = ("/dev/stdin", "/dev/stdout", "/dev/stderr", "/dev/fd/", "/proc/")
"""Names of what a process has open, which may lead to a regular file but are none."""
_NO_WAIT: Final = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_NOCTTY", 0)
"""To open a pipe or a terminal that took the file's place a moment ago must neither block nor take it over."""
_BINARY: Final = getattr(os, "O_BINARY", 0)


def is_file(path: Path) -> bool:
    """Whether a regular file is there; False, too, for names that the system does not take, such as one of 300 letters."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def is_folder(path: Path) -> bool:
    """Whether a folder is there; False, too, for names that the system does not take."""
    try:
        return path.is_dir()
    except (OSError, ValueError):
        return False


def is_there(path: Path) -> bool:
    """Whether there is anything of that name; False, too, for names that the system does not take."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def user_path(text: str) -> Path:
    """The path that a text names, "~" being somebody's home.

    Raises:
        FileError: If there is no such home.
    """
    try:
        return Path(text).expanduser()
    except RuntimeError:
        raise FileError(text, "names the home of nobody", "name a file, such as './name'") from None


def read_bytes(path: Path, most: int) -> bytes:
    """The bytes of a regular file.

    Args:
        path: The file, or a link to it.
        most: Largest size that is read [bytes].

    Raises:
        FileError: If it is missing, no regular file, larger, or cannot be read.
    """
    name = str(path)
    try:
        _check_kind(name, os.stat(path))
        with os.fdopen(os.open(path, os.O_RDONLY | _NO_WAIT | _BINARY), "rb") as stream:
            status = os.fstat(stream.fileno())
            _check_kind(name, status)
            if status.st_size > most:
                raise FileError(name, f"has {status.st_size} bytes", f"at most {most} are read")
            content = stream.read(most + 1)  # what the system makes up while it is read has no size
    except FileNotFoundError:
        raise FileError(name, "does not exist", f"files beside it: {_beside(path)}") from None
    except (OSError, ValueError) as error:
        raise FileError(name, f"cannot be read ({_reason(error)})", "name a readable file") from None
    if len(content) > most:
        raise FileError(name, "has no end", f"at most {most} bytes are read")
    return content


def check_target(path: Path) -> Path:
    """The file that writing to a name makes or replaces: the name itself, or where a link leads.

    Raises:
        FileError: If something else than a regular file is there, or nothing may be written.
    """
    name = str(path)
    if path.name == "-" or os.path.abspath(path).startswith(STREAMS):
        raise FileError(name, "is no file", "name a file; --json prints the result to standard output")
    try:
        target = Path(os.path.realpath(path))
        try:
            _check_kind(name, os.lstat(target))
        except FileNotFoundError:
            if not target.parent.is_dir():
                problem = f"cannot be written: the folder {target.parent} does not exist"
                raise FileError(name, problem, "make it first") from None
        if not os.access(target.parent, os.W_OK):
            raise FileError(name, "cannot be written", "name a file in a writable folder")
    except (OSError, ValueError) as error:
        raise _unwritable(path, error) from None
    return target


def write_atomically(path: Path, content: str | bytes) -> None:
    """Writes beside the target and renames, so that a reader or a crash never sees half a file.

    Raises:
        FileError: If the folder is missing or cannot be written, or something else than a regular file is there.
    """
    write_together({path: content})


def write_together(contents: Mapping[Path, str | bytes]) -> None:
    """Writes several files, all or none: all beside their targets, and then all renamed; where one cannot be, those before are put back.

    A process that is killed between two renames, which take some microseconds, leaves the first ones changed.

    Raises:
        FileError: As `write_atomically`; then no file has changed, unless one cannot be put back either.
    """
    made: dict[Path, Path] = {}
    kept: dict[Path, Path] = {}
    renamed: list[Path] = []
    path = Path()
    try:
        targets = {path: check_target(path) for path in contents}
        for path, target in targets.items():
            made[target] = _write_beside(target, contents[path])
            if len(targets) > 1 and target.exists():
                kept[target] = _keep_beside(target)
        for path, target in targets.items():  # noqa: B007  the path is named where this fails
            os.replace(made[target], target)
            renamed.append(target)
    except BaseException as error:
        for target in renamed:
            with contextlib.suppress(OSError):
                if target in kept:
                    os.replace(kept[target], target)
                else:
                    target.unlink()
        if isinstance(error, OSError):
            raise _unwritable(path, error) from None
        raise
    finally:
        for temporary in (*made.values(), *kept.values()):
            temporary.unlink(missing_ok=True)


def open_growing(path: Path) -> IO[bytes]:
    """A regular file, emptied if it is there, for what grows while it is recorded; a link of that name is not followed.

    Raises:
        FileError: As `check_target`.
        OSError: If it cannot be opened all the same.
    """
    flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC | getattr(os, "O_NOFOLLOW", 0) | _NO_WAIT | _BINARY
    stream = os.fdopen(os.open(check_target(path), flags, 0o666), "wb")
    _check_kind(str(path), os.fstat(stream.fileno()))
    return stream


def make_folder(path: Path) -> None:
    """Makes a folder, and those above it, unless it is there.

    Raises:
        FileError: If it can't be made, or a file is there.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        problem = "is a file" if is_file(path) else f"cannot be made ({_reason(error)})"
        raise FileError(str(path), problem, "name a folder where you may write") from None


def _write_beside(target: Path, content: str | bytes) -> Path:
    """A new file in the target's folder, on disk, with the rights that the target has or would have."""
    handle, name = tempfile.mkstemp(prefix=".clamber-", dir=target.parent)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(content.encode("utf-8") if isinstance(content, str) else content)
            stream.flush()
            os.fsync(stream.fileno())
        os.chmod(name, stat.S_IMODE(target.stat().st_mode) if target.exists() else 0o666 & ~_umask())
    except BaseException:
        os.unlink(name)
        raise
    return Path(name)


def _keep_beside(target: Path) -> Path:
    """A second name, in the target's folder, for the file that is there."""
    kept = target.with_name(f".clamber-{secrets.token_hex(8)}")
    try:
        os.link(target, kept)
    except OSError:  # a file system without links
        shutil.copy2(target, kept)
    return kept


def _check_kind(name: str, status: os.stat_result) -> None:
    if not stat.S_ISREG(status.st_mode):
        kind = next((words for is_kind, words in OTHER_KINDS if is_kind(status.st_mode)), "no file")
        raise FileError(name, f"is {kind}", "name a file" if stat.S_ISDIR(status.st_mode) else "name a regular file")


def _unwritable(path: Path, error: OSError | ValueError) -> FileError:
    return FileError(str(path), f"cannot be written ({_reason(error)})", "name a file in a writable folder")


def _reason(error: OSError | ValueError) -> str:
    return (error.strerror if isinstance(error, OSError) else None) or str(error)


def _beside(path: Path) -> str:
    try:
        names = sorted(p.name for p in path.parent.iterdir() if p.suffix == path.suffix)
    except OSError:
        return f"none, for the folder {path.parent} cannot be read"
    return describe_choices(path.name, names, limit=10)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
