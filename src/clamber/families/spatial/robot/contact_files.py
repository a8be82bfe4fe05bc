"""Files of contacts: those that come with Clamber, and those that a robot's limbs name."""

from pathlib import Path
from typing import Final

from ....errors import UnknownNameError, describe_choices
from ....files import Document, data_names, find_data, read_toml
from ....types import Json

DATA: Final = Path(__file__).parent.parent / "data" / "contacts"


def contact_names() -> tuple[str, ...]:
    """Names of the contacts that come with Clamber."""
    return data_names(DATA)


def read_contact(name_or_path: str, folder: Path | None = None) -> Document:
    """The document of a contact, by its shipped name or from the user's file (a path, relative to `folder`).

    Raises:
        UnknownNameError: If no contact has that name.
        FileError: If the file cannot be read.
    """
    path, label = find_data("contact", name_or_path, (DATA,), folder)
    return read_toml(path, label)


def stated_contacts(document: Document) -> Json:
    """Documents of the contacts that a robot's limbs name, by these names; of one that the document states itself, that.

    A stored document has no say in which files are read: what it does not state itself must come with Clamber.

    Raises:
        SpecError: If there is no such contact.
        FileError: If a file can't be read.
    """
    limbs = document.data.get("limb")
    found: Json = dict(document.section("contacts", document.label).data) if "contacts" in document.data else {}
    for k, limb in enumerate(limbs if isinstance(limbs, list) else ()):
        named = limb.get("contact") if isinstance(limb, dict) else None
        if isinstance(named, str) and named not in found:
            if "contacts" in document.data and not document.overrides and named not in contact_names():
                allowed = f"must be one of 'contacts', or come with Clamber: {describe_choices(named, contact_names())}"
                raise document.problem(f"limb.{k}.contact", allowed)
            try:
                found[named] = read_contact(named, document.folder).data
            except UnknownNameError as error:
                raise document.problem(f"limb.{k}.contact", str(error)) from None
    return found
