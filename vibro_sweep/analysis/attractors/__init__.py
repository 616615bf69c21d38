"""Attractors: which orbits of a sweep belong together."""
