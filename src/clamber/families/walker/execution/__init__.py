"""A two-frame walker that walks: its plant, its motions, and what carries a walk out."""
