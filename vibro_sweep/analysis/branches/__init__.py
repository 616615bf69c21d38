"""Branches of periodic orbits in one number: steps, special points, switching."""
