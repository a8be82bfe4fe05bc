"""The limb bench: laws compared on one geared limb, with the same command and the same plant."""
