"""Worlds: boards of holds and regions to keep out of, as plain data; they know no robots."""

from .board import Board as Board
from .board import Hold as Hold
from .library import board_names as board_names
from .library import load_board as load_board
