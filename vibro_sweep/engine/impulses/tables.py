"""Exponentials and Taylor coefficients over many cells of equal width, in extended precision: built by doubling, so
that long periods add no rounding."""

import numpy as np

ORDER = 15  # of the Taylor polynomials: 0.5^16/16! = 7e-19
REACH = 0.5  # largest |A| times the width of a cell
REAL = np.longdouble


def exponential(A: np.ndarray, width) -> np.ndarray:
    """exp(A width) in extended precision, where |A| width is about `REACH` or less: 0.5^22/22! = 2e-28."""
    scaled = A * REAL(width)
    result = term = np.eye(len(A), dtype=REAL)
    for n in range(1, 22):
        term = term @ scaled / n
        result = result + term
    return result


def power(E: np.ndarray, count: int) -> np.ndarray:
    result = np.eye(len(E), dtype=E.dtype)
    while count:
        if count & 1:
            result = result @ E
        E, count = E @ E, count >> 1
    return result


def nodes(E: np.ndarray, start: np.ndarray, count: int) -> np.ndarray:
    """start, E start, E^2 start, ...: (count, len(start))."""
    block = start[None]
    while len(block) < count:
        block = np.concatenate([block, block @ E.T])
        E = E @ E
    return block[:count]


def taylor_rows(A: np.ndarray, row: np.ndarray) -> np.ndarray:
    """row A^n/n! for n = 0 .. ORDER; of a row or a matrix of them."""
    rows = [row]
    for n in range(1, ORDER + 1):
        rows.append(rows[-1] @ A / REAL(n))
    return np.array(rows)


def solve_refined(matrix, right):
    """Solve in double precision, refined with residuals in extended precision."""
    inverse = np.linalg.inv(matrix.astype(float))
    solution = np.zeros(right.shape, REAL)
    for _ in range(3):
        solution = solution + inverse @ (right - matrix @ solution)
    return solution
