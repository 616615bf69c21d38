"""Analyses of single systems, on top of the engine."""
