"""Robots, plans and runs as other programs read them."""
