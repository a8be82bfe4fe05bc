"""Body and arm of a two-frame walker as one chain: its tool, how well it can be moved, and laws and limits of its motion."""
