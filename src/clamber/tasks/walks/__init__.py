"""Walks: what a two-frame walker is to do on a ground, step by step left to itself; read from files, with overrides."""

from .library import is_walk as is_walk
from .library import load_walk as load_walk
from .library import walk_names as walk_names
from .walk import Walk as Walk
