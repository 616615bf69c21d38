"""Multipliers of many impacts: eigenvalues of products that span seventy decades, against 400 digits."""

import numpy as np
import pytest
from mpmath import mp, mpf
from support import slow_cases
from support.oscillators import PAPER

from vibro_sweep.analysis.periodic.orbit_multipliers import multipliers_of, squared
from vibro_sweep.engine.impulses.flow import flow

P = 5.0


def exact(B, R, t, motion):
    """Decimal logarithms of the moduli, falling."""
    with mp.workdps(400):
        A, M = mp.matrix(B[:4, :4].tolist()), mp.eye(4)
        for k, (v, a) in enumerate(motion[:, :2]):
            one_plus_R, S = 1 + mpf(R), mp.eye(4)
            S[0, 0] -= one_plus_R
            for i in (2, 3):
                S[i, 0] -= one_plus_R * A[i, 2]
            S[2, 0] += one_plus_R * mpf(a) / mpf(v)
            S[2, 2] -= one_plus_R
            end = mpf(t[k + 1]) if k + 1 < len(t) else mpf(t[0]) + mpf(P)
            M = mp.expm(A * (end - mpf(t[k])), method="taylor") * S * M
        return sorted((float(mp.log10(abs(value))) for value in mp.eig(M)[0]), reverse=True)


@pytest.mark.parametrize(
    "fastest", [0.3, *slow_cases(300.0)]
)  # acceleration before an impact: the shear is small, or large
@pytest.mark.parametrize("R", [0.8, *slow_cases(0.3, 0.1, 1e-3)])
def test_each_multiplier_keeps_its_digits(R, fastest):
    """Also where restitution and shear stretch little at one impact, and much at sixteen."""
    rng, f = np.random.default_rng(1), flow(PAPER.family.linear)
    t = np.sort(rng.uniform(0, P, 16)).tolist()
    motion = np.column_stack([rng.uniform(0.5, 1, 16), rng.uniform(-fastest, fastest, 16), np.zeros(16)])
    contacts = np.column_stack([np.zeros(16), np.full(16, 1 + R)])
    found = multipliers_of(f, 1, P, contacts, np.array([*t, *np.zeros(16)]), motion)
    R = contacts[0, 1] - 1  # as it is known
    error = np.log(10) * np.abs(np.log10(np.abs(found)) - exact(f.B, R, t, motion)).max()
    assert error < 1e-11


def test_an_infinite_multiplier_of_half_a_period_is_infinite_over_the_whole():
    """As at the graze of a contact without preload; a complex number that is infinite has the square NaN."""
    assert squared(np.array([np.inf, 0.5j, -2.0], complex)).tolist() == [np.inf, -0.25, 4.0]
