"""Worlds: boards of holds and regions to keep out of, grounds to walk on, as plain data; they know no robots."""

from .board import Board as Board
from .board import Hold as Hold
from .ground import Ground as Ground
from .library import board_names as board_names
from .library import ground_names as ground_names
from .library import load_board as load_board
from .library import load_ground as load_ground
