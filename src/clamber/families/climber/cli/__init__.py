"""Commands that only climbers have."""
