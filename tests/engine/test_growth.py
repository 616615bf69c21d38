"""Growth of tangent vectors in two floats, and what rounding takes from the last one: against many digits."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest

from vibro_sweep.engine.simd.jit import exported
from vibro_sweep.engine.simd.lanes import LANES, lanes_of
from vibro_sweep.engine.simd.memory import new_lines
from vibro_sweep.engine.variational.growth import add_log, excess_of_record, shrink_volume
from vibro_sweep.engine.variational.multiplier_groups import FIRST, find_multipliers, multipliers_of
from vibro_sweep.engine.variational.orthonormal import orthonormalise
from vibro_sweep.engine.variational.tangent import tangents_of

N, EVERY = 2, 2**LANES - 1


@exported
def add_logs(tangents, logs, dampings, times):
    t = tangents[0]
    for n in range(len(dampings)):
        for j in range(len(t.growth)):
            add_log(t, j, 0, logs[n, j], 0.0)
        shrink_volume(t, 0, dampings[n], times[n])
    return excess_of_record(t, 0)


@exported
def orthonormalise_all(tangents):
    orthonormalise(tangents[0], lanes_of(EVERY))


@exported
def multipliers_from(product, logs, found, beside, matrix):
    return find_multipliers(True, product, logs[0], logs[1], matrix, 0.0, 1.0, found[0], beside, FIRST)


@pytest.mark.slow
def test_the_sum_of_logarithms_of_many_thousands():
    """What a hundred thousand contacts do to volumes, against fractions; one float would lose 1e-8 of it."""
    rng, n = np.random.default_rng(1), 100_000
    dampings, times = rng.uniform(1e4, 1e5, n), rng.uniform(0, 1e-2, n)
    logs = np.stack([rng.normal(size=n), -dampings * times], 1)
    tangents = new_lines(1, tangents_of(1, True))
    tangents["growth"] = 1.0
    exact = sum(map(Fraction, logs.ravel()))
    exact += sum(Fraction(c) * Fraction(w) for c, w in zip(dampings, times, strict=True))
    found = add_logs(tangents, logs, dampings, times)
    assert abs(found - float(exact)) < 1e-15 * abs(float(exact)) + 1e-20
    assert abs(logs.sum() + (dampings * times).sum() - float(exact)) > 1e-10


def shrunken(rng, part):
    """Columns of which the last one is this part away from those before, and their determinant to many digits."""
    Z = rng.normal(size=(2 * N, 2 * N))
    Z[:, -1] = Z[:, :-1] @ rng.normal(size=2 * N - 1) + part * Z[:, -1]
    with mpmath.workdps(40):
        return Z, abs(mpmath.det(mpmath.matrix(Z.tolist())))


def test_the_last_vector_has_what_the_others_leave_of_the_volume():
    """Where one direction has shrunk to 1e-9 of the others ten digits of its length are lost in Z itself."""
    rng, tangents = np.random.default_rng(2), new_lines(1, tangents_of(N, True))
    t, size = tangents[0], 2 * N
    Z, volumes = zip(*(shrunken(rng, 1e-9) for _ in range(LANES)), strict=True)
    t["Z"] = np.array(Z).transpose(1, 2, 0).reshape(size * size, LANES)
    t["growth"], t["volume"] = 1.0, np.array(volumes, float)
    t["volume"][1] *= 2  # no rounding
    orthonormalise_all(tangents)
    together = np.prod(t["growth"], axis=0)
    off = np.abs(together / np.array(volumes, float) - 1)
    assert np.delete(off, 1).max() < 1e-14 and off[1] < 1e-5
    in_floats = np.prod([np.abs(np.diag(np.linalg.qr(one)[1])) for one in Z], axis=1)
    assert np.abs(in_floats / np.array(volumes, float) - 1).max() > 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("turned", [0.0, 1e-8])
@pytest.mark.parametrize("gap", [1.0, 60.0])
def test_multipliers_of_skewed_factors(turned, gap):
    """D^1/2 U Q D^1/2 with entries of 1e4 in U: against sixty digits, of one group and of several, where Q turns the
    directions by less than it takes to see it, and their product is that of D to the last digit."""
    rng, n = np.random.default_rng(3), 4
    U = np.triu(1e4 * rng.normal(size=(n, n)), 1) + np.eye(n)
    Q = np.linalg.qr(np.eye(n) + turned * rng.normal(size=(n, n)))[0]
    Q *= np.sign(np.diag(Q))
    logs = np.zeros((2, n))
    logs[0] = -gap * np.arange(n) - 0.1
    found = np.zeros(1, multipliers_of(n))
    assert multipliers_from(U @ Q, logs, found, np.empty((3, n)), np.empty((n, n)))
    with mpmath.workdps(60):
        D = mpmath.diag([mpmath.exp(x) for x in logs[0]])
        exact = mpmath.eig(mpmath.matrix(U.tolist()) * mpmath.matrix(Q.tolist()) * D, left=False, right=False)
        exact = sorted((float(mpmath.log(abs(one))) for one in exact), reverse=True)
    np.testing.assert_allclose(found[0]["log"], exact, rtol=0, atol=1e-6)
    assert abs(found[0]["log"].sum() + found[0]["low"] - logs[0].sum()) < 1e-13
