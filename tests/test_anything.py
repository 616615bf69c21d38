"""Any admissible oscillator and start: no crash, no hang, no NaN without a status, and never behind a stop.

Work per period is bounded: LONGEST / WIDTH series (kernels/tables.py) and MOST_EVENTS impacts, grazes and rests.
"""

import math

import numpy as np
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

import vibro_sweep as vs
from vibro_sweep.kernels.impacts import MOST_EVENTS
from vibro_sweep.system import ParameterError

EPS = 2.0**-52
PERIODS = 3


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


@settings(max_examples=150, deadline=20_000, suppress_health_check=[HealthCheck.too_slow])
@given(values=parameters, start=starts)
@example(values=QUIET, start=(1.0, 0.0, 1.0, 0.0, False))
@example(values=QUIET | dict(tau=1.0), start=(1.0, 0.0, 1.0, 0.0, False))
@example(values=QUIET | dict(R=1.0, b=1e-6), start=(0.0, 1.0, 0.0, 0.0, True))
def test_anything(values, start):
    system = vs.System(**values)
    state = scaled(start, system.b)
    try:
        orbit = vs.simulate(system, state, periods=PERIODS)
    except ParameterError as error:  # too stiff for the grid, and said so
        assert error.key == "omega"
        return
    assert len(orbit.impacts) <= PERIODS * MOST_EVENTS
    if orbit.status != "ok":
        assert orbit.status.code > 0
        known = np.isfinite(orbit.section).all(1)
        assert (np.diff(known.astype(int)) <= 0).all()  # NaN from the failure on
        return
    assert np.isfinite(orbit.section).all()
    right = system.b if system.stops != "left" else math.inf
    left = -system.b if system.stops != "right" else -math.inf
    slack = 1 + 4 * EPS
    times = np.linspace(0.0, orbit.section_times[-1], 57)
    samples = orbit.sample(times)
    assert np.isfinite(samples).all()
    for x1 in (orbit.section[:, 0], samples[:, 0]):
        assert (x1 <= right * slack).all()
        assert (x1 >= left * slack).all()
    hits = orbit.impacts
    for name in hits.dtype.names:
        assert np.isfinite(hits[name]).all()
    assert (hits["side"] * hits["v1"] > 0).all()
    assert (np.diff(hits["t"]) >= 0).all()
    rests = orbit.sticking
    assert (rests["t_off"] >= rests["t_on"]).all()
    assert (rests["t_on"][1:] >= rests["t_off"][:-1]).all()
    assert rests["t_off"].max(initial=0.0) <= orbit.section_times[-1]


@settings(max_examples=25, deadline=20_000, suppress_health_check=[HealthCheck.too_slow])
@given(values=parameters, start=starts)
def test_any_exponents(values, start):
    system = vs.System(**values)
    try:
        exponents = vs.lyapunov(system, scaled(start, system.b), transient=1, periods=2)
    except ParameterError as error:
        assert error.key == "omega"
        return
    if np.isnan(exponents).any():
        assert vs.simulate(system, scaled(start, system.b), periods=PERIODS).status != "ok"
    else:
        assert (np.diff(exponents[~np.isneginf(exponents)]) <= 0).all()
        assert (exponents < math.inf).all()


def test_what_sampling_takes_off_at_a_stop_is_rounding(monkeypatch):
    """`sample` cuts x1 off at the stops, and so cannot show what it cut: here it does not cut."""
    monkeypatch.setattr(np, "clip", lambda x, *_: x)
    for changes in (dict(b=6.6), dict(b=3.0), dict(b=1.0), dict(b=0.5, R=0.3), dict(b=1e-3, R=1.0)):
        system = vs.System(**(dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.0, omega=0.63, R=0.8) | changes))
        orbit = vs.simulate(system, (0.1 * system.b, 0.2, 0.1, -0.3), 20)
        moments = np.concatenate([orbit.impacts["t"], np.linspace(0.0, orbit.section_times[-1], 2000)])
        states = orbit.sample(moments[moments <= orbit.section_times[-1]])
        assert np.abs(states[:, 0]).max() - system.b < 16 * EPS * np.abs(states).max()
