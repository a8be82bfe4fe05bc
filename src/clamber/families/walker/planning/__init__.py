"""Walks: what a two-frame walker is to do on a ground, step by step left to itself; read from files, with overrides."""

from .walk import Walk as Walk
from .walks import is_walk as is_walk
from .walks import load_walk as load_walk
from .walks import walk_names as walk_names
