"""Identification of a geared joint from samples of its motion: arrays in, numbers with their errors out."""
