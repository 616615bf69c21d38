"""Eigenvalues of small matrices against numpy and, where these are graded, against 40 digits."""

import mpmath
import numpy as np
import pytest
from numpy.random import default_rng
from support import sample

from vibro_sweep.engine.simd.jit import exported
from vibro_sweep.engine.variational.eigenvalues import eigenvalues
from vibro_sweep.engine.variational.graded import is_separate

SIZES = (1, 2, 3, 4, 6, 8, 16)


@exported
def all_eigenvalues(matrices, n, re, im):
    found = 0
    for k in range(len(matrices)):
        found += eigenvalues(matrices[k], n, re[k], im[k])
    return found


@exported
def is_parted(a, n, size):
    return is_separate(a, n, size)


def ours(matrices):
    matrices = np.array(matrices, float)
    re, im = np.full((2, *matrices.shape[:2]), np.nan)
    assert all_eigenvalues(matrices, matrices.shape[1], re, im) == len(matrices)
    return re + 1j * im


def matched(found, expected):
    """`found` in the order of `expected`: each takes the nearest that is left."""
    left, result = list(found), []
    for value in expected:
        result.append(left.pop(int(np.argmin([abs(other - value) for other in left]))))
    return np.array(result)


@pytest.mark.parametrize("n", SIZES)
def test_random_matrices(n):
    matrices = default_rng(n).normal(size=(300, n, n))
    for found, expected in zip(ours(matrices), np.linalg.eigvals(matrices), strict=True):
        np.testing.assert_allclose(matched(found, expected), expected, atol=1e-10)
        pairs = found[found.imag != 0]
        assert (pairs[::2] == pairs[1::2].conj()).all() and (pairs[::2].imag > 0).all()


def test_special_matrices():
    rotation = [[0, -1, 0], [1, 0, 0], [0, 0, 2]]
    companion = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]  # the cube roots of 1: a plain double shift never converges
    for matrix in (np.zeros((3, 3)), np.eye(3), rotation, companion, np.triu(np.ones((3, 3)))):
        expected = np.linalg.eigvals(np.array(matrix, float))
        np.testing.assert_allclose(matched(ours([matrix])[0], expected), expected, atol=1e-9)


def rounded(rng, shape):
    return 1e-16 * rng.normal(size=shape)


COUPLINGS = {  # of two groups of modes, beside those within a group, which are of size 1
    "alike": None,
    "none": lambda rng, shape: np.zeros(shape),
    "by rounding": rounded,
    "some by rounding": lambda rng, shape: np.where(rng.random(shape) < 0.5, 0.0, rounded(rng, shape)),
    "some": lambda rng, shape: np.where(rng.random(shape) < 0.5, 0.0, rng.uniform(-0.1, 0.1, shape)),
    "of any size": lambda rng, shape: rng.choice([-1, 1], shape) * 10.0 ** rng.uniform(-30, -1, shape),
}


@pytest.mark.parametrize("coupled", sample(2, COUPLINGS))
def test_small_eigenvalues_of_graded_matrices_keep_their_digits(coupled):
    """D^1/2 B D^1/2 with D from 1e6 to 1e-24 and a well-conditioned B, as products of factors give it."""
    rng, coupling = default_rng(3), COUPLINGS[coupled]
    worst = 0.0
    for _ in range(60):
        n = rng.integers(2, 7)
        b = np.eye(n) + 0.5 / n * rng.uniform(-1, 1, (n, n))
        if coupling:
            group = rng.integers(0, 2, n)
            b = np.where(group[:, None] == group, b, coupling(rng, (n, n)))
        d = np.sort(10.0 ** rng.uniform(-24, 6, n))[::-1]
        graded = np.sqrt(d)[:, None] * b * np.sqrt(d)
        with mpmath.workdps(80):
            exact = mpmath.eig(mpmath.matrix(graded.tolist()), left=False, right=False)
            expected = np.array([complex(value) for value in exact])
        found = ours([graded])[0]
        for value in expected:
            worst = max(worst, np.min(np.abs(found - value)) / abs(value))
    assert worst < 1e-14


@pytest.mark.parametrize("order", [(1.0, 1e-9, 0.5), (1e-9, 1.0, 0.5), (1.0, 0.5, 1e-9)])
def test_blocks_are_parted_only_where_all_before_exceed_all_behind(order):
    """The first two couple, and so do the last two; the third matrix alone has a gap, behind the second."""
    a = np.diag(order) + np.array([[0, 1, 1], [1, 0, 1], [0, 1, 0]]) * 1e-3
    before, parted = a.copy(), order[2] == 1e-9
    assert is_parted(a, 3, np.array(order)) != parted
    assert np.array_equal(a, before)
    a[2, 1] = 1e-30
    assert is_parted(a, 3, np.array(order))
    assert a[2, 1] == (0.0 if parted else 1e-30) and a[1, 0] == 1e-3
