"""Coordinates of motion at a contact and of tangent vectors, and bounds of motion, of stacks of oscillators."""
