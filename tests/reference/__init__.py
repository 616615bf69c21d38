"""Slow and obvious versions of what the package computes, which the fast ones are held against."""
