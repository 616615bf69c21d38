"""Bifurcation curves in two parameters and their points of codimension two."""
