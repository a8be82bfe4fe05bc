"""Runs of plans of robots in space."""
