"""Periodic orbits as impact sequences: a branch runs smoothly through a graze, where shooting with the state fails."""
