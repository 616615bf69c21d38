"""Speed regressions: `pytest benchmarks/test_speed.py`, with `--benchmark-compare` against a run that was saved.

Not part of the tests (`testpaths`). Each benchmark does a fixed amount of work, so that runs can be compared.
"""

import numpy as np
import problem
import pytest
from engine import block_of, scene_text
from peers import ENGINE, EXPONENTS, method

import vibro_sweep as vs
from vibro_sweep.driver.compute import compute
from vibro_sweep.engine.one_system import points_of
from vibro_sweep.engine.tables import build as tables
from vibro_sweep.engine.tables.flight import Flight, new_flight
from vibro_sweep.engine.tables.series import new_workspace

PERIODS = 29 * 100
CLEARANCES = (6.8, *problem.CLEARANCES)


@pytest.mark.parametrize("name", [ENGINE, EXPONENTS])
@pytest.mark.parametrize("b", CLEARANCES)
def test_orbit(benchmark, b, name):
    """Eight orbits over 2900 forcing periods on the attractor."""
    benchmark.group = name
    job = method(name).solver(*problem.on_attractor(b)).job(PERIODS)
    job()
    hits = benchmark(job)
    assert hits == 8 * {6.8: 0, 6.69: 8 * 100, 3.0: 2 * PERIODS, 1.0: 2 * PERIODS}[b]


def test_tables(benchmark):
    """The tables of one oscillator: the cost of a point whose parameters are its own."""
    params = problem.on_attractor(3.0)[0]
    point = points_of({name: np.array(value) for name, value in params.items()})[()]
    names = ("psi", "omega_squared", "mu_m", "mu_k", "zeta", "f2", "omega", "tau")
    cells = int(point["cells"])
    flights = new_flight(1, cells, 2)
    flight = Flight(flights.oscillator[0], flights.nodes[0], flights.scan[0])
    arguments = (flight, new_workspace(), cells, *(point[name] for name in names))
    tables.build(*arguments)
    benchmark(tables.build, *arguments)


def test_simulate(benchmark):
    """One orbit for a person at a prompt: 100 periods with their impacts."""
    params, states = problem.on_attractor(3.0)
    orbit = benchmark(vs.simulate, vs.System(**params), states[0], 100)
    assert orbit.status == "ok" and len(orbit.impacts) == 200


def test_sweep(benchmark):
    """201 clearances from 6.5 to 6.9, 300 periods, everything observed."""
    params = problem.on_attractor(3.0)[0]
    key = "sweep: {b: {start: 6.5, stop: 6.9, num: 201}}"
    block = block_of(scene_text(params, (0.0,) * 4, "section, lyapunov, impacts", key, transient=200, record=100))
    compute(block)
    _, arrays = benchmark(compute, block)
    assert not arrays["status"].any()


@pytest.mark.parametrize("b", problem.CLEARANCES)
def test_no_slower_by_being_wrong(b):
    """The first 40 impacts, held against 40 digits."""
    found = problem.error(b, lambda params, state, count: method(ENGINE).solver(params, state).impacts(count))
    assert found.matched == problem.COUNT
    assert found.largest < 10 * problem.rounding(b)
