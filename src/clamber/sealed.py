"""Files of one's own cache: read only where nobody else could have written them, and only whole."""

import contextlib
import hashlib
import os
import stat
import uuid
from pathlib import Path
from typing import Final

HEAD: Final = b"clamber-sealed-1 "
DAMAGED, FOREIGN = "damaged", "foreign"


class SealError(Exception):
    """A file of a cache that is not to be read."""

    def __init__(self, state: str, problem: str) -> None:
        super().__init__(state, problem)
        self.state, self.problem = state, problem


def read_sealed(path: Path) -> bytes:
    """What `write_sealed` wrote to a file of this name.

    Raises:
        SealError: If it is not whole (`DAMAGED`), or is no file of this user's own that only they can write (`FOREIGN`).
        OSError: If it is not there, or cannot be read.
    """
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
    with os.fdopen(handle, "rb") as stream:
        facts = os.fstat(handle)  # of what was opened, whatever has taken its name since
        problem = "is no regular file" if not stat.S_ISREG(facts.st_mode) else access_problem(facts)
        if problem is not None:
            raise SealError(FOREIGN, problem)
        raw = stream.read()
    head, _, content = raw.partition(b"\n")
    if head != HEAD + _seal(path.name, content):
        raise SealError(DAMAGED, "is damaged")
    return content


def write_sealed(path: Path, content: bytes) -> None:
    """Write a file that only this user can write, whole or not at all.

    Raises:
        OSError: If it cannot be written.
    """
    temporary = path.with_name(f"{path.name}.tmp.{uuid.uuid4().hex[:16]}")
    handle = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(HEAD + _seal(path.name, content) + b"\n" + content)
        os.replace(temporary, path)
    except BaseException:
        with contextlib.suppress(OSError):
            temporary.unlink()
        raise


def access_problem(facts: os.stat_result) -> str | None:
    """Why others may have written a file or a folder; None where only this user can."""
    if not hasattr(os, "geteuid"):  # a system without such owners and modes
        return None
    if facts.st_uid != os.geteuid():
        return f"belongs to another user ({facts.st_uid})"
    if facts.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        return f"can be written by others (mode {stat.S_IMODE(facts.st_mode):o})"
    return None


def _seal(name: str, content: bytes) -> bytes:
    """Ties a content to the name of its file, so that no file is taken for another."""
    digest = hashlib.sha256(f"{name}\0".encode())
    digest.update(content)
    return digest.hexdigest().encode()
