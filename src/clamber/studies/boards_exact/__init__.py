"""What exact search proves about the five boards of Bevly's thesis."""

from typing import Final

STUDY: Final = "boards-exact"
