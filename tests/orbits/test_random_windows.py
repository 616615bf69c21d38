"""Windows of random sweeps: the same ends with half and twice as many values and from other starts; each held against
monodromy matrices that do not come from the engine."""

import numpy as np
import pytest
from support import slow_cases, window_search
from support.searching import new_report, searched
from support.windows import SYSTEM, few  # noqa: F401

import vibro_sweep as vs
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of
from vibro_sweep.analysis.windows import members
from vibro_sweep.analysis.windows.job import Job, window_of
from vibro_sweep.analysis.windows.rows import REASON_CODES
from vibro_sweep.analysis.windows.window_search import WindowSearch
from vibro_sweep.driver.windows import rows_in
from vibro_sweep.files.reading import sweep_in
from vibro_sweep.tables.outcomes import REASONS

# an impact damper, of which an asymmetric orbit is born at the upper end of a window, where a symmetric one loses its
# symmetry; and one whose window ends at the symmetric orbit's own pitchfork
DAMPER = dict(mass_ratio=0.2747929395913874, zeta=0.11595848024966961, F=0.9895081779106233, omega=0.6493760554424832)


@pytest.mark.parametrize(
    "study, seeds",
    slow_cases((window_search.study, range(3)), (window_search.study_of_compliant, [4, 1001])),
    ids=["rigid stops", "compliant stops"],
)
def test_the_same_windows_of_all_sweeps(study, seeds):
    counted, wrong = searched(study, seeds)
    assert wrong == [] and counted["windows"] > 5 * len(seeds)


@pytest.mark.slow
def test_two_orbits_with_one_itinerary_and_the_same_bounds_have_two_windows(tmp_path):
    """Seed 102: one was taken for the other, and its orbits for some that have not settled."""
    rng = np.random.default_rng([102, 1])
    _, system = window_search.drawn(102, True, rng)
    _, windows, bounds = window_search.swept(system, "constant3", [-0.2, -0.1, 0.0, 0.1, 0.2], 0, tmp_path)
    assert [(one.itinerary, one.period, (one.lo, one.hi)) for one in windows] == 2 * [("LR", 1, bounds)]
    assert [one.points for one in windows] == [windows.window.size - windows[1].points, windows[1].points]
    assert np.abs(windows[0].orbit.state - windows[1].orbit.state).max() > 0.1


@pytest.mark.slow
def test_a_window_from_its_ends(few):  # noqa: F811
    """Also beside a fold or pitchfork: the run began on their other side, and the window was an unstable stretch."""
    windows = vs.windows(few)
    chosen = [window for window in windows if {window.lower.type, window.upper.type} & {"fold", "pitchfork"}]
    assert {end.type for window in chosen for end in (window.lower, window.upper)} == {"graze", "fold", "pitchfork"}
    with sweep_in(few, computes=True) as data:
        (row,) = rows_in(data, "b")
    report, found = new_report(), []
    for window in chosen[:1] + chosen[-2:]:
        window_search.other_starts(report, lambda *line: found.append(line), window, row.bounds)
    assert report.counted["starts"] > 20 and not found


@pytest.mark.parametrize(
    ("b", "state"),
    [
        (0.18060386953185800, [0.4933727630742184, -0.030895433382960653, 0.646373977898661, -0.13250451231487853]),
        (0.18060386953224267, [0.4933727531365303, -0.030895426053686132, 0.6463739899453994, -0.13250456487256382]),
        (0.18060386953228300, [0.49337274963698363, -0.030895423472705796, 0.6463739941875544, -0.13250458338065946]),
    ],
)
def test_a_window_from_an_orbit_at_its_fold(b, state):
    """3e-11 to 2e-13 of its width inside: the run began on the unstable side, and came to 0.1622 .. 0.1806."""
    ball = dict(mass_ratio=0.11034866750723367, zeta=0.030816339144821438, F=0.28850344990689725, b=b)
    ball |= dict(omega=0.6214661466051168, tau=1.838287462997773, R=0.4039709200133826)
    arrays = window_of(Job(vs.Oscillator.named("ball_in_cavity", **ball), np.array(state), 1, "b", (4e-4, 0.98)))
    assert np.abs(arrays["special_value"][[0, -1]] - [0.16708787864496785, 0.18060386953228552]).max() < 1e-12


@pytest.mark.slow
@pytest.mark.parametrize("b", [0.15244759891086823, 0.15123255104480465])
def test_a_window_ends_at_the_first_of_three_tori(b):
    """At 0.15394793 a pair of multipliers goes out, at 0.15396 another, which comes back at 0.15409613: one step led
    over all three, and found the last."""
    numbers = dict(omega=1.4299833438838407, R=0.44791766671059696, tau=2.593975858978541, stop_at=4, b=b)
    numbers |= dict(m=[2.9343685101211254, 0.6270922614406012, 1.1900481292553218, 0.5945551770764302])
    k = [1.6164380940280878, 1.8547392570285108, 0.8883951340511398, 1.2350500811632625, 0.3417609777096854]
    c = [0.010325976048293843, 0.010697324916218665, 0.06360229934193973, 0.041250509188522515, 0.09923165777468539]
    force = [1.7964731625956565, 0.9137049379724049, -0.1459938597395403, 0.7360407425471607]
    chain = vs.Oscillator.named("chain", **numbers, k=k, c=c, force=force)
    orbit = vs.periodic_orbit(chain, itinerary="LLLLRRRR", periods=1)
    assert orbit.ok and orbit.stable and orbit.symmetric
    job = Job(chain, orbit.state, 1, "b", (0.04355645683167664, 0.479121025148443))
    ends = window_of(job)["special_value"][[0, -1]]
    assert np.abs(ends - [0.1483689674509671, 0.1539479263887112]).max() < 1e-12


def test_an_orbit_without_a_window_of_its_own_is_in_the_one_that_covers_it(few):  # noqa: F811
    """The job of the first point of period 13 says `not_settled`; the window comes from its neighbours."""
    with sweep_in(few, computes=True) as data:
        search = WindowSearch(rows_in(data, "b"))
    refused = []

    def evaluate(names, jobs):
        results = []
        for name, job in zip(names, jobs, strict=True):
            refuses = job.period == 13 and not refused
            refused.extend([tuple(map(int, name.split(":")))] * refuses)
            results.append({"reason": REASON_CODES["not_settled"]} if refuses else window_of(job))
        return results

    search.search(evaluate)
    ((row, i, j),) = refused
    assert search.rows[row].period[i, j] == 13 and search.window[row][i, j] >= 0
    assert REASONS[search.reason[row][i, j]].name == "in_a_window"


@pytest.mark.slow
def test_orbits_of_a_window_beside_its_birth_are_its_own(tmp_path):
    """On a chord between two points of the branch Newton's method found the symmetric parent, which is unstable."""
    damper = vs.Oscillator.named("ball_in_cavity", **DAMPER, R=0.9277676484139388, b=1.3055893820201745)
    values = {"R": [0.88, 0.886, 0.89, 0.8906, 0.892, 0.896, 0.9, 0.905]}
    vs.sweep(
        damper, values, start={"random": 4, "seed": 1}, transient=1500, output=tmp_path / "R.h5", workers=1
    ).close()
    windows = vs.windows(tmp_path / "R.h5")
    births = [
        (window, k)
        for window in windows
        for k, end in enumerate((window.lower, window.upper))
        if not window.symmetric and end.type == "pitchfork"
    ]
    assert births
    for window, k in births:
        for share in (1e-3, 1e-4, 1e-6):
            value = (window.hi, window.lo)[1 - k] + (window.lo - window.hi) * share * (1 if k else -1)
            system = damper.replace(R=value)
            orbit = orbit_of(system, members.solution_in(window._arrays, value, system))
            _, guess, _ = members.guess_at(window._arrays, value)
            half = len(guess) // 2
            apart, guessed = (np.abs(v[half:] + v[:half]).max() for v in (orbit.impacts["v1"], guess))
            assert orbit.stable and apart > 1e-6 and 0.5 < guessed / apart < 2, share


def test_an_own_pitchfork_of_an_orbit_with_a_free_mode_is_the_orbit(tmp_path):
    """Its whole period was corrected by Newton's method where that is singular, and was not a symmetric orbit any
    more."""
    damper = vs.Oscillator.named("ball_in_cavity", **DAMPER, R=0.9277676484139388, b=1.3055893820201745)
    values, start = {"R": np.linspace(0.6494373538897571, 1.0, 17)[10:13]}, {"random": 2, "seed": 1}
    vs.sweep(damper, values, start=start, transient=600, record=100, output=tmp_path / "R.h5", workers=1).close()
    ends = [end for window in vs.windows(tmp_path / "R.h5") if window.symmetric for end in (window.lower, window.upper)]
    pitchforks = [end for end in ends if end.type == "pitchfork"]
    assert pitchforks
    for end in pitchforks:
        assert end.orbit.symmetric and np.abs(end.orbit.half_multipliers + 1).min() < 1e-9
        whole, half = end.orbit._solution.whole(), end.orbit._solution
        assert np.array_equal(whole.times[: half.K], half.times) and np.array_equal(whole.jumps[: half.K], half.jumps)
        assert np.abs(whole.states[:, 0] - whole.family.linear.contact.stop(whole.sides)).max() < 1e-12
