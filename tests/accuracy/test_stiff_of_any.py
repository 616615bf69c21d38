"""Rates far apart, of any oscillator: the exclusion test bounds fast roots, and nothing that it passes over strikes.

The truth is the same oscillator without exclusion test, cell by cell, or on a grid that resolves every rate.
"""

import numpy as np
import pytest
from support.any_oscillators import positive

import vibro_sweep as vs
from vibro_sweep.engine import any_points
from vibro_sweep.engine.one_system import Engine
from vibro_sweep.engine.tables import cells as tables
from vibro_sweep.model.exponentials import gap_exponentials

pytestmark = pytest.mark.slow

PAPER = vs.System(mu_m=1e-4, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=1.0, tau=0.3)


def blindly(monkeypatch):
    """No exclusion test: every cell is looked at."""

    def untold(*arguments):
        return gap_exponentials(*arguments)._replace(valid=False)

    monkeypatch.setattr(any_points, "gap_exponentials", untold)


def stiff(seed, masses, damping):
    """One spring far stiffer than the others, along any direction, and dampers of any size."""
    rng = np.random.default_rng([masses, seed])
    link = rng.normal(size=masses)
    K = positive(rng, masses, 0.2) + 10.0 ** rng.uniform(7, 8) / (link @ link) * np.outer(link, link)
    C = 0.05 * positive(rng, masses, 0.1)
    if damping == "strong":
        C = C + 10.0 ** rng.uniform(3, 4) / (link @ link) * np.outer(link, link)
    along = np.eye(masses)[0] if rng.random() < 0.5 else rng.normal(size=masses)
    system = vs.Oscillator(
        positive(rng, masses, 1.0), K, C, contact_normal=along, force=rng.normal(size=masses),
        constant=0.1 * rng.normal(size=masses), omega=0.8, tau=float(rng.uniform(-3, 3)),
        b=10.0 ** rng.uniform(-1.5, 0), R=0.8, R_left=0.6,
    )  # fmt: skip
    return system, np.zeros(2 * masses)


@pytest.mark.parametrize("damping", ["little", "strong"])
@pytest.mark.parametrize("masses", [3, 2, 5])
def test_the_exclusion_test_leaves_nothing_out(masses, damping, monkeypatch):
    impacts = 0
    for seed in range(4):
        system, state = stiff(seed, masses, damping)
        engine = Engine(system)
        assert engine.cells == tables.STIFF_CELLS and np.isfinite(engine.flight.oscillator["remainder"]).all()
        found = vs.simulate(system, state, 2)
        with monkeypatch.context() as patch:
            blindly(patch)
            looked = vs.simulate(system, state, 2)
        assert np.isinf(looked._engine.flight.oscillator["remainder"]).all()
        assert found.status == looked.status == "ok" and len(found.impacts) == len(looked.impacts)
        np.testing.assert_array_equal(found.impacts["side"], looked.impacts["side"])
        many = min(len(found.impacts), 12)
        np.testing.assert_allclose(found.impacts["t"][:many], looked.impacts["t"][:many], rtol=0, atol=1e-9)
        impacts += many
    assert impacts > 10


@pytest.mark.parametrize("masses", [3, 2, 5])
def test_bounds_hold_at_all_nodes(masses):
    """The gap of flights from any state lies as near to the cubic of the slow roots as the bounds say."""
    rng, nearest = np.random.default_rng(1), np.inf
    for seed in range(3):
        system, _ = stiff(seed, masses, "little")
        engine = Engine(system)
        flight, q = engine.flight, engine.flight.oscillator[0]
        z, scan, cells = flight.nodes["z"], flight.scan, engine.cells
        for _ in range(20):
            X = rng.normal(size=2 * masses) * 10.0 ** rng.uniform(-3, 0, 2 * masses)
            y = X - z[0, : 2 * masses]
            exact = np.einsum("kj,j->k", flight.nodes["E"][:, : 2 * masses, 0], y) + z[:, 0]
            points = scan[-1, : 2 * cells + 1] + y @ scan[:-1, : 2 * cells + 1]
            middle = (points[1:-1:2] + points[2::2]) / 2  # the cubic at nodes 1, 2, ...
            bound = q["remainder"][-1] + np.abs(y) @ q["remainder"][:-1]
            assert np.abs(middle - exact[1:]).max() <= bound
            nearest = min(nearest, bound / np.abs(y).max())
    assert nearest < 1


def test_the_paper_by_its_matrices():
    """As the test by modes has it, with the bounds of the energies."""
    q = PAPER.linear
    same = vs.Oscillator(
        q.M, q.K, q.C, contact_normal=q.normal, force=q.sine, force_cos=q.cosine, omega=0.63, R=0.8, b=1.0, tau=0.3
    )
    one, other = (vs.simulate(system, np.zeros(4), 10).impacts for system in (PAPER, same))
    assert len(one) == len(other) > 10
    np.testing.assert_allclose(other["t"], one["t"], rtol=0, atol=1e-11)


@pytest.mark.parametrize(("K", "C"), [((0.0, 1e8, 1.0), (0.0, 10.0, 0.0)), ((1.0, 1e8, 4.0), (2.0, 10.0, 0.1))])
def test_where_eigenvectors_coincide(K, C, monkeypatch):
    """A free mode, and critical damping: the sum of exponentials loses digits, and the bounds say so."""
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    system = vs.Oscillator(
        np.eye(3), turn @ np.diag(K) @ turn.T, turn @ np.diag(C) @ turn.T, contact_normal=[1, 0, 0], force=[1, 0, 0.5],
        constant=[0, 0, 0.01], omega=0.8, tau=0.1, b=0.02, R=0.8,
    )  # fmt: skip
    found = vs.simulate(system, np.zeros(6), 3)
    blindly(monkeypatch)
    looked = vs.simulate(system, np.zeros(6), 3)
    assert found.status == looked.status == "ok" and len(found.impacts) == len(looked.impacts) > 3
    np.testing.assert_allclose(found.impacts["t"][:10], looked.impacts["t"][:10], rtol=0, atol=1e-9)
