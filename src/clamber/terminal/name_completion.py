"""Names that the shell completes: those that `clamber list` shows, read without anything that is slow to load."""

from collections.abc import Callable, Iterable, Mapping

Offer = tuple[str, str]
"""A word, and what it means."""


def names_of(*kinds: str, besides: Iterable[str] = ()) -> Callable[[str], list[Offer]]:
    """What completes a word that names a thing of one of some kinds; where nothing fits, the shell offers files.

    Args:
        kinds: As `clamber list` calls them.
        besides: Other words that are allowed there; a mapping says what each means.
    """

    def offered(incomplete: str) -> list[Offer]:
        from .catalogue import ENTRIES

        found = dict(besides) if isinstance(besides, Mapping) else dict.fromkeys(besides, "")
        for kind in kinds:
            found |= {name: title for name, title in ENTRIES[kind]() if name not in found}
        return [(name, title) for name, title in found.items() if name.startswith(incomplete)]

    return offered
