"""`clamber limb`: one file per command, what it prints beside it."""
