"""Which orbits of a sweep lie in a window: section states of its orbit at many values at once."""

import numpy as np
import pytest
from support.windows import SYSTEM, few  # noqa: F401

import vibro_sweep as vs
from vibro_sweep.analysis.branches.branch_arrays import section_states
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of
from vibro_sweep.analysis.windows.members import members, solution_in


@pytest.mark.slow
def test_section_states_are_those_of_simulated_orbits(few):  # noqa: F811
    """Of symmetric and other orbits, on both sides of the middle, and of the free motion; and the mirror images."""
    windows = [window for window in vs.windows(few) if window.lo > 5.1]
    assert {window.symmetric for window in windows} == {True, False} and windows[-1].itinerary == ""
    for window in windows:
        values = window.lo + (window.hi - window.lo) * np.array([0.1, 0.5, 0.93])
        for value in values:
            system = SYSTEM.replace(b=value)
            states = section_states(orbit_of(system, solution_in(window._arrays, value, system)))
            assert len(states) == window.period * (1 if window.symmetric else 2)
            flight = vs.simulate(system, states[0], window.period)
            assert np.abs(flight.section[-1] - states[0]).max() < 1e-9
            mirrored = -flight.sample(system.period * (np.arange(window.period) + 0.5))
            for expected in (flight.section, mirrored):
                apart = np.abs(states[:, None] - expected).max(axis=2).min(axis=0)
                assert apart.max() < 1e-8


@pytest.mark.parametrize("key, values", [("b", [6.598, 6.6, 6.606, 6.609]), ("omega", [0.6299, 0.63, 0.6302])])
def test_recorded_states_are_members(key, values, tmp_path):
    """Recorded states are members, states that are 1 % away from all of the orbit's are none."""
    start = {"random": 4, "seed": 3}
    vs.sweep(SYSTEM, {key: values}, start=start, transient=1500, record=60, output=tmp_path / "m.h5", workers=1).close()
    windows = vs.windows(tmp_path / "m.h5")
    window = next(one for one in windows if one.period == 13)
    with vs.open(tmp_path / "m.h5") as data:
        states = np.stack([data[name].values[..., -1] for name in ("x1", "v1", "x2", "v2")], axis=-1)
    inside = np.array([window.lo < value < window.hi for value in values])
    there, states = np.array(values)[inside], states[inside]
    expected = (windows.window[inside] >= 0) & (np.array([one.period for one in windows])[windows.window[inside]] == 13)
    assert expected.any()
    assert (members(window._arrays, SYSTEM, key, there, states) == expected).all()
    assert not members(window._arrays, SYSTEM, key, there, 1.01 * states + 0.02).any()
    system = SYSTEM.replace(**{key: there[0]})
    assert solution_in(window._arrays, float(there[0]), system).real
