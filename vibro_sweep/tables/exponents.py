"""What is read off a record, exponents and arrival: what kernels, attractors, windows, files and pictures agree on."""

import numpy as np

ARRIVED = 3e-6  # distance from a periodic orbit, in parts of the sizes of coordinates, at which an orbit is there
LEAST_RECORD = 40  # periods from which on a record can tell whether its orbit has arrived
CERTAIN = 2.0  # standard errors by which an exponent must differ from zero to be above or below it
RUNNING = 200  # points at which exponents that converge are stored


def sign_of(exponent, error, certain=CERTAIN):
    """1 where an exponent is above zero by more than so many of its errors, -1 where it is below; else 0."""
    return 1 * (exponent > certain * error) - 1 * (exponent < -certain * error)


def periods_read(m, parts, periods):
    """Forcing periods of a record after which the growth of tangent vectors is read for the m-th of `parts` times."""
    return -(-(m + 1) * periods // parts)


def periods_to_go(distance, factor, goal=ARRIVED):
    """Forcing periods after which a distance that shrinks by a factor in each of them is the goal; NaN if unknown."""
    return np.ceil(np.maximum(np.log(goal / distance) / np.log(factor), 0.0))
