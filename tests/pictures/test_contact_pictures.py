"""Pictures of compliant stops: their force, their place, and where a motion is in contact."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
from support import sample, slow_cases

import vibro_sweep as vs
from vibro_sweep.model.stop_force import force_of
from vibro_sweep.plotting import figure, kinds
from vibro_sweep.plotting.drawn_curves import Drawn, plot_curves

SOFT = dict(zeta=0.02, F=0.6, omega=0.9, k_stop=20, c_stop=8, b=1, tau=0, stops="right")


def system(**more):
    return vs.Oscillator.named("one_mass", **SOFT | more)


@pytest.fixture(scope="module")
def data():
    return vs.sweep(
        system(release="force"), {"omega": [0.8, 0.9]}, transient=50, record=20, observe=["section", "contacts"],
        trajectory={"periods": 2, "samples": 1601},
    )  # fmt: skip


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_the_force_is_that_of_the_contacts(release):
    """Of dense samples: its largest value, the largest place, and where it is not zero, which contacts have."""
    one = system(release=release, preload=0.05)
    orbit, T = vs.simulate(one, (0, 0), 20), one.period
    t = np.linspace(0, 20 * T, 200_001)
    x, v = orbit.sample(t).T
    force, places = force_of(t, x - 1, v, (20, 8, 0.05), release == "force")
    touched = orbit.contacts
    assert len(touched) >= 15
    assert force.max() == pytest.approx(touched["max_force"].max(), rel=1e-2)
    assert places.max() == pytest.approx(touched["max_penetration"].max(), rel=1e-5)
    inside = sum((touched["t_release"] - touched["t_touch"])[~np.isnan(touched["t_release"])])
    assert np.count_nonzero(force) * t[1] == pytest.approx(inside, rel=0.02)


def test_kinds(data):
    assert {"contacts", "contact-force", "film", "history", "phase-portrait"} <= set(kinds(data))
    paper = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    rigid = vs.sweep(paper, {"omega": [0.6]}, transient=5, record=5, trajectory={"periods": 1, "samples": 101})
    assert not {"contacts", "contact-force"} & set(kinds(rigid))
    with pytest.raises(vs.PlotError, match="contact-force"):
        figure(rigid, "contact-force")


def test_a_loop_has_the_force_of_the_file(data):
    fig = figure(data, "contact-force")
    largest = [np.nanmax(line.get_ydata()) for ax in fig.axes[0::2] for line in ax.lines[:1]]
    assert largest == pytest.approx(data.contact_force_max.values, rel=1e-2)  # at the touch
    for ax in fig.axes[1::2]:
        gap, force = ax.lines[0].get_data()
        assert np.min(gap[np.isfinite(force)]) == pytest.approx(1, abs=1e-3)  # where the stop is


@pytest.mark.slow  # as all that has energies with compliant stops
@pytest.mark.parametrize("periodic", [False, True])
def test_a_loop_of_an_orbit_has_the_area_that_the_stop_takes(periodic):
    """The work on the stop by `observe: [energy]`, in a period."""
    one, T = system(), system().period
    energy = vs.sweep(one, {"omega": [one.omega]}, transient=300, record=10, observe=["section", "energy"])
    state = [float(energy[name][0, -1]) for name in ("x1", "v1")]
    orbit = vs.periodic_orbit(one, state) if periodic else vs.simulate(one, state, 3)
    fig = vs.plot(orbit, kind="contact-force") if periodic else orbit.plot(1, kind="contact-force")
    (loop,) = (line for line in fig.axes[1].lines if len(line.get_xdata()) > 2)
    x, force = loop.get_xdata(), loop.get_ydata()
    pressed = ~np.isnan(force)
    assert np.nanmax(force) == pytest.approx(orbit.contacts["max_force"].max(), rel=1e-3)
    area = np.trapezoid(force[pressed], x[pressed])
    assert area == pytest.approx(float(energy.impact_power[0]) * T, rel=0.01)


@pytest.mark.slow
def test_orbits_with_rigid_stops_have_no_such_picture():
    orbit = vs.simulate(system(k_stop=None, c_stop=None, R=0.8), (0, 0), 5)
    with pytest.raises(ValueError, match="contact-force"):
        orbit.plot(kind="contact-force")


@pytest.mark.parametrize("kind", ["phase-portrait", "history"])
def test_contacts_are_marked_and_not_cut_off(data, kind):
    fig = figure(data, kind)
    for ax, deepest in zip(fig.axes, data.penetration_max.values, strict=True):
        (line,) = [line for line in ax.lines if line.get_label() == "contact"]
        end = ax.get_xlim()[1] if kind == "phase-portrait" else ax.get_ylim()[1]
        x = line.get_xdata() if kind == "phase-portrait" else line.get_ydata()
        assert end > 1 + deepest and np.nanmax(x) == pytest.approx(1 + deepest, rel=1e-3)


def test_a_film_shows_the_stop_pressed_in(data):
    film = figure(data, "film")
    ((line, place),) = film.stops
    assert place.max() - place.min() == pytest.approx(data.penetration_max.values[0], rel=1e-3)
    film.show(0)
    before = line.get_xdata()[0]
    film.show(int(np.argmax(place) / (len(place) - 1) * 199))
    assert line.get_xdata()[0] > before


def test_an_orbit_marks_its_contacts():
    fig = vs.simulate(system(), (0, 0), 20).plot(periods=2)
    assert [sum(line.get_label() == "contact" for line in ax.lines) for ax in fig.axes] == [1, 1]


@pytest.mark.parametrize(
    "values, scale",
    sample(2, [([1, 2, 5, 10, 20, 50, 100], "log"), ([1, 10, 20, 30, 100], "linear"), ([1, 2, 5, 10], "linear")]),
)
@pytest.mark.parametrize("kind", ["bifurcation", *slow_cases("contacts")])
def test_values_in_proportion_have_a_logarithmic_axis(kind, values, scale):
    """Over two decades and more."""
    swept = vs.sweep(system(), {"k_stop": values}, transient=5, record=5, observe=["section", "contacts"])
    ax = figure(swept, kind).axes[-1]
    assert ax.get_xscale() == scale
    low, high = ax.get_xlim()
    assert low < values[0] and values[-1] < high < 1.3 * values[-1]


def curve_of(p, q):
    return Drawn("fold", np.asarray(p), np.asarray(q), np.zeros(len(p), bool), [])


@pytest.mark.parametrize(
    "names, scales",
    [
        (("b", "k_stop"), ("linear", "log")),
        (("c_stop_left", "b"), ("log", "linear")),
        (("b", "omega"), ("linear", "linear")),
    ],
)
def test_the_stiffness_of_a_stop_has_a_logarithmic_axis_over_decades(names, scales):
    (ax,) = plot_curves([curve_of([0.01, 2], [3.0, 1e4]), curve_of([1, 3], [20, 5e3])], names).axes
    assert (ax.get_xscale(), ax.get_yscale()) == scales


def test_a_damper_from_zero_on_has_an_even_axis():
    (ax,) = plot_curves([curve_of([0, 2000.0], [1, 2])], ("c_stop", "b")).axes
    assert ax.get_xscale() == "linear"


def test_cells_of_a_plane_are_of_like_size_along_values_in_proportion():
    values = [1, 10, 100, 1000]
    plane = vs.sweep(system(), {"k_stop": values, "preload": [0, 0.1]}, transient=5, record=5)
    ax = figure(plane).axes[0]
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "linear")
    assert ax.get_xlim() == pytest.approx((10**-0.5, 10**3.5))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["contacts", "energy"])
def test_both_ways_have_names(kind):
    start = {"follow": "both"}
    swept = vs.sweep(
        system(), {"omega": [0.8, 0.9]}, transient=20, record=40, observe=["section", "contacts", "energy"], start=start
    )
    labels = [text.get_text() for text in figure(swept, kind).axes[0].get_legend().get_texts()]
    assert len(labels) == 2 and "up" in labels[0] and "down" in labels[1]
