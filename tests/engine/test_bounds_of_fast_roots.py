"""The exclusion test bounds fast roots, of any oscillator."""

import numpy as np
import pytest
from support.drawn_oscillators import drawn_with_a_stiff_spring

from vibro_sweep.engine.one_system import Engine
from vibro_sweep.engine.tables import cells as tables


@pytest.mark.slow
@pytest.mark.parametrize("masses", [3, 2, 5])
def test_bounds_hold_at_all_nodes(masses):
    """The gap of flights from any state lies as near to the cubic of the slow roots as the bounds say."""
    rng, nearest = np.random.default_rng(1), np.inf
    for seed in range(3):
        system, _ = drawn_with_a_stiff_spring(seed, masses, "little")
        engine = Engine(system)
        assert engine.cells == tables.STIFF_CELLS and np.isfinite(engine.flight.oscillator["remainder"]).all()
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
