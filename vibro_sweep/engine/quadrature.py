"""Eight nodes of Gauss and Legendre on 0 .. 1: of a motion whose rates they resolve, mean squares to rounding."""

import numpy as np

NODES = 8
_x, _w = np.polynomial.legendre.leggauss(NODES)
PLACES, WEIGHTS = (_x + 1) / 2, _w / 2
