"""The real parts from which exponents are known to be zero, and signs of exponents by their errors."""

import numpy as np
import pytest
from support import slow_cases, zero_exponents
from support.frames import frame_of_one

from vibro_sweep.tables.exponents import sign_of


@pytest.mark.parametrize("count", [20, *slow_cases(400)])
def test_roots_of_frames(count):
    """The roots from which tangent vectors fly, and the error that frames give them, against 100 digits."""
    compared = zeros = 0
    for seed in range(count):
        system = zero_exponents.free(seed)
        found = frame_of_one(system)
        if np.isnan(found.to).any():
            continue
        apart = np.sqrt(np.maximum(-found.square, 0.0))
        fast = found.eta + apart
        slow = np.where(found.square < 0, (found.square + found.eta**2) / np.where(fast > 0, fast, 1.0), found.eta)
        exact, own = zero_exponents.real_parts(system), np.sort(-np.concatenate([slow, fast]))[::-1]
        assert np.abs(own - exact).max() <= found.rounding, (seed, own, exact)
        assert (own[exact == 0] == 0).all(), (seed, own, exact)
        compared, zeros = compared + 1, zeros + np.count_nonzero(exact == 0)
    assert compared >= 0.95 * count and zeros > count


def test_an_error_that_is_not_a_number_tells_nothing():
    exponent = np.array([0.1, -0.1, 0.1, np.nan, -np.inf, 0.0])
    assert sign_of(exponent, np.array([0.01, 0.01, 0.06, 0.1, 0.0, 0.0])).tolist() == [1, -1, 0, 0, -1, 0]
