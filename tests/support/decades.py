"""Extrema by their distance from a stop, 10^-1 .. 10^-15 of the amplitude."""

import numpy as np

DECADES = np.arange(1, 16)
EPS = 2.0**-52
