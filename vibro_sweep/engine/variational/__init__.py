"""Tangent vectors along orbits, and the Lyapunov spectrum from their growth."""
