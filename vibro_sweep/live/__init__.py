"""The live page: sweeps that are seen while they are computed."""
