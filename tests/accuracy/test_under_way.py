"""Orbits that are still under way say so, how far it is and how long it takes; in any unit of time, length and mass."""

import numpy as np
import pytest
from support import sample, slow_cases
from support.arrivals import study

import vibro_sweep as vs

NOT_SETTLED = 6


def resonator(Q, b=1.1, **numbers):
    """In resonance: the free motion has x1 = -1 at the section, and comes nearer by exp(-pi/Q) in a period."""
    return vs.Oscillator.named(
        "one_mass", k=1.0, zeta=0.5 / Q, F=1 / Q, omega=1.0, b=b, stops="right", tau=0.0, **(numbers or {"R": 0.5})
    )


@pytest.mark.parametrize("observe", [["section"], ["section", "lyapunov"]], ids=["section", "exponents"])
@pytest.mark.parametrize("Q", [400, 2000, 1e4, 1e5])
def test_a_resonator_is_under_way(Q, observe):
    data = vs.sweep(resonator(Q), {"b": [1.1]}, transient=300, record=60, observe=observe)
    assert (data.status.item(), data.period.item(), data.approached_period.item()) == (NOT_SETTLED, 0, 1)
    assert abs(data.approached_factor.item() - np.exp(-np.pi / Q)) < 1e-9
    x, v = data.x1.values[0], data.v1.values[0]
    left = max(abs(x[-1] + 1) / max(abs(x)), abs(v[-1]) / max(abs(v).max(), 1e-3 * abs(x).max()))
    assert abs(data.approached_distance.item() / left - 1) < 1e-3


def test_as_many_periods_more_as_are_said():
    """From what is left by exp(-pi/Q) in a period, as long as the motion needs: its next periods are simulated."""
    system = resonator(400)
    data = vs.sweep(system, {"b": [1.1]}, transient=300, record=60, observe=["section"])
    needed = np.log(data.approached_distance.item() / 3e-6) / np.log(1 / data.approached_factor.item())
    states = [data[name].values[0, -1] for name in ("x1", "v1")]
    later = vs.simulate(system, states, 2 * int(needed)).section
    left = np.abs(later - later[-1]).max(axis=1) / np.abs(data.x1.values).max()
    arrived = int(np.argmax(left <= 3e-6))
    assert 0.9 < needed / arrived < 1.1


@pytest.mark.parametrize("rate", [1e-2, 5e-3, 1e-3, 1e-4, 1e-5])
@pytest.mark.parametrize("unit", [1e-12, 1e-6, 1.0, 1e9])
def test_creep_is_under_way_in_any_unit_of_time(unit, rate):
    """x'' + x' + (rate/2 pi) x = sin t, which never comes near its stop: the periodic motion has x1 = -1/2."""
    system = vs.Oscillator.named(
        "chain", m=[1.0], k=[rate / (2 * np.pi) / unit**2, 0.0], c=[1 / unit, 0.0], force=[unit**-2], omega=1 / unit,
        b=100.0, R=0.5, stops="right", tau=0.0,
    )  # fmt: skip
    start = {"x1": 3.0, "v1": 0.0}
    data = vs.sweep(system, {"b": [100.0]}, transient=400, record=60, start=start, observe=["section"])
    assert (data.status.item(), data.period.item(), data.approached_period.item()) == (NOT_SETTLED, 0, 1)
    assert abs((1 - data.approached_factor.item()) / rate - 1) < 0.02  # of e^{-rate}, and to first order in it


@pytest.mark.parametrize("transient", [800, 1500, 2400, 8000])
def test_slow_spirals_are_no_tori(transient):
    """A cantilever that taps an elastic sample, in resonance: both multipliers turn and shrink by exp(-pi/Q)."""
    system = resonator(400, k_stop=4.0)
    b = np.linspace(0.15, 0.95, 41)
    data = vs.sweep(system, {"b": b}, transient=transient, record=60, observe=["section", "lyapunov"])
    assert not np.any((data.status == 0) & (data.period == 0))
    assert np.isin(data.period, (0, 1)).all() and (transient < 8000 or np.all(data.period == 1))


def test_at_rest_in_one_number_is_arrived():
    """With v = 0 at the section its rounding is compared with the size of x."""
    m, k, omega = 1.1257909293593089e-11, 40.0, 1884955.5921538759  # 300 kHz, Q = 400; the stop is not reached
    numbers = dict(m=[m], k=[k, 0.0], c=[m * omega / 400, 0.0], force=[2e-9], omega=omega, k_stop=160.0, b=22e-9)
    for tau in (0.0, 1.0):
        system = vs.Oscillator.named("chain", **numbers, stops="right", tau=tau)
        data = vs.sweep(system, {"b": [22e-9]}, transient=9000, record=60, observe=["section"])
        assert (data.status.item(), data.period.item()) == (0, 1)


@pytest.mark.parametrize("seed", sample(4, range(40)))
def test_judged_by_going_on(seed):
    """No orbit that is ok with a period is far from it when it has gone on 30 times longer."""
    counted, wrong = study(seed)
    assert wrong == [] and counted["and_said_so"] == counted["had_arrived"]


def drawn(rng, time=1.0, length=1.0, mass=1.0):
    """An oscillator of one or two masses, rigid or compliant, in units of so many of its own."""
    kind, Q, omega = rng.choice(["one", "two", "isolator", "free"]), 10 ** rng.uniform(0.7, 2.5), rng.uniform(0.3, 3)
    if kind == "one":
        M, K, force, normal = np.eye(1), np.eye(1), [rng.uniform(0.1, 1)], [1.0]
        C = K / Q
    else:
        k = 10 ** rng.uniform(-1, 0.5, 2) if kind == "two" else [0.0, 1.0]
        K = np.array([[k[0] + k[1], -k[1]], [-k[1], k[1]]])
        K[1, 1] += 10 ** rng.uniform(-3, -1) if kind == "isolator" else 0.0
        M, force, normal = (
            np.diag([1, 10 ** rng.uniform(-1, 1)]),
            [1.0, -0.5],
            [1, -1] if rng.random() < 0.6 else [1, 0],
        )
        C = K / Q + (0.3 * np.diag([0.0, 1.0]) if kind == "isolator" else 0.0)
    stop = {"k_stop": 10 ** rng.uniform(-0.5, 2.5) * mass / time**2, "c_stop": 10 ** rng.uniform(-2, 0) * mass / time}
    stop = stop if rng.random() < 0.4 else {"R": rng.uniform(0.2, 0.95)}
    return vs.Oscillator(
        M=M * mass, K=K * mass / time**2, C=C * mass / time, force=np.array(force) * mass * length / time**2,
        omega=omega / time, contact_normal=normal, b=rng.uniform(0.1, 1.1) * length,
        stops=rng.choice(["right", "both"]), tau=rng.choice([0.0, 1.0]), **stop,
    )  # fmt: skip


UNITS = [(2.0**-40, 1.0, 1.0), (2.0**-20, 2.0**-20, 1.0), (2.0**10, 1.0, 2.0**-30), (2.0**30, 2.0**10, 2.0**20)]


def concluded(system: vs.Oscillator, time: float, length: float):
    """Status, period, approached period, attractor; section points in units of the oscillator; and an orbit."""
    b = np.linspace(0.5, 1.3, 12) * system.b
    data = vs.sweep(system, {"b": b}, transient=400, record=80, observe=["section", "lyapunov", "attractors"])
    whole = [data[name].values for name in ("status", "period", "approached_period", "attractor_id")]
    real = [data[name].values / length for name in ("x1", "x2") if name in data]
    return whole, real, vs.periodic_orbit(system, itinerary="R")


@pytest.mark.parametrize("seed", [*range(3), *slow_cases(*range(3, 23))])
def test_units_change_nothing(seed):
    """Section points are compared where numbers are not rounded in another way."""
    was, numbers, orbit = concluded(drawn(np.random.default_rng(seed)), 1.0, 1.0)
    for time, length, mass in UNITS:
        now = concluded(drawn(np.random.default_rng(seed), time, length, mass), time, length)
        assert all(map(np.array_equal, now[0], was))
        if length == 1:  # else chaos is another one
            for one, other in zip(now[1], numbers, strict=True):
                assert np.allclose(one, other, rtol=1e-6, atol=1e-9, equal_nan=True)
        assert now[2].status == orbit.status
        assert not orbit.ok or np.allclose(now[2].state[::2] / length, orbit.state[::2], rtol=1e-9)


ALL = ["section", "lyapunov", "multipliers", "impacts", "contacts", "attractors", "energy", "convergence"]
POWERS = {"kg": (0, 0, 1), "m": (0, 1, 0), "s": (1, 0, 0), "N": (-2, 1, 1), "W": (-3, 2, 1)}  # of time, length, mass


def factor(units: str, own: tuple[float, float, float]) -> float:
    """By which a number with such units is larger where a time, a length and a mass of 1 are these."""
    result = 1.0
    for word in units.split():
        name = word.rstrip("-123")
        if name in POWERS:
            result *= np.prod(np.power(own, POWERS[name])) ** int(word[len(name) :] or 1)
    return result


@pytest.mark.parametrize("gap", [False, True], ids=["x1", "gap"])
@pytest.mark.parametrize("stop", [{"R": 0.8}, {"k_stop": 30.0, "c_stop": 0.2}], ids=["rigid", "compliant"])
def test_every_number_of_a_file_has_its_unit(stop, gap):
    """Compared with the same oscillator in other units, by the units that the file declares."""
    own, data = (2.0**-22, 2.0**-5, 2.0**3), []
    for time, length, mass in ((1.0, 1.0, 1.0), own):
        stops = {"R": 0.8} if "R" in stop else {"k_stop": 30 * mass / time**2, "c_stop": 0.2 * mass / time}
        system = vs.Oscillator(
            M=np.diag([1.0, 2.0]) * mass, K=np.array([[2.0, -1], [-1, 1.5]]) * mass / time**2, stops="both", tau=0.4,
            C=np.array([[0.1, -0.02], [-0.02, 0.1]]) * mass / time, force=np.array([1, 0.3]) * mass * length / time**2,
            omega=1.4 / time, contact_normal=[1, -1] if gap else [1, 0], b=0.4 * length, units="SI", **stops,
        )  # fmt: skip
        observe = ALL if "R" not in stop else [word for word in ALL if word != "contacts"]
        b = np.linspace(0.2, 0.5, 7) * length
        orbits = {"transient": 100, "record": 50, "trajectory": {"periods": 2, "samples": 9}}
        start = {"x1": 0.1 * length, "v1": 0.2 * length / time}
        data.append(vs.sweep(system, {"b": b}, observe=observe, start=start, **orbits))
    compared = 0
    for name, values in data[0].data_vars.items():
        if name == "average" or name.endswith(("_error", "_residual")) or values.dtype.kind not in "fi":
            continue  # of errors rounding is left
        there = data[1][name]
        scaled = there.values / factor(there.attrs.get("units", "1"), own)
        size = np.nanmax(np.abs(values.values), initial=0.0)
        assert np.allclose(scaled, values.values, rtol=1e-7, atol=1e-9 * size, equal_nan=True), name
        compared += 1
    assert compared > 35
    length, speed = own[1], own[1] / own[0]
    scales = np.array([length, speed, length, speed, 1, 1, 1 / own[0]])
    assert np.allclose(data[1].average / scales, data[0].average, rtol=1e-7, atol=1e-9, equal_nan=True)
