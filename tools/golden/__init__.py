"""Makes the golden record of tests/data/golden, or compares all of it with what is computed now: see `tests/golden`."""
