"""Walks of two-frame walkers in contact dynamics: one, or many with what nobody told the robot."""
