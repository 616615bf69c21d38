"""Attractors of oscillators with compliant stops: their contacts are among what tells them apart."""

import numpy as np
import pytest
from support import slow_cases

import vibro_sweep as vs

BALL = vs.Oscillator.named(
    "ball_in_cavity", mass_ratio=0.05, zeta=0.01, F=0.05, omega=1, tau=0, k_stop=4, c_stop=0.1, b=1
)
MIXED = vs.Oscillator.named("one_mass", zeta=0.05, F=0.8, omega=0.9, tau=0, k_stop=20, c_stop=3, R_left=0.7, b=1)


@pytest.mark.parametrize("system, values", [(MIXED, (0.2, 0.6, 0.8)), *slow_cases((BALL, (0.6, 0.8, 3.0)))])
def test_contacts_count_as_impacts(system, values):
    data = vs.sweep(system, {"b": list(values)}, transient=600, record=100, observe=["section", "attractors"])
    for k, b in enumerate(values):
        last = data.isel(b=k)
        orbit = vs.simulate(system.replace(b=b), np.zeros(2 * system.masses), 700)
        late = 600 * system.period
        sides = [*orbit.impacts["side"][orbit.impacts["t"] > late]]
        sides += [*orbit.contacts["side"][orbit.contacts["t_touch"] > late]]
        expected = [sides.count(1) / 100, sides.count(-1) / 100]
        average, period = last.average.values, int(last.period)
        assert average[-3:-1].tolist() == expected and period == 1


@pytest.mark.parametrize(
    "system, values, free, meeting",
    [
        (MIXED, (0.2, 0.6, 6.0), "non-impacting", "impact"),
        *slow_cases((BALL, (0.8, 3.0), "without contact", "contact")),
    ],
)
def test_pictures_say_them(system, values, free, meeting):
    """Of four starts, which all end on one attractor of period 1."""
    seen = set()
    for b in values:
        states = {"x1": [-0.1, 0.1], "v1": [0, 0.05]}
        data = vs.sweep(system.replace(b=b), states, transient=600, record=100, observe=["section", "attractors"])
        right, left = data.average.values[0, 0, -3:-1].astype(int).tolist()
        assert (data.period == 1).all() and (data.average.values[..., -3:-1] == (right, left)).all()
        words = f"period 1, {right} {meeting} right, {left} left" if right + left else f"{free}, period 1"
        (text,) = [text.get_text() for legend in vs.plot(data, kind="basins").legends for text in legend.get_texts()]
        assert text == f"{words} (100 %)"
        seen.add((right, left))
    assert (0, 0) in seen and len(seen) > 1


@pytest.mark.slow
def test_contacts_are_those_of_the_orbit_itself():
    """The orbit that is followed beside it, for what rounding does to its multipliers, may fail or have others."""
    law = dict(k_stop=300, c_stop=4 * 300**0.5, release="force", stops="both", b=0.5, omega=0.8, zeta=0.03)
    system = vs.System(mu_m=3, mu_k=2, f2=0.4, **law)
    axis = {"b": vs.grazing(system).b_right * np.linspace(0.05, 0.95, 24)}
    words = ["section", "attractors", "contacts"]
    data = vs.sweep(system, axis, start={"random": 2}, transient=100, record=100, observe=words)
    periodic, average = data.period.values == 1, data.average.values
    assert np.count_nonzero(periodic) > 40
    for place, counts in ((-3, data.contacts_right), (-2, data.contacts_left)):
        np.testing.assert_array_equal(average[periodic, place], counts.values[periodic] / 100)
