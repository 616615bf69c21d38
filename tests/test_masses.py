"""Kernels of the flow for other numbers of masses than two, against matrix exponentials."""

import numpy as np
import pytest
from reference.chains import Chain
from support.chain_tables import tables

from vibro_sweep.engine.motion import ensemble, orbits, strike
from vibro_sweep.engine.simd.jit import entry
from vibro_sweep.engine.variational import tangent
from vibro_sweep.model import status

CHAINS = {
    1: Chain([1.0], [1.0], 0.02, 0.7),
    3: Chain([1.0, 3.0, 2.0], [1.0, 2.0, 4.0], 0.03, 0.63),
    5: Chain([1.0, 1.0, 2.0, 1.0, 3.0], [1.0, 2.0, 2.0, 3.0, 5.0], 0.02, 0.5),
}
B, R, PERIODS = 0.6, 0.9, 4


@entry
def start(e, stops, states, exponents):
    """Orbits from these states; with tangent vectors, if they are wanted."""
    e.tangent[0].wanted = exponents
    for i in range(len(states)):
        o = e.orbits[i]
        f = ensemble.flight_of(e, o)
        strike.set_oscillator(e.strike[0], i, f.oscillator[0], stops)
        orbits.place(o, f.nodes, stops, 0, 0.0, states[i])
        if exponents:
            tangent.set_frame(e.tangent[0], i, f.oscillator[0])
            tangent.begin(e.tangent[0], i)


def carried(chain, states, exponents):
    """Eight orbits over `PERIODS`: the ensemble, and the logarithms of the growth of tangent vectors."""
    n, flights = chain.count, tables(chain)
    cells = int(flights.oscillator["cells"][0, 0])
    e = ensemble.new_ensemble(cells, impacts=200, masses=n)
    for own, one in zip(e.flights, flights, strict=True):
        own[:] = one[0]
    e.orbits["periods"] = PERIODS
    growth = np.zeros((8, 1, 2 * n))
    start(e, orbits.Stops(-B, B, R, R), states, exponents)
    ensemble.carry(e, None, ensemble.Readings(np.zeros((8, PERIODS, 2 * n)), True, growth, int(exponents)))
    return e, growth


@pytest.mark.slow  # each number of masses compiles its own kernels
@pytest.mark.parametrize("masses", CHAINS)
def test_orbits_and_tangent_vectors(masses):
    chain = CHAINS[masses]
    states = np.random.default_rng(masses).uniform(-1, 1, (8, 2 * masses)) * B * 0.9
    e, growth = carried(chain, states, True)
    plain, _ = carried(chain, states, False)
    assert (e.orbits["status"] == status.OK).all() and np.array_equal(e.orbits["X"], plain.orbits["X"])
    to, back, _ = chain.frame()
    struck = 0
    for i in range(8):
        impacts, end, jacobian = chain.orbit(states[i], B, R, PERIODS)
        found = e.records.impacts[i, : e.orbits["impacts_logged"][i]]
        assert len(found) == len(impacts)
        struck += len(found)
        q = e.flights.oscillator[i, 0]
        times = found[:, 0] * chain.period + found[:, 1] * q["width"] + found[:, 2]
        speed = np.abs(impacts[:, 2]).min(initial=1.0)
        np.testing.assert_allclose(times, impacts[:, 0], rtol=0, atol=1e-10 / speed)
        assert np.array_equal(found[:, 3], impacts[:, 1])
        np.testing.assert_allclose(found[:, 4], impacts[:, 2], rtol=0, atol=1e-9 / speed)
        np.testing.assert_allclose(e.orbits["X"][i, : 2 * masses], end, rtol=0, atol=1e-8)
        lengths = np.abs(np.diag(np.linalg.qr(to @ jacobian @ back)[1]))
        # the matrix of the reference knows its small factors to the rounding of the largest, and a slow impact turns
        # it by the error of its time over its speed
        unsure = 1e-8 / speed**2 + 1e-14 * lengths.max() / lengths
        assert (np.abs(growth[i, 0] - np.log(lengths)) < unsure).all()
    assert struck > 40
