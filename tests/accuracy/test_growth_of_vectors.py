"""Tangent vectors of any oscillator over some periods: their growth is that of the Jacobian in 30 digits."""

import numpy as np
import pytest
from support.drawn_oscillators import drawn
from support.monodromy import exponents_of

import vibro_sweep as vs

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("masses", (1, 2, 3))
def test_growth_of_tangent_vectors(masses):
    """The sum rule alone would not see a wrong term beside the diagonal of the saltation matrix."""
    for seed in (6, 7):
        system, state = drawn(seed, masses)
        exponents = vs.lyapunov(system, state, transient=0, record=2)
        assert abs(exponents.residual) < 1e-12
        np.testing.assert_allclose(exponents, exponents_of(system, state, 2), atol=1e-9)
