"""Commands that only two-frame walkers have."""
