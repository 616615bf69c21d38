"""The multipliers of an orbit with impacts."""

import numpy as np

from vibro_sweep.engine.impulses import flights, graded_product
from vibro_sweep.engine.impulses.flow import Flow
from vibro_sweep.oscillator.linear import Linear

UNORDERED = 1e-9  # of the period: by so much rounding may exchange impacts


def multipliers_of(f: Flow, sigma: int, P: float, contacts: np.ndarray, u, motion) -> np.ndarray:
    """(2N,) of the map over P, with the mirror for sigma = -1; by falling modulus, of a pair +im first.

    contacts : (K, 2 or more) stop, 1 + R
    They do not depend on the force: the flow may be that of an oscillator with another one.
    """
    n = f.B.shape[0] - 3
    if len(contacts) == 0:
        values = sigma * np.exp(np.linalg.eigvals(f.B[:n, :n]).astype(complex) * P)
        return values[np.lexsort((-values.imag, -np.abs(values)))]
    t = u[: len(contacts)]
    if not (np.all(t[1:] - t[:-1] > -UNORDERED * P) and t[-1] - t[0] < (1 + UNORDERED) * P):  # no orbit
        return np.full(n, np.nan, complex)
    product, columns, couplings = np.empty((n, n)), np.empty((n, n)), np.zeros(n)
    order, work, workspace = np.empty(n, np.int64), np.empty((3, n, n)), flights.new_workspace(n + 3)
    pieces = int((1 + len(t) * UNORDERED) * P * f.spread / graded_product.STRETCH)
    factors = np.empty((len(t) + pieces + 1, n, n))  # a piece more than the flights need but for rounding
    motion = np.ascontiguousarray(motion)
    graded_product.multiply(f, contacts, u, P, motion, product, columns, couplings, order, factors, work, workspace)
    values = sigma * graded_product.eigenvalues(product, columns, couplings)
    return values[np.lexsort((-values.imag, -np.abs(values)))]


def squared(values: np.ndarray) -> np.ndarray:
    """Multipliers of the whole period from those of half of it. An infinite one stays so: as a product it were NaN."""
    return np.square(values, out=np.full(values.shape, np.inf, complex), where=~np.isinf(values))


def contacts_of(q: Linear, sides) -> np.ndarray:
    """(K, 2) stop and 1 + R."""
    sides = np.asarray(sides)
    return np.column_stack([q.contact.stop(sides), 1 + q.contact.restitution(sides)])
