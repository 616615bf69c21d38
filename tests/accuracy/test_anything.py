"""Any admissible oscillator and start: no crash, no hang, no NaN without a status, and never behind a stop.

Work per period is bounded: an orbit that needs more than MOST_EVENTS gets a status.
"""

import math
from collections import Counter

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from support import slow_cases

import vibro_sweep as vs

EPS = 2.0**-52
PERIODS = 3
MOST_EVENTS = 100_000  # impacts, grazes and rests in a period
SLOWEST = 1e-150  # impact, whose saltation matrix has 1/v1, and squares of that


def numbers(low, high):
    """Floats of any size between 10^low and 10^high."""
    return st.floats(low, high).map(lambda exponent: 10.0**exponent)


parameters = st.fixed_dictionaries(
    dict(
        mu_m=numbers(-6, 6),
        mu_k=numbers(-6, 6),
        zeta=st.one_of(st.sampled_from([0.0, 1e-300, 1.0]), numbers(-12, 2)),
        f2=st.one_of(st.sampled_from([0.0, 1.0]), st.floats(0, 1)),
        omega=numbers(-3, 3),
        R=st.one_of(st.sampled_from([0.0, 1.0, 1e-6, 1 - 1e-9]), st.floats(0, 1)),
        b=numbers(-9, 9),
        tau=st.one_of(st.sampled_from([0.0, math.pi / 2, math.pi]), st.floats(-10, 10)),
        stops=st.sampled_from(["both", "right", "left"]),
    )
)
# x1 in units of b: on a stop, at the middle or anywhere; the others in units of b or of the force
places = st.one_of(st.sampled_from([-1.0, 0.0, 1.0, math.nextafter(1.0, 0.0)]), st.floats(-1, 1))
sizes = st.one_of(st.sampled_from([0.0, 1.0, -1.0]), st.floats(-100, 100))
starts = st.tuples(places, sizes, sizes, sizes, st.booleans())


def scaled(start, b):
    x1, v1, x2, v2, by_force = start
    unit = 1.0 if by_force else b
    return x1 * b, v1 * unit, x2 * unit, v2 * unit


# no force on M1 and the spring at its length: the acceleration on the stop is exactly zero
QUIET = dict(mu_m=1.0, mu_k=1.0, zeta=0.0, f2=1.0, omega=1.0, R=0.8, b=0.5, tau=0.0, stops="both")


def require(outcomes, **shares):
    """At least such shares of the examples came to these outcomes: a test that refuses them all shows nothing."""
    for outcome, share in shares.items():
        assert outcomes[outcome] >= share * outcomes["examples"] > 0, (outcome, dict(outcomes))


def searching(count):
    """The same few examples each time, and others each time where there are many of them."""
    few = count <= 50
    return settings(
        max_examples=count, derandomize=few, deadline=None, suppress_health_check=[HealthCheck.too_slow], database=None
    )


@pytest.mark.parametrize("count", [25, *slow_cases(150)])
def test_anything(count):
    """Of 400 examples 93 % were well, 58 % with impacts and 30 % with rests; 5 % are too stiff."""
    outcomes = Counter()

    @searching(count)
    @given(values=parameters, start=starts)
    @example(values=QUIET, start=(1.0, 0.0, 1.0, 0.0, False))
    @example(values=QUIET | dict(tau=1.0), start=(1.0, 0.0, 1.0, 0.0, False))
    @example(values=QUIET | dict(R=1.0, b=1e-6), start=(0.0, 1.0, 0.0, 0.0, True))
    def check(values, start):
        outcomes["examples"] += 1
        system = vs.System(**values)
        state = scaled(start, system.b)
        try:
            orbit = vs.simulate(system, state, periods=PERIODS)
        except vs.ParameterError as error:  # too stiff for the grid, and said so
            assert error.key == "omega"
            return
        assert len(orbit.impacts) <= PERIODS * MOST_EVENTS
        outcomes[str(orbit.status)] += 1
        if orbit.status != "ok":
            assert orbit.status.code > 0
            known = np.isfinite(orbit.section).all(1)
            assert (np.diff(known.astype(int)) <= 0).all()  # NaN from the failure on
            return
        assert np.isfinite(orbit.section).all()
        right = system.b if system.stops != "left" else math.inf
        left = -system.b if system.stops != "right" else -math.inf
        times = np.linspace(0.0, orbit.section_times[-1], 57)
        samples = orbit.sample(times)
        assert np.isfinite(samples).all()
        size = np.abs(samples).max()  # x1 is a sum of terms as large as the state
        for x1, rounding in ((orbit.section[:, 0], 4 * EPS * system.b), (samples[:, 0], 64 * EPS * (size + system.b))):
            assert (x1 <= right + rounding).all()
            assert (x1 >= left - rounding).all()
        hits, rests = orbit.impacts, orbit.sticking
        outcomes["struck"] += len(hits) > 0
        outcomes["rested"] += len(rests) > 0
        for name in hits.dtype.names:
            assert np.isfinite(hits[name]).all()
        assert (hits["side"] * hits["v1"] > 0).all()
        assert (np.diff(hits["t"]) >= 0).all()
        assert (rests["t_off"] >= rests["t_on"]).all()
        assert (rests["t_on"][1:] >= rests["t_off"][:-1]).all()
        assert rests["t_off"].max(initial=0.0) <= orbit.section_times[-1]

    check()
    require(outcomes, ok=0.75, struck=0.35, rested=0.1)


@pytest.mark.parametrize("count", [25, *slow_cases(100)])
def test_any_exponents(count):
    """Of 100 examples 95 % had them."""
    outcomes = Counter()

    @searching(count)
    @given(values=parameters, start=starts)
    @example(values=QUIET | dict(f2=0.0, R=1.0, b=1.0), start=(-1.0, -(2.0**-1022), 0.0, 0.0, False))
    @example(values=QUIET | dict(zeta=10.0, f2=0.0, omega=0.01, b=10.0), start=(-1.0, 0.0, 0.0, 0.0, False))
    def check(values, start):
        outcomes["examples"] += 1
        system = vs.System(**values)
        try:
            exponents = vs.lyapunov(system, scaled(start, system.b), transient=1, record=2)
        except vs.ParameterError as error:
            assert error.key == "omega"
            return
        if np.isnan(exponents).any():
            orbit = vs.simulate(system, scaled(start, system.b), periods=PERIODS)
            assert orbit.status != "ok" or np.abs(orbit.impacts["v1"]).min(initial=math.inf) < SLOWEST
        else:
            outcomes["known"] += 1
            assert (np.diff(exponents[~np.isneginf(exponents)]) <= 0).all()
            assert (exponents < math.inf).all()

    check()
    require(outcomes, known=0.75)


def test_samples_pass_a_stop_by_rounding_alone():
    for changes in (dict(b=6.6), dict(b=3.0), dict(b=1.0), dict(b=0.5, R=0.3), dict(b=1e-3, R=1.0)):
        system = vs.System(**(dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.0, omega=0.63, R=0.8) | changes))
        orbit = vs.simulate(system, (0.1 * system.b, 0.2, 0.1, -0.3), 20)
        moments = np.concatenate([orbit.impacts["t"], np.linspace(0.0, orbit.section_times[-1], 2000)])
        states = orbit.sample(moments[moments <= orbit.section_times[-1]])
        assert np.abs(states[:, 0]).max() - system.b < 16 * EPS * np.abs(states).max()
