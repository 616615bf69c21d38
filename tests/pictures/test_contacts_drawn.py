"""Pictures of compliant stops: their force, their place, and where a motion is in contact."""

import numpy as np
import pytest
from support import sample, slow_cases

import vibro_sweep as vs

SOFT = dict(zeta=0.02, F=0.6, omega=0.9, k_stop=20, c_stop=8, b=1, tau=0, stops="right")


def system(**more):
    return vs.Oscillator.named("one_mass", **SOFT | more)


@pytest.fixture(scope="module")
def data():
    return vs.sweep(
        system(release="force"), {"omega": [0.8, 0.9]}, transient=50, record=20, observe=["section", "contacts"],
        trajectory={"periods": 2, "samples": 1601},
    )  # fmt: skip


def loop_of(ax):
    (loop,) = (line for line in ax.lines if len(line.get_xdata()) > 2)
    return loop.get_data()


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_the_force_over_time_is_that_of_the_contacts(release):
    """Its largest value, the largest place, and where it is not zero, which contacts have."""
    orbit = vs.simulate(system(release=release, preload=0.05), (0, 0), 20)
    touched = orbit.contacts
    over_time, loop = orbit.plot(20, kind="contact-force").axes
    assert len(touched) >= 15
    for height in (loop_of(loop)[1], over_time.lines[0].get_ydata()):
        assert np.nanmax(height) == pytest.approx(touched["max_force"].max(), rel=1e-4)
    t, height = over_time.lines[0].get_data()
    inside = [(touch <= t) & (t <= out) for touch, out in zip(touched["t_touch"], touched["t_release"], strict=True)]
    pressed = height != 0  # a stop that is left by its displacement pulls before
    assert np.count_nonzero(pressed) > 1000 and np.count_nonzero(pressed != np.any(inside, axis=0)) <= 2
    last = touched[touched["t_touch"] >= orbit.section_times[-5]]  # of fewer periods a picture has more samples
    x, _ = loop_of(orbit.plot(4, kind="contact-force").axes[1])
    assert np.nanmax(x) - 1 == pytest.approx(last["max_penetration"].max(), rel=1e-5)


def test_a_loop_has_the_force_of_the_data(data):
    fig = vs.plot(data, "contact-force")
    largest = [np.nanmax(line.get_ydata()) for ax in fig.axes[0::2] for line in ax.lines[:1]]
    assert largest == pytest.approx(data.contact_force_max.values, rel=1e-2)  # at the touch
    for ax in fig.axes[1::2]:
        gap, force = ax.lines[0].get_data()
        assert np.min(gap[np.isfinite(force)]) == pytest.approx(1, abs=1e-3)  # where the stop is


@pytest.mark.slow  # as all that has energies with compliant stops
@pytest.mark.parametrize("periodic", [False, True])
def test_a_loop_of_an_orbit_has_the_area_that_the_stop_takes(periodic):
    """The work on the stop by `observe: [energy]`, in a period."""
    ball = system()
    energy = vs.sweep(ball, {"omega": [ball.omega]}, transient=300, record=10, observe=["section", "energy"])
    state = [float(energy[name][0, -1]) for name in ("x1", "v1")]
    orbit = vs.periodic_orbit(ball, state) if periodic else vs.simulate(ball, state, 3)
    fig = vs.plot(orbit, kind="contact-force") if periodic else orbit.plot(1, kind="contact-force")
    x, force = loop_of(fig.axes[1])
    pressed = ~np.isnan(force)
    assert np.nanmax(force) == pytest.approx(orbit.contacts["max_force"].max(), rel=1e-3)
    area = np.trapezoid(force[pressed], x[pressed])
    assert area == pytest.approx(float(energy.impact_power[0]) * ball.period, rel=0.01)


@pytest.mark.slow
def test_orbits_with_rigid_stops_have_no_such_picture():
    orbit = vs.simulate(system(k_stop=None, c_stop=None, R=0.8), (0, 0), 5)
    with pytest.raises(ValueError, match="contact-force"):
        orbit.plot(kind="contact-force")


@pytest.mark.parametrize("kind", ["phase-portrait", "history"])
def test_contacts_are_marked_and_not_cut_off(data, kind):
    fig = vs.plot(data, kind)
    for ax, deepest in zip(fig.axes, data.penetration_max.values, strict=True):
        (line,) = [line for line in ax.lines if line.get_label() == "contact"]
        end = ax.get_xlim()[1] if kind == "phase-portrait" else ax.get_ylim()[1]
        x = line.get_xdata() if kind == "phase-portrait" else line.get_ydata()
        assert end > 1 + deepest and np.nanmax(x) == pytest.approx(1 + deepest, rel=1e-3)


@pytest.mark.parametrize(
    "values, scale",
    sample(2, [([1, 2, 5, 10, 20, 50, 100], "log"), ([1, 10, 20, 30, 100], "linear"), ([1, 2, 5, 10], "linear")]),
)
@pytest.mark.parametrize("kind", ["bifurcation", *slow_cases("contacts")])
def test_values_in_proportion_have_a_logarithmic_axis(kind, values, scale):
    """Over two decades and more."""
    swept = vs.sweep(system(), {"k_stop": values}, transient=5, record=5, observe=["section", "contacts"])
    ax = vs.plot(swept, kind).axes[-1]
    assert ax.get_xscale() == scale
    low, high = ax.get_xlim()
    assert low < values[0] and values[-1] < high < 1.3 * values[-1]


def test_an_orbit_marks_its_contacts():
    fig = vs.simulate(system(), (0, 0), 20).plot(periods=2)
    assert [sum(line.get_label() == "contact" for line in ax.lines) for ax in fig.axes] == [1, 1]
