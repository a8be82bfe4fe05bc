"""Worlds: boards of holds and regions to keep out of, fields of patches, grounds to walk on, as plain data; they know no robots."""

from .board import Board as Board
from .board import Hold as Hold
from .field import PatchField as PatchField
from .ground import Ground as Ground
from .library import board_names as board_names
from .library import ground_names as ground_names
from .library import load_board as load_board
from .library import load_field as load_field
from .library import load_ground as load_ground
from .library import patch_field_names as patch_field_names
