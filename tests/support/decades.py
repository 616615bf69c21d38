"""Extrema by their distance from a stop, 10^-1 .. 10^-15 of the amplitude, and a table of what was found there."""

import numpy as np

DECADES = np.arange(1, 16)
EPS = 2.0**-52


def show(title, rows):
    print(
        f"\n{title}\n 10^-k | flights behind, contacts, missed, invented | flights before, contacts, missed, invented"
    )
    for decade, (behind, before) in zip(DECADES, rows, strict=True):
        cells = [f"{r[0]:8d} {r[3]:8d} {r[1]:4d} {r[2]:4d}" for r in (behind, before)]
        print(f"   {decade:3d} | " + " | ".join(cells))
