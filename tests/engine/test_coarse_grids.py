"""Coarse cells, small steps within them, fast roots bounded: as on a grid that resolves every rate."""

import numpy as np
import pytest

import vibro_sweep as vs
from vibro_sweep.engine.tables import cells as tables

PAPER = dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.0, omega=0.63, R=0.8, b=1.0)


@pytest.fixture
def grid(monkeypatch):
    """grid(cells): every system gets so many; grid(None): as many as its rates ask for."""

    def choose(cells):
        monkeypatch.undo()
        if cells is None:
            monkeypatch.setattr(tables, "MOST_CELLS", 10**6)
        else:
            monkeypatch.setattr(tables, "MOST_CELLS", 0)
            monkeypatch.setattr(tables, "STIFF_CELLS", cells)

    return choose


def same(fine, coarse, time):
    assert fine.status == coarse.status == "ok" and len(fine.impacts) > 5
    steady = min(len(fine.impacts), len(coarse.impacts))  # of chatter, one or the other may list an impact more
    assert abs(len(fine.impacts) - len(coarse.impacts)) <= len(fine.sticking)
    np.testing.assert_allclose(coarse.section, fine.section, rtol=0, atol=1e-12)
    assert len(coarse.sticking) == len(fine.sticking)
    for name in ("t_on", "t_off"):
        np.testing.assert_allclose(coarse.sticking[name], fine.sticking[name], rtol=0, atol=1e-12 * time)
    if len(fine.sticking) == 0:
        np.testing.assert_allclose(coarse.impacts["t"], fine.impacts["t"], rtol=0, atol=1e-12 * time)
        assert (coarse.impacts["side"][:steady] == fine.impacts["side"][:steady]).all()


@pytest.mark.parametrize("cells", [8, 16])
@pytest.mark.parametrize(
    "changes",
    [dict(b=6.69), dict(b=3.0), {}, dict(R=0.3, b=0.5), dict(R=0.5, b=0.3, f2=0.5), dict(stops="right", b=0.2, R=0.9)],
    ids=str,
)
def test_a_coarse_grid_makes_no_difference(grid, changes, cells):
    """Eight cells resolve neither mode, sixteen the slower one."""
    system = vs.System(**{**PAPER, **changes})
    start = (0.1 * system.b, 0.2, 0.1, -0.3)
    orbits, spectra = [], []
    for n in (None, cells):
        grid(n)
        orbits.append(vs.simulate(system, start, 25))
        spectra.append(vs.lyapunov(system, start, 200, 100))
    same(*orbits, 25 * system.period)
    np.testing.assert_allclose(spectra[1], spectra[0], rtol=0, atol=1e-11)
