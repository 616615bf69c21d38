"""Periodic orbits as sequences of impacts: found, certified, kept."""
