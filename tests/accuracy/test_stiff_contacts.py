"""Contacts between stiffly and softly held masses, and far stops: as exact as rounding the data allows."""

import numpy as np
import pytest
from support import slow_cases
from support.drawn_oscillators import drawn_stiff, drawn_with_a_stiff_spring, positive
from support.searching import searched
from support.stiff_contacts import LARGEST, Flight, errors_of_first, first_zero, judged, study, time_in_units

import vibro_sweep as vs


@pytest.mark.parametrize(
    ("k", "c", "omega", "time"),
    [(1e8, 0, 1.0, 1.12171239257454783), (1e12, 2e6, 2.0, 0.912735041695172359)],
)
def test_between_a_stiffly_and_a_softly_held_mass(k, c, omega, time):
    """Times by 40 digits."""
    system = vs.Oscillator(
        [[1, 0], [0, 2]], [[k, -1], [-1, 3]], [[c, 0], [0, 0.01]], force=[0, 1], contact_normal=[1, -1],
        omega=omega, R=0.8, b=0.1, tau=0.0,
    )  # fmt: skip
    assert abs(vs.simulate(system, [0] * 4, 1).impacts["t"][0] - time) <= 2 * np.spacing(time)


@pytest.mark.parametrize(("k", "damper", "omega", "R"), [(1e12, 0.05, 2.0, 0.5), *slow_cases((1e12, 2.0, 1.0, 0.15))])
def test_thousands_of_series_in_a_cell(k, damper, omega, R):
    """Slow impacts, one soon after another: each flight begins and ends within a cell."""
    system = vs.Oscillator(
        [[1, 0], [0, 2]], [[k, -1], [-1, 3]], [[damper * k**0.5, 0], [0, 0.01]], force=[0, 1], contact_normal=[1, -1],
        omega=omega, R=R, b=0.1, tau=0.0,
    )  # fmt: skip
    assert max(errors_of_first(system, [0] * 4, 6).values()) < 2


@pytest.mark.slow
def test_thousands_of_series_in_a_flight_that_begins_within_a_cell():
    """No closed form helps before the next node."""
    system, state, _ = drawn_stiff(255)
    q, hit = system.linear, vs.simulate(system, state, 4).impacts[2]
    push = np.linalg.solve(q.M, q.contact.normal)
    push *= (1 + (q.contact.R_high if hit["side"] > 0 else q.contact.R_low)) * hit["v1"] / (q.contact.normal @ push)
    after = np.stack([hit["x"], hit["xdot"] - push], -1).ravel()
    found = vs.simulate(system, after, 1, hit["t"]).impacts[0]
    elapsed, side = found["t"] - hit["t"], found["side"]

    def zero(q, x, shift):
        wall = (q.contact.high if side > 0 else q.contact.low) + shift
        return first_zero(Flight(q), list(q.contact.normal), wall, [*x[0::2], *x[1::2]], hit["t"], elapsed)

    assert elapsed < 0.01
    assert time_in_units(system, after, hit["t"], elapsed, zero) < 1.5


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(5))
def test_thousands_of_series_in_a_rest(seed):
    """A mass that swings on while the gap is held says when that ends."""
    rng, k = np.random.default_rng(seed), 1e11
    M, K = np.diag(rng.uniform(0.5, 2, 3)), positive(rng, 3, 0.3) + np.diag([k, 0, 0])
    system = vs.Oscillator(
        M, K, np.diag([2 * np.sqrt(k * M[0, 0]), 0, 0]), contact_normal=[1, -1, 0], force=[0, -4, 1], tau=np.pi / 2,
        omega=rng.uniform(0.5, 1.5), R=0.5, b=0.3,
    )  # fmt: skip
    state = [0, 0, -0.3, 0, 0.1 * rng.normal(), 0.2 * rng.normal()]
    rest = vs.simulate(system, state, 2).sticking[0]
    assert rest["t_on"] == 0

    def zero(q, x, _):
        constrained = Flight(q, constrained=True)
        return first_zero(constrained, constrained.pull, 0, [*x[0::2], *x[1::2]], 0, rest["t_off"])

    assert time_in_units(system, state, 0, rest["t_off"], zero) < 1.5


@pytest.mark.slow
@pytest.mark.parametrize("offset", [3e1, 3e2, -3e3])
def test_far_stops_are_like_near_ones(offset):
    """Shifted with all that holds it, an oscillator strikes when it did, to the rounding of a gap of the size of b."""
    K = np.array([[1, -0.5], [-0.5, 2.0]])
    numbers = dict(
        M=np.diag([1.0, 4.0]), K=K, C=0.0625 * K, contact_normal=[1, 0], force=[1, 0.5], omega=0.63, R=0.8, tau=0.1
    )
    place = np.array([offset, offset / 2])
    near = vs.Oscillator(b=1.0, **numbers, constant=[1e-300, 0])
    far = vs.Oscillator(b=1.0, offset=offset, constant=K @ place, **numbers)
    times = [vs.simulate(one, np.kron(x, [1, 0]), 6).impacts["t"][:10] for one, x in ((near, 0 * place), (far, place))]
    np.testing.assert_allclose(times[1], times[0], rtol=0, atol=1e-13)


def without(hits, i):
    return np.delete(hits, i)


def with_one_more(hits, i, side):
    """Halfway between two impacts."""
    found = np.insert(hits, i, hits[i])
    found["t"][i], found["side"][i] = (hits["t"][i - 1] + hits["t"][i]) / 2, side
    return found


def on_the_other_stop(hits, i):
    found = hits.copy()
    found["side"][i] *= -1
    return found


@pytest.mark.parametrize(
    "wrong",
    [
        lambda hits: without(hits, 2),
        *slow_cases(
            lambda hits: with_one_more(hits, 2, 1), lambda hits: on_the_other_stop(hits, 2),
            lambda hits: without(hits, 0), lambda hits: without(hits, 5), lambda hits: with_one_more(hits, 2, -1),
        ),
    ],
)  # fmt: skip
def test_the_comparison_finds_a_missing_and_an_invented_impact(wrong):
    system, state, _ = drawn_stiff(38)
    all_hits = vs.simulate(system, state, 4).impacts
    hits, end = all_hits[:6], all_hits["t"][5:7].mean()
    assert judged(system, state, hits, 4, end)["compared"] == 6
    assert "defect" in judged(system, state, wrong(hits), 4, end)


@pytest.mark.slow
@pytest.mark.parametrize(("share", "counts"), [(1e-7, False), (1e-5, True), *slow_cases((1e-3, True))])
def test_the_comparison_counts_a_graze_only_where_the_data_decide_it(share, counts):
    """The stiff spring's rounding moves the turning point by 1e-7: the impact there is missed, and invented."""
    k, turning_point = 1e9, 0.85254776635

    def oscillator(b):
        return vs.Oscillator(
            [[1, 0], [0, 1]], [[k, -k], [-k, k + 2]], [[0.05, 0], [0, 0.05]], force=[0, 1], contact_normal=[1, 0],
            omega=0.6, tau=0.0, R=0.8, b=b, stops="right",
        )  # fmt: skip

    struck, passed = (oscillator(turning_point * (1 + sign * share)) for sign in (-1, 1))
    with_graze, without_graze = (vs.simulate(one, [0] * 4, 3).impacts[:1] for one in (struck, passed))
    assert with_graze["t"] < 4 < 20 < without_graze["t"]
    assert ("defect" in judged(struck, [0] * 4, without_graze, 1)) is counts
    assert ("defect" in judged(passed, [0] * 4, with_graze, 1)) is counts
    assert "defect" not in judged(struck, [0] * 4, with_graze, 1)
    assert "defect" not in judged(passed, [0] * 4, without_graze, 1)


# The first have stiff masses that carry most of the force, and far stops; all have three masses with a constant force,
# and so the same kernels.
@pytest.mark.parametrize("seeds", slow_cases([0, 15, 47], [*range(30), 54, 99]), ids=len)
def test_random_oscillators(seeds):
    counted, wrong = searched(study, seeds)
    assert wrong == []
    assert counted["refused"] <= len(seeds) / 10 and counted["impacts"] > 3 * (len(seeds) - counted["refused"])


@pytest.mark.slow
@pytest.mark.parametrize("damping", ["little", "strong"])
@pytest.mark.parametrize("masses", [3, 2, 5])
def test_one_stiff_spring_along_any_direction(masses, damping):
    """The exclusion test bounds fast roots, and nothing that it passes over strikes."""
    impacts = 0
    for seed in range(4):
        system, state = drawn_with_a_stiff_spring(seed, masses, damping)
        impacts += first_six(system, state, seed)
    assert impacts > 8


@pytest.mark.slow
@pytest.mark.parametrize(
    ("K", "C", "known"), [((0.0, 1e8, 1.0), (0.0, 10.0, 0.0), 3), ((1.0, 1e8, 4.0), (2.0, 10.0, 0.1), 2)]
)
def test_where_eigenvectors_coincide(K, C, known):
    """A free mode, and critical damping: in doubles a sum of exponentials loses digits, and the bounds say so."""
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    system = vs.Oscillator(
        np.eye(3), turn @ np.diag(K) @ turn.T, turn @ np.diag(C) @ turn.T, contact_normal=[1, 0, 0], force=[1, 0, 0.5],
        constant=[0, 0, 0.01], omega=0.8, tau=0.1, b=0.02, R=0.8,
    )  # fmt: skip
    assert first_six(system, np.zeros(6), 1) == known  # K itself has lost the digits of later ones


def first_six(system, state, seed) -> int:
    """How many of the first impacts, which are as exact as rounding allows, are compared; none is missed later on."""
    orbit = vs.simulate(system, state, 3)
    q, states = system.linear, orbit.sample(np.linspace(0, 3 * system.period, 5001))
    gaps = states[:, 0::2] @ q.contact.normal
    assert max(gaps.max() - q.contact.high, q.contact.low - gaps.min()) <= 1e-9 * np.abs(states[:, 0::2]).max()
    hits = orbit.impacts[:6]
    assert orbit.status == "ok"
    end = None if len(hits) == 6 else 3 * system.period
    if len(orbit.sticking):
        hits, end = hits[hits["t"] < orbit.sticking["t_on"][0]], None
    result = judged(system, state, hits, seed, end)
    assert "defect" not in result and max(result["errors"].values()) <= LARGEST, result
    return result["compared"]
