"""`clamber bench`: measure speed and success, beside peers."""

from functools import partial
from typing import Annotated

import typer

from .options import AsJson
from .output import announce_compilation, print_json, stderr, stdout


def bench(
    name: Annotated[str | None, typer.Argument(help="One benchmark; all unless given.")] = None,
    as_json: AsJson = False,
) -> None:
    """Measure speed and success, ours beside those of peers."""
    from ..errors import UnknownNameError
    from ..experiments.benches import BENCHES
    from .study_text import print_rows

    if name is not None and name not in BENCHES:
        raise UnknownNameError("benchmark", name, tuple(BENCHES))
    announce_compilation("rollout")
    rows = []
    for chosen in BENCHES if name is None else (name,):
        stderr().print(f"measuring {chosen}")
        rows += BENCHES[chosen](say=partial(stderr().print, style="dim"))
    if as_json:
        print_json([row.to_json() for row in rows])
    else:
        print_rows(stdout(), rows)
