"""Only the viewer's own page may talk to the viewer: other pages that are open in the same browser reach this machine's ports, too."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from unittest.mock import patch


@contextmanager
def own_pages_only(port: int) -> Iterator[None]:
    """A block in which a server is started that answers pages from its own address alone; others are refused with 403.

    Programs that are no browsers name no origin, and are answered. viser has no setting for this, so what it starts is given one here.

    Args:
        port: Of the server.
    """
    from websockets.asyncio import server
    from websockets.typing import Origin

    origins: list[Origin | None] = [Origin(f"http://{name}:{port}") for name in ("127.0.0.1", "localhost", "[::1]")]
    with patch.object(server, "serve", partial(server.serve, origins=[*origins, None])):
        yield
