"""What tells an operator from any other user of the machine: a secret in a file that only the server's owner can read."""

import contextlib
import os
import secrets
import stat
import tempfile
from pathlib import Path

from .channel import Address, LinkError
from .messages import TOKEN


def write_token(address: Address) -> None:
    """Write the token of a plant that is served at an address of TCP; a Unix domain socket is for its owner already.

    Raises:
        LinkError: If it cannot be written where nobody else can read it.
    """
    if address.kind == "unix":
        return
    path = _path(address)
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        _check_owner(address, path.parent)
        path.unlink(missing_ok=True)  # of a server that was killed
        with open(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as file:
            file.write(secrets.token_hex(TOKEN // 2))
    except OSError as error:
        raise LinkError(
            str(address), f"cannot write its token {path} ({error.strerror})", "set XDG_RUNTIME_DIR, or take --socket"
        ) from None


def read_token(address: Address) -> bytes:
    """The token of the plant that is served at an address; of a Unix domain socket it is all zeros.

    Raises:
        LinkError: If there is none that this user may read.
    """
    if address.kind == "unix":
        return bytes(TOKEN)
    path = _path(address)
    try:
        _check_owner(address, path.parent)
        token = path.read_bytes()[: TOKEN + 1]
    except OSError as error:
        raise LinkError(
            str(address), f"cannot read its token {path} ({error.strerror})", "must be asked by the user that serves it"
        ) from None
    if len(token) != TOKEN:
        raise LinkError(str(address), f"its token {path} is damaged", "must be 32 characters; serve the plant anew")
    return token


def remove_token(address: Address) -> None:
    """Remove what `write_token` wrote."""
    if address.kind == "tcp":
        with contextlib.suppress(OSError):
            _path(address).unlink(missing_ok=True)


def _path(address: Address) -> Path:
    base = os.environ.get("XDG_RUNTIME_DIR")
    folder = Path(base, "clamber") if base else Path(tempfile.gettempdir(), f"clamber-{_user()}")
    return folder / f"plant-{address.host}-{address.port}.token"


def _check_owner(address: Address, folder: Path) -> None:
    found = folder.lstat()
    if not stat.S_ISDIR(found.st_mode) or found.st_uid != _user() or found.st_mode & 0o077:
        raise LinkError(str(address), f"others can get at {folder}", "must be a folder of yours alone (chmod 700)")


def _user() -> int:
    return os.getuid() if hasattr(os, "getuid") else 0
