"""Hoshino, Fukuda, Adachi and Muro, *Posture Control of Six-legged Integrated Locomotion and Manipulation Robot*: its published results."""

from typing import Final

PAPER: Final = "hoshino-1995"
