"""Free flight of tangent vectors, as two factors of each mode."""

import numpy as np
import pytest
from support.oscillators import PAPER

from vibro_sweep.engine.one_system import Engine
from vibro_sweep.engine.simd.jit import exported
from vibro_sweep.engine.variational import tangent, tangent_flight


@exported
def leaps(e, cells, out):
    t, flights = e.tangent[0], e.flights
    tangent.set_frame(t, 0, flights.oscillator[0, 0])
    for n in range(len(cells)):
        tangent_flight.leap_over(t, 0, flights.oscillator[0, 0], flights.nodes[0], cells[n])
        for j in range(out.shape[1]):
            out[n, j] = t.leap[j, 0]


@pytest.mark.parametrize("changes", [{}, {"zeta": 1.3}, {"zeta": 0.0}], ids=str)
def test_flights_over_any_number_of_cells(changes):
    """e^{-eta u} cos(omega_d u) and e^{-eta u} sin(omega_d u)/omega_d, up to more periods than are joined."""
    engine = Engine(PAPER.replace(**changes))
    q = engine.ensemble.flights.oscillator[0, 0]
    cells = np.arange(0, (tangent_flight.FEW + 2) * engine.cells, 7)
    found = np.empty((len(cells), 4))
    leaps(engine.ensemble, cells, found)
    u = cells * np.longdouble(engine.width)
    for j in range(2):
        eta, omega_d = -q["frame_series"][1, 2 * j], np.sqrt(np.clongdouble(q["frame_square"][j]))
        decay = np.exp(-eta * u)
        c, s = decay * np.cos(omega_d * u), decay * np.sin(omega_d * u) / omega_d
        # what rounding of the angle does, and that of a few sums
        most = 2.0**-53 * (32 + 2 * abs(omega_d * u)) * (abs(c) + abs(omega_d * s))
        np.testing.assert_array_less(abs(found[:, 2 * j] - c), most)
        np.testing.assert_array_less(abs(found[:, 2 * j + 1] - s) * abs(omega_d), most)
