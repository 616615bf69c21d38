"""Windows of a sweep: each periodic orbit in one, each end what it says it is."""

import numpy as np
import pytest
from support import ROOT
from support.oscillators import PAPER
from support.windows import SYSTEM, check_end, few  # noqa: F401

import vibro_sweep as vs
from vibro_sweep.analysis.windows.job import Job, window_of
from vibro_sweep.driver.windows import rows_in
from vibro_sweep.files.reading import sweep_in
from vibro_sweep.oscillator.window_families import families
from vibro_sweep.tables.outcomes import REASONS


@pytest.fixture(scope="module")
def windows(few):  # noqa: F811
    return vs.windows(few)


def test_each_orbit_has_a_window_or_a_reason(few, windows):  # noqa: F811
    data = vs.open(few)
    names = [REASONS[code].name for code in windows.reason.ravel()]
    assert ((windows.window >= 0) == (windows.reason == 0)).all()
    assert set(names) <= {"in_a_window", "chaos"}
    assert (windows.window.ravel()[data["period"].values > 0] >= 0).all()
    for b, w in zip(data["b"].values, windows.window.ravel(), strict=True):
        if w >= 0:
            assert windows[w].lo <= b <= windows[w].hi
    assert sum(window.points for window in windows) == names.count("in_a_window")


def test_windows_are_counted_once_and_in_order(windows):
    keys = [(window.itinerary, window.period, window.lo) for window in windows]
    assert len(set(keys)) == len(keys)
    assert [window.lo for window in windows] == sorted(window.lo for window in windows)
    thirteen = [window for window in windows if window.lo < 6.6 < window.hi]
    assert [(window.period, window.itinerary, window.points) for window in thirteen] == [(13, "RRRR", 3)]


def test_each_end_is_what_it_says(windows):
    """Newton's method and simulations 1e-9 inside and outside."""
    for window in windows:
        assert window.orbit.stable and window.orbit.itinerary == window.itinerary
        assert window.lower.parameters["b"] == window.lo and window.upper.parameters["b"] == window.hi
        for special, outwards in ((window.lower, -1), (window.upper, 1)):
            assert check_end(window, special, outwards) is None, (window, special)
            assert special.error < 1e-11 or special.type == "boundary"


def test_errors_of_ends_do_not_depend_on_the_last_digits_of_a_start():
    """Rounding moves an end by less than its error; the error itself is the same, from whichever start."""
    system = SYSTEM.replace(b=5.2)
    orbit = vs.periodic_orbit(system, state=vs.simulate(system, (0, 0, 0, 0), 1000).section[-1], periods=29)
    rng, values, errors = np.random.default_rng(5), [], []
    for _ in range(6):
        start = orbit.state * (1 + 1e-9 * rng.standard_normal(4))
        found = window_of(Job(system, start, 29, "b", (4.2, 6.2)))
        values.append(found["special_value"])
        errors.append(found["special_error"])
    assert (np.ptp(values, axis=0) < np.max(errors, axis=0)).all()
    assert (np.ptp(errors, axis=0) < 1e-3 * np.max(errors, axis=0)).all()


def test_a_window_is_that_of_a_stable_orbit_which_the_state_lies_on():
    """The symmetric orbit of the paper is stable below b = 3.89 (evidence.md)."""
    for b, part, reason in ((3.0, 1.0, "in_a_window"), (3.0, 0.99, "not_settled"), (5.0, 1.0, "not_settled")):
        orbit = vs.periodic_orbit(PAPER.replace(b=b), itinerary="LR")
        job = Job(orbit.system, part * orbit.state, 1, "b", (0.98 * b, 1.02 * b))
        assert orbit.stable == (b < 3.89) and REASONS[int(window_of(job).get("reason", 0))].name == reason


def test_free_motion(windows):
    """Its window begins where it touches the stops (Theorem 1)."""
    free = windows[-1]
    assert (free.itinerary, free.period, free.symmetric, free.upper.type) == ("", 1, True, "boundary")
    assert free.lower.type == "graze" and free.lo == pytest.approx(vs.grazing(SYSTEM).b, rel=1e-15)


def test_mirror_images_are_one_window(tmp_path):
    """Starts that end on the one and on the other; the name has more impacts on the right."""
    start = {"random": 6, "seed": 3}
    vs.sweep(SYSTEM, {"b": [6.598, 6.602]}, start=start, transient=1500, record=60, output=tmp_path / "m.h5", workers=1)
    windows = vs.windows(tmp_path / "m.h5")
    right, left = (
        vs.sweep(SYSTEM, {"b": [6.598, 6.602]}, start=start, transient=1500, record=60, observe=["impacts"], workers=1)[
            f"impacts_{side}"
        ].values
        for side in ("right", "left")
    )
    assert (right > left).any() and (left > right).any()
    thirteen = [window for window in windows if window.period == 13]
    assert [window.itinerary for window in thirteen] == ["RRRR"]
    assert thirteen[0].points == np.count_nonzero(right != left)


@pytest.mark.slow
def test_a_plane_row_by_row(tmp_path):
    axes = {"omega": [0.62, 0.63], "b": [6.8, 7.8, 8.8]}
    vs.sweep(SYSTEM, axes, transient=300, record=20, output=tmp_path / "plane.h5", workers=1)
    windows = vs.windows(tmp_path / "plane.h5", "b")
    free = [window for window in windows if window.itinerary == ""]
    assert [window.held for window in free] == [{"omega": 0.62}, {"omega": 0.63}]
    for window in free:
        assert window.lo == pytest.approx(vs.grazing(SYSTEM.replace(**window.held)).b, rel=1e-14)
    assert windows.window.shape == (2, 3, 1)
    along = vs.windows(tmp_path / "plane.h5")
    assert along.parameter == "omega" and along.window.shape == (2, 3, 1)


@pytest.mark.slow
def test_a_rest_after_one_impact_is_no_window_in_the_restitution(tmp_path):
    """At R = 0 the mass rests at once, at any other R after infinitely many impacts: the branch in R is not a
    motion."""
    axes = {"R": [0.0, 0.02, 0.2, 0.4]}
    vs.sweep(SYSTEM.replace(b=1.2), axes, transient=600, record=60, output=tmp_path / "R.h5", workers=1)
    windows = vs.windows(tmp_path / "R.h5")
    assert [REASONS[code].name for code in windows.reason.ravel()] == ["sticking", "sticking", *2 * ["in_a_window"]]
    assert [(window.itinerary, window.orbit.sticking.size) for window in windows] == [("LLRR", 0), ("LR", 0)]
    assert min(window.lo for window in windows) > 0.1


@pytest.mark.parametrize("stops, bounds", [("both", (0.1 / 4, 0.5)), ("right", (0.1 - 0.2, 0.5))])
def test_a_clearance_between_two_stops_stays_above_zero(stops, bounds, tmp_path):
    """Orbits that rest on both stops are stable down to b = 0: they were followed beyond, to a traceback."""
    system = SYSTEM.replace(stops=stops)
    vs.sweep(system, {"b": [0.1, 0.3]}, transient=5, record=5, output=tmp_path / "b.h5", workers=1).close()
    with sweep_in(tmp_path / "b.h5", computes=True) as data:
        (row,) = rows_in(data, None)
    assert row.bounds == pytest.approx(bounds, rel=1e-12)


def test_values_at_the_very_end_of_a_window_are_within_none(tmp_path):
    """Without the outer spring the free motion drifts: there its window ends, and no other orbit is missed."""
    axes = {"mu_k": [0.0, 2.0, 2.1]}
    vs.sweep(SYSTEM.replace(b=5.2), axes, transient=800, record=60, output=tmp_path / "k.h5", workers=1)
    windows = vs.windows(tmp_path / "k.h5")
    (window,) = [one for one in windows if one.lo == 0]
    assert windows.window.ravel().tolist()[1:] == [0, 0] and windows.window[0, 0] == -1
    assert window.other_attractor == 0 and windows.unvisited == []


def test_what_has_no_windows_is_refused(tmp_path):
    vs.sweep(
        SYSTEM, {"b": [6.9, 7.0]}, observe=["impacts"], transient=5, record=5, output=tmp_path / "no.h5", workers=1
    )
    with pytest.raises(ValueError, match="observe: has no 'section'"):
        vs.windows(tmp_path / "no.h5")
    vs.sweep(SYSTEM, {"x1": [0.0, 0.1]}, transient=5, record=5, output=tmp_path / "start.h5", workers=1)
    with pytest.raises(ValueError, match="windows need a number of the system at two values"):
        vs.windows(tmp_path / "start.h5")
    vs.sweep(SYSTEM, {"b": [6.9, 7.0]}, transient=5, record=5, output=tmp_path / "b.h5", workers=1)
    with pytest.raises(ValueError, match="parameter: 'omega' is not allowed; it must be b"):
        vs.windows(tmp_path / "b.h5", "omega")


@pytest.mark.slow
def test_the_quickstart(tmp_path):
    """Every orbit has its window or its reason, every end is what it says, and the families are those of the paper."""
    scene = vs.load_scene(ROOT / "configs" / "quickstart.yaml")
    vs.run(scene, tmp_path / "q.h5")
    windows = vs.windows(tmp_path / "q.h5")
    with vs.open(tmp_path / "q.h5") as data:
        periodic = data["period"].values > 0
    assert (windows.window[:, 0][periodic] >= 0).all()
    assert len(windows) > 110 and np.isin(windows.reason, [0, 1, 2]).all()
    for window in windows:
        for special, outwards in ((window.lower, -1), (window.upper, 1)):
            assert check_end(window, special, outwards) is None, (window, special)
            assert special.error < 1e-12 or special.type == "boundary", (window, special)
    known = {(family.itinerary, family.step): family for family in windows.families}
    one_sided, symmetric = known["RRRR", 1], known["LLLLRRRR", 2]
    assert {11, 12, 13, 14, 15} <= {windows[w].period for w in one_sided.windows}
    assert {23, 25, 27, 29} <= {windows[w].period for w in symmetric.windows}


@pytest.mark.slow
@pytest.mark.parametrize("name", ["one_mass", "ball_in_cavity", "chain"])
def test_other_oscillators(name, tmp_path):
    """A part of the scenes that come with the package."""
    scene = vs.load_scene(ROOT / "configs" / "models" / f"{name}.yaml")
    ((key, values),) = scene.sweep.items()
    scene = scene.replace(sweep={key: values[::7].tolist()}, observe=["section"], picture=None)
    vs.run(scene, tmp_path / "m.h5")
    windows = vs.windows(tmp_path / "m.h5")
    assert len(windows) >= 4
    for window in windows:
        for special, outwards in ((window.lower, -1), (window.upper, 1)):
            assert check_end(window, special, outwards) is None, (window, special)


def test_families():
    """By the itinerary, one step of the period and one direction."""
    words = ["RR", "RR", "RL", "RR", "RR", "RR", "", "", "", "RL", "RL"]
    periods = [3, 4, 2, 5, 9, 5, 1, 2, 3, 5, 8]
    lo = [3.0, 4.0, 1.0, 5.0, 6.0, 5.5, 1.0, 2.0, 3.0, 0.5, 0.2]
    found = families(words, [False] * len(words), periods, lo)
    assert [(one.itinerary, one.windows, one.period, one.step) for one in found] == [
        ("RL", (2, 9, 10), 2, 3),
        ("RR", (0, 1, 3), 3, 1),
    ]
