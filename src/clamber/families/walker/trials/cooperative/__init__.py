"""Cooperative motion of a walker's body and arm, run: tool paths and what following them comes to."""
