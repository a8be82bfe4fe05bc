"""What a command began and what has to end with it, however it ends."""

from contextlib import ExitStack
from typing import Final

until_command_ends: Final = ExitStack()
"""Takes contexts; they are left when the command leaves, though the process may live on."""
