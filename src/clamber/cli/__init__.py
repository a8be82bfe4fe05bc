"""The command `clamber`: one file or folder per command; they read options, call the package and print what it answers."""

from .app import main as main
