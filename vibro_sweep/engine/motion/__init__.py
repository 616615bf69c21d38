"""Orbits: exclusion test, first contact, impact, chatter, sticking, and the event loop."""
