"""Carrying plans and aims out on a plant: the plant's protocol, the closed loop, what happened."""
