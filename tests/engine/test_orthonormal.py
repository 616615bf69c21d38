"""Gram-Schmidt on the tangent vectors of eight orbits, compared with NumPy's QR."""

import numpy as np
import pytest
from support import slow_cases

from vibro_sweep.engine.simd.jit import exported
from vibro_sweep.engine.simd.lanes import LANES, lanes_of
from vibro_sweep.engine.simd.memory import new_lines
from vibro_sweep.engine.variational.orthonormal import orthonormalise
from vibro_sweep.engine.variational.tangent import tangents_of


@exported
def orthonormalise_some(tangents, who):
    orthonormalise(tangents[0], lanes_of(who))


@pytest.mark.parametrize("masses", [2, *slow_cases(1, 3)])
def test_vectors_are_those_of_a_qr_decomposition(masses):
    """Z = Q R with a positive diagonal of R, in the orbits asked for; the others are as before."""
    n, who = 2 * masses, np.array([True, True, False, True, False, False, True, True])
    tangents = new_lines(1, tangents_of(masses))
    t = tangents[0]
    Z = np.random.default_rng(masses).normal(size=(LANES, n, n)) * np.logspace(0, -2, n)
    growth = np.full((n, LANES), 3.0)
    growth[1, 0] = 1e103  # leaves the range in which products are kept
    growth[0, 3] = 1e-103
    t["Z"], t["growth"], t["volume"], t["lost"][1] = Z.transpose(1, 2, 0).reshape(n * n, LANES), growth, 0.5, 1.0
    orthonormalise_some(tangents, int(np.packbits(who, bitorder="little")[0]))
    after = t["Z"].reshape(n, n, LANES).transpose(2, 0, 1)
    Q, R = np.linalg.qr(Z)
    signs = np.sign(np.diagonal(R, axis1=1, axis2=2))
    Q, lengths = Q * signs[:, None, :], np.diagonal(R, axis1=1, axis2=2) * signs
    Q[1, :, -1] = lengths[1, -1] = 0.0  # the lost dimension
    np.testing.assert_allclose(after[who], Q[who], rtol=0, atol=1e-13 * np.linalg.cond(Z).max())
    np.testing.assert_array_equal(after[~who], Z[~who])
    np.testing.assert_array_equal(t["volume"], np.where(who, 1.0, 0.5))
    with np.errstate(divide="ignore"):
        expected = np.log(growth) + np.where(who, np.log(lengths.T), 0.0)
        found = np.log(t["growth"]) + t["logs"]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11)
    taken = np.zeros((n, LANES), bool)
    taken[1, 0] = taken[0, 3] = taken[-1, 1] = True  # only of these were logarithms taken
    np.testing.assert_array_equal(t["logs"] != 0.0, taken)
    np.testing.assert_array_equal(t["growth"][taken], 1.0)
