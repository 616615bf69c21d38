"""What lies between two points of a branch although their tests do not tell: bifurcations and births."""

import numpy as np
import pytest
from support import slow_cases

import vibro_sweep as vs
from vibro_sweep.analysis.branches.crossings import explained, stands_alone
from vibro_sweep.analysis.branches.looking import extremum
from vibro_sweep.engine.continuation.between_points import FARTHER, dips
from vibro_sweep.engine.simd.jit import exported

BESIDE = vs.Oscillator(
    M=[[1.013195585878699, -0.55204056781175], [-0.55204056781175, 2.637855657462587]],
    K=[[0.6186294619195736, -0.43531312017067053], [-0.43531312017067053, 0.7490062589269704]],
    C=[[0.017931341976962122, -0.016782229109168982], [-0.016782229109168982, 0.05128108826042008]],
    contact_normal=[-0.9584651407408522, 1.2063082654617954], force=[0.5414602008133512, -0.4247086091937014],
    force_cos=[0.21265631867212226, 0.4614742868969503], omega=1.5001755162828383, R=0.669, b=0.2140312390626448,
    tau=3.8085663752458316,
)  # fmt: skip
TURNED = vs.Oscillator.named(
    "one_mass", zeta=0.009193095240087783, F=1.341737736580175, omega=1.4905, R=0.44, b=0.372790641903939,
    offset=-0.04156552419734383, tau=0.6194168875425987,
)  # fmt: skip


class Stand:
    """A point with multipliers only."""

    def __init__(self, multipliers):
        self.solution, self.torus = self, np.nan
        self.multipliers = multipliers


def crossings(matrices):
    """Which bifurcations lie between neighbouring matrices of a path, from their eigenvalues alone."""
    mu = np.array([np.sort_complex(np.linalg.eigvals(matrix)) for matrix in matrices])
    fold, flip = (np.sign(np.prod(1 - sign * mu, axis=1).real) for sign in (1, -1))
    outside = np.sum(np.abs(mu) > 1, axis=1)
    result = []
    for k in np.flatnonzero((np.diff(fold) != 0) | (np.diff(flip) != 0) | (np.diff(outside) != 0)):
        one = [kind for kind, sign in (("fold", fold), ("flip", flip)) if sign[k] != sign[k + 1]]
        result.append((k, one if one else ["neimark_sacker"]))
    return mu, result


@pytest.mark.parametrize("paths", [20, *slow_cases(400)])
def test_counts_tell_what_is_missing(paths):
    """On random paths of 4 x 4 matrices: a bifurcation explains the change that it makes, no other one does, nor
    none; what is not explained although nothing was left out are multipliers that meet near the circle, seldom."""
    rng, counted, refused, s = np.random.default_rng(4), 0, 0, np.linspace(0, 1, 2001)
    for _ in range(paths):
        parts = rng.normal(size=(3, 4, 4)) * [[[0.7]], [[1.0]], [[0.5]]]
        path = parts[0] + s[:, None, None] * parts[1] + (s**2)[:, None, None] * parts[2]
        mu, events = crossings(path)
        places = [0, *(k for k, _ in events), 2000]
        for before, (k, kinds), behind in zip(places, events, places[2:], strict=False):
            if len(kinds) != 1 or behind - before < 8:
                continue
            a, b = Stand(mu[max(k - 3, before + 1)]), Stand(mu[min(k + 4, behind)])
            if any(np.any(np.abs(np.abs(point.multipliers) ** 2 - 1) < 1e-6) for point in (a, b)):
                continue
            counted += 1
            refused += not explained(a, b, kinds)
            assert not explained(a, b, [])
            for other in {"fold", "flip", "neimark_sacker"} - set(kinds):
                assert not explained(a, b, [other])
    assert counted > 0.75 * paths
    assert refused < 0.02 * counted


@exported
def dips_at(x, y, z, before, behind):
    return dips(x, y, z, before, behind)


def test_an_extremum_is_looked_for_where_a_parabola_comes_nearer_to_zero():
    """Of 4000 parabolas at three points those with two zeros near the middle one, or between it and the last, and few
    others but those of which the middle point is much nearer to zero."""
    rng, looked, hidden = np.random.default_rng(3), 0, [0, 0]
    for _ in range(4000):
        before, behind = rng.uniform(0.5, 1.5, 2)
        at, least, curve = rng.uniform(-0.4, 1.0) * behind, rng.uniform(-0.2, 2.0), rng.uniform(0.2, 5.0)
        x, y, z = (least + curve * (place - at) ** 2 for place in (-before, 0.0, behind))
        if not (0 < y <= x and z > 0):
            continue
        found = extremum(before, behind, x, y, z)
        assert dips_at(x, y, z, before, behind) == (found is not None)
        assert dips_at(-x, -y, -z, before, behind) == (found is not None)
        looked += found is not None and min(x, z) <= FARTHER * y
        if least < 0:
            hidden[int(z < y)] += 1
            assert found == pytest.approx(at, abs=1e-9)
    assert min(hidden) > 20
    assert looked < 0.3 * 4000


def test_counts_do_not_tell_of_a_pair_that_goes_out_and_one_that_comes_in():
    here = np.array([1.01 * np.exp(2.7j), 0.99 * np.exp(2.3j), 0.5])
    ends = [Stand(np.array([*mu, *mu.conj()])) for mu in (here, here * [0.98, 1.02, 1], here * [1.001, 0.999, 1])]
    assert not explained(ends[0], ends[1], []) and not explained(ends[1], ends[0], [])
    assert explained(ends[0], ends[2], [])


def test_the_pair_on_the_circle_is_on_different_sides_before_and_behind():
    """Else another one has crossed it too: of two outside one is left, and a third one has gone out and come in."""
    at = np.array([1.05 * np.exp(2.6j), 0.99 * np.exp(2.1j), np.exp(1.7j)])
    paths = (at, at * [1, 1.02, 0.99], at * [1, 1, 0.99], at * [1, 1, 1.01])
    point, before, behind, other = (Stand(np.array([*mu, *mu.conj()])) for mu in paths)
    assert not stands_alone(before, behind, point, "neimark_sacker")
    assert stands_alone(other, behind, point, "neimark_sacker")
