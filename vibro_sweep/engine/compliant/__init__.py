"""Compliant stops: contacts that last, in closed steps of Taylor series."""
