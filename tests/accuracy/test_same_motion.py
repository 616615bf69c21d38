"""The same motion, described in another way: in other coordinates, mirrored, alone or among eight."""

import math

import numpy as np
import pytest
from reference import naive
from support import slow_cases
from support.drawn_oscillators import drawn, one_mass

import vibro_sweep as vs

SMALL = [2, *slow_cases(1, 3)]


@pytest.mark.slow
@pytest.mark.parametrize("masses", [2, *slow_cases(3)])
def test_other_coordinates(masses):
    """x -> S x and n -> S^-T n: the same gap, whatever the coordinates."""
    system, state = drawn(11, masses)
    q = system.linear
    S = np.linalg.inv(np.random.default_rng(5).normal(size=(masses, masses)) + 2 * np.eye(masses))  # x = S y
    same = vs.Oscillator(
        *(S.T @ matrix @ S for matrix in (q.M, q.K, q.C)), contact_normal=S.T @ q.contact.normal,
        force=S.T @ q.sine, force_cos=S.T @ q.cosine, constant=S.T @ q.constant,
        omega=system.omega, tau=system.tau, b=system.b, offset=system.offset, R=system.R, R_left=system.R_left,
    )  # fmt: skip
    there = np.kron(np.linalg.inv(S), np.eye(2)) @ state
    one, other = vs.simulate(system, state, 20), vs.simulate(same, there, 20)
    for name in ("t", "v1"):
        np.testing.assert_allclose(other.impacts[name][:10], one.impacts[name][:10], rtol=0, atol=2e-12)
    np.testing.assert_allclose(other.impacts["x"][:10] @ S.T, one.impacts["x"][:10], rtol=0, atol=1e-11)


@pytest.mark.parametrize("tau", [0.4, -2.0, 1.1])
def test_mirror_image(tau):
    """offset -> -offset, R exchanged, tau + pi, state -> -state."""
    numbers = dict(mu_m=10, mu_k=5, zeta=0.05, f2=0.25, omega=0.63, b=2.0)
    one = vs.System(**numbers, tau=tau, offset=0.3, R=0.8, R_left=0.6)
    other = vs.System(**numbers, tau=tau + math.pi, offset=-0.3, R=0.6, R_left=0.8)
    state = np.array([0.1, 0.2, 0.3, -0.1])
    hits, mirrored = (vs.simulate(system, x, 20).impacts[:10] for system, x in ((one, state), (other, -state)))
    assert np.array_equal(hits["side"], -mirrored["side"]) and set(hits["side"]) == {-1, 1}
    np.testing.assert_allclose(hits["t"], mirrored["t"], rtol=0, atol=1e-13)
    for name in ("v1", "x2", "v2"):
        np.testing.assert_allclose(hits[name], -mirrored[name], rtol=0, atol=1e-13)


@pytest.mark.slow
@pytest.mark.parametrize("masses", SMALL)
def test_mirror_image_of_any(masses):
    """The same, with the constant force turned round."""
    system, state = drawn(13, masses)
    turned = [-force for force in system.constant]
    other = system.replace(offset=-system.offset, R=system.R_left, R_left=system.R, constant=turned)
    other = other.replace(tau=system.tau + math.pi)
    hits, mirrored = (vs.simulate(one, x, 20).impacts[:10] for one, x in ((system, state), (other, -state)))
    assert np.array_equal(hits["side"], -mirrored["side"]) and len(hits) == 10
    np.testing.assert_allclose(hits["t"], mirrored["t"], rtol=0, atol=1e-13)
    for name in ("v1", "x", "xdot"):
        np.testing.assert_allclose(hits[name], -mirrored[name], rtol=0, atol=1e-13 * np.abs(hits[name]).max())


@pytest.mark.slow
def test_stiffly_joined_masses():
    """Two masses joined by a spring k: the difference from two masses falls like 1/k.

    The constant force displaces the two by (0.15, 0.05), from where their coordinates are counted. Of the three the one
    that strikes is not the first: with other tests of three masses they have the same kernels.
    """
    two = vs.Oscillator(
        [[1, 0], [0, 3]], [[1, -1], [-1, 3]], 0.1 * np.array([[1, -1], [-1, 3]]),
        contact_normal=[1, 0], force=[1, 0], omega=0.7, tau=0.2, b=0.3, offset=-0.15, R=0.8,
    )  # fmt: skip
    hits, apart = vs.simulate(two, [-0.15, 0, -0.05, 0], 20).impacts[:5], []
    for k in (1e4, 1e6, 1e8):
        K = np.array([[3 + k, -1, -k], [-1, 1, 0], [-k, 0, k]])
        C = 0.1 * np.array([[3, -1, 0], [-1, 1, 0], [0, 0, 0]])
        three = vs.Oscillator(
            np.diag([1.0, 1, 2]), K, C, contact_normal=[0, 1, 0], force=[0, 1, 0], constant=[0, 0.1, 0],
            omega=0.7, tau=0.2, b=0.3, R=0.8,
        )  # fmt: skip
        apart.append(np.abs(vs.simulate(three, np.zeros(6), 20).impacts[:5]["t"] - hits["t"]).max())
    assert apart[0] < 1e-2 and apart[1] < apart[0] / 30 and apart[2] < apart[1] / 30


@pytest.mark.slow
def test_impacts_at_the_sections():
    """The stop is at 0, where the gap has no size of its own to which its rounding could be compared."""
    speed, phi = 2 * math.pi / 1.8, math.acos(0.2 * math.pi / 1.8)
    ball = one_mass(force=[1.0], constant=[-1.0], omega=1.0, tau=phi, b=0.0, R=0.8, stops="left")
    orbit = vs.simulate(ball, [0.0, -speed], 50)
    assert orbit.status == "ok" and len(orbit.impacts) in (50, 51)
    np.testing.assert_allclose(orbit.impacts["v1"], -speed, rtol=1e-12)
    assert np.isfinite(vs.lyapunov(ball, [0.0, -speed], transient=0, record=20)).all()


def test_a_free_mode_of_the_paper():
    """Without a spring to the ground: two exponents are zero."""
    system = vs.System(mu_m=10, mu_k=0, zeta=0.05, f2=0.2, omega=0.63, R=0.8, b=1e3, tau=0.3)
    exponents = vs.lyapunov(system, [0.1, 0.2, 0.3, 0.1], transient=0, record=20)
    np.testing.assert_allclose(exponents, [0, 0, -0.055, -0.055], rtol=0, atol=1e-13)  # eta_2 = zeta (1 + 1/mu_m)


@pytest.mark.slow
@pytest.mark.parametrize("masses", SMALL)
def test_eight_orbits_are_as_one_alone(masses):
    """Bit for bit, whatever the others do; chatter and rests among them."""
    system, state = drawn(2, masses, R=0.5, b=0.4)
    names = [f"{letter}{mass}" for mass in range(1, masses + 1) for letter in "xv"]
    tones = system.omega * np.linspace(0.8, 1.2, 8)
    how = dict(start=dict(zip(names, state, strict=True)), transient=0, record=20, observe=["section", "impacts"])
    together, impacts = vs.sweep(system, {"omega": tones}, **how), 0
    for i, omega in enumerate(tones):
        alone = vs.sweep(system, {"omega": [omega]}, **how)
        for name in alone.data_vars:
            assert alone[name].values[0].tobytes() == together[name].values[i].tobytes(), name
        impacts += len(vs.simulate(system.replace(omega=omega), state, 20).impacts)
    assert impacts > 100


@pytest.mark.slow
def test_the_paper_by_its_matrices():
    """As the test by modes has it, with the bounds of the energies."""
    paper = vs.System(mu_m=1e-4, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=1.0, tau=0.3)
    q = paper.linear
    same = vs.Oscillator(
        q.M,
        q.K,
        q.C,
        contact_normal=q.contact.normal,
        force=q.sine,
        force_cos=q.cosine,
        omega=0.63,
        R=0.8,
        b=1.0,
        tau=0.3,
    )
    one, other = (vs.simulate(system, np.zeros(4), 10).impacts for system in (paper, same))
    assert len(one) == len(other) > 10
    np.testing.assert_allclose(other["t"], one["t"], rtol=0, atol=1e-11)


def test_a_transient_that_ends_above_grazing_ends_on_the_steady_motion():
    """All ways of asking for the same orbit: a long transient is jumped over, a record is not."""
    system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.8)
    x = [complex(a) * np.exp(1j * system.phase) for a in naive.response(system.parameters() | {"tau": 0.0})]
    steady = [part for a in x for part in (a.imag, (1j * system.omega * a).imag)]
    found = vs.sweep(system, {"b": [6.8, 7.5]}, observe=("section", "impacts"), transient=3000, record=10)
    for name, value in zip(("x1", "v1", "x2", "v2"), steady, strict=True):
        np.testing.assert_allclose(found[name].values, value, rtol=1e-12, atol=1e-12)
    assert not found.impacts_right.values.any() and not found.impacts_left.values.any()
