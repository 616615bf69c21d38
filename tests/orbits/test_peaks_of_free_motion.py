"""Branches without impacts: no resonance peak at which the motion passes a stop is stepped over."""

import pytest


def gap_amplitude(numbers, name, value):
    """Of x1 without impacts, from eq. (3)."""
    p = numbers | {name: value}
    K = np.array([[1, -1], [-1, 1 + p["mu_k"]]])
    Z = K - p["omega"] ** 2 * np.diag([1, p["mu_m"]]) + 2j * p["zeta"] * p["omega"] * K
    return abs(np.linalg.solve(Z, [1 - p["f2"], p["f2"]])[0])


def stretch(numbers, name, start, bounds, b):
    """The values around `start` up to which the amplitude stays below b, by many samples."""
    ends = []
    for bound in bounds:
        values = start + (bound - start) * np.linspace(0, 1, 4001)
        size = np.array([gap_amplitude(numbers, name, value) for value in values]) - b
        k = int(np.argmax(size > 0))
        if size[k] > 0:
            ends.append(
                brentq(lambda value: gap_amplitude(numbers, name, value) - b, *values[k - 1 : k + 1], xtol=1e-15)
            )
        else:
            ends.append(bound)
    return ends


@pytest.mark.parametrize("count", [*slow_cases(4, 40), pytest.param(400, marks=pytest.mark.soak)])
def test_no_peak_of_the_free_motion_is_passed(count, capsys):
    """Random oscillators with two narrow resonances, along omega and the ratios: both ends of the branch without
    impacts, against samples that lie far closer than the peaks are wide."""
    rng, tried, peaks, wrong = np.random.default_rng(12), 0, 0, []
    while tried < count:
        numbers = {
            "mu_m": 10 ** rng.uniform(-0.3, 1), "mu_k": 10 ** rng.uniform(-0.3, 1), "zeta": 10 ** rng.uniform(-2.7, -1),
            "f2": rng.uniform(0, 1), "omega": rng.uniform(0.3, 2.0),
        }  # fmt: skip
        name = str(rng.choice(["omega", "mu_k", "mu_m"]))
        start, bounds = numbers[name], (0.4 * numbers[name], 2.5 * numbers[name])
        b = gap_amplitude(numbers, name, start) * 10 ** rng.uniform(0.02, 1.2)
        expected = stretch(numbers, name, start, bounds, b)
        system = vs.System(**numbers, R=0.8, b=b)
        branch = vs.continue_orbit(vs.periodic_orbit(system, itinerary=""), name, bounds)
        found = [branch.begins.parameters[name], branch.ends.parameters[name]]
        tried, peaks = tried + 1, peaks + sum(end not in bounds for end in expected)
        if not np.allclose(found, expected, rtol=1e-9, atol=0):
            wrong.append((numbers, name, b, found, expected))
    with capsys.disabled():
        if count > 100:
            print(f"\n{tried} branches of free motion, {peaks} of {2 * tried} ends at grazes, {len(wrong)} wrong")
    assert not wrong
    assert peaks > 0.3 * count


@pytest.mark.parametrize("F", [0.0, 5e-324, 1e-200])
def test_a_mass_at_rest_has_its_distance_from_the_stop(F):
    """No derivative of its gap says where it would turn."""
    system = vs.Oscillator.named(
        "one_mass", k=1, zeta=0.02, F=F, omega=0.5, R=0.8, b=2, stops="right", constant=0.5, tau=0.0
    )
    orbit = vs.periodic_orbit(system, itinerary="")
    assert orbit.ok and orbit.stop_distance == pytest.approx(1.5, rel=1e-14)
