"""Floquet multipliers: against monodromy matrices in 40 digits, and against difference quotients of the flow."""

import numpy as np
import pytest
from mpmath import mp, mpf
from reference.closed_orbit import ClosedOrbit, impacts_of
from reference.events import simulate
from reference.machine import machine_of
from support import sample, slow_cases
from support.scene_texts import parsed

import vibro_sweep as vs

PAPER = dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.0, omega=0.63, R=0.8)
# (system, transient): moduli of like size, real pairs of opposite sign, next to a split, moduli far apart
CASES = [
    (dict(mu_m=2.5, mu_k=2.5, zeta=0.03, f2=0.0, omega=0.492, b=1.0, R=0.7, stops="right"), 1000),
    (dict(**PAPER, b=0.5999), 3000),
    (dict(**PAPER, b=3.7575), 1300),
    (dict(**PAPER, b=3.7576), 1300),
    (dict(**PAPER, b=5.8505), 3000),
    (dict(**PAPER, b=6.6), 3000),
    (dict(**PAPER, b=6.69), 5000),
    (dict(**PAPER, b=6.8), 1300),
]


def swept(tmp_path, system, sweep, orbit, observe="section, lyapunov, multipliers, impacts"):
    text = f"system: {{{system}}}\nsweep: {sweep}\norbit: {orbit}\nobserve: [{observe}]\n"
    vs.run(parsed(text), tmp_path / "sweep.h5")
    return vs.open(tmp_path / "sweep.h5").load()


def point(tmp_path, values, transient):
    numbers = ", ".join(f"{name}: {value}" for name, value in values.items() if name != "b")
    data = swept(tmp_path, numbers, f"{{b: {{values: [{values['b']}]}}}}", f"{{transient: {transient}, record: 200}}")
    return data.isel(b=0)


@pytest.mark.parametrize(
    ("values", "transient"),
    sample(1, CASES),
    ids=lambda value: f"b={value['b']}" if isinstance(value, dict) else None,
)
def test_against_forty_digits(tmp_path, values, transient):
    data = point(tmp_path, values, transient)
    system, period = vs.System(**values), int(data.period)
    assert period > 0 and int(data.status) == 0
    state = [float(data[name][-1]) for name in ("x1", "v1", "x2", "v2")]
    orbit = vs.simulate(system, state, period)
    machine = machine_of(system.linear)
    closed = ClosedOrbit(machine, impacts_of(machine, orbit.impacts["side"]), period)
    exact = np.array([complex(mu) for mu in closed.multipliers(*closed.solve(state, orbit.impacts["t"]))])
    found = (data.multiplier_re + 1j * data.multiplier_im).values
    paired = np.array([exact[np.argmin(np.abs(exact - value))] for value in found])
    error = np.abs(found - paired)
    assert (error <= 5 * data.multiplier_error.values + 1e-10 * np.abs(paired)).all(), error / np.abs(paired)
    assert (data.multiplier_error.values < 1e-5 * np.abs(found)).all()
    exponents = np.sort(np.log(np.abs(exact)) / (period * system.period))[::-1]
    np.testing.assert_allclose(data.lyapunov, exponents, rtol=0, atol=1e-8)
    assert abs(float(data.lyapunov_residual)) < 1e-13
    moduli = np.abs(found)
    assert (np.diff(moduli) <= 1e-12 * moduli[:-1]).all()  # by falling modulus, +im first in a pair
    pairs = found[found.imag != 0]
    assert (pairs[::2].imag > 0).all() and (pairs[::2] == pairs[1::2].conj()).all()


def test_no_multipliers_without_a_period(tmp_path):
    data = point(tmp_path, dict(**PAPER, b=6.68), 1300)
    assert int(data.period) == 0 and np.isnan(data.multiplier_re).all() and np.isnan(data.multiplier_error).all()


def test_dimensions_lost_by_a_rest_have_the_multiplier_zero(tmp_path):
    data = point(tmp_path, dict(PAPER, R=0.1, b=0.8), 400)
    assert int(data.period) > 0 and float(data.sticking_time) > 0
    assert (data.multiplier_re[2:] == 0).all() and (data.multiplier_im[2:] == 0).all()
    assert np.isneginf(data.lyapunov[2:]).all() and np.isnan(data.lyapunov_residual)
    # of the two that are left the product is exact: det over the flights and rests
    assert 0 < np.hypot(data.multiplier_re[0], data.multiplier_im[0]) < 1


def in_digits(machine, state):
    """The Jacobian of the map over a period, by difference quotients in 30 digits; of a mass at rest on its stop 0."""
    columns, step = [], mpf(10) ** -14
    resting = abs(state[0]) in [abs(stop.place) for stop in machine.contacts[0].stops]
    with mp.workdps(50):
        for i in range(len(state)):
            if resting and i < 2:
                columns.append([0.0] * len(state))
                continue
            ends = []
            for sign in (1, -1):
                start = [mpf(x) + (sign * step if i == j else 0) for j, x in enumerate(state)]
                ends.append(simulate(machine, start, periods=1, digits=30).section[1])
            columns.append([float((a - b) / (2 * step)) for a, b in zip(*ends, strict=True)])
    return np.transpose(columns)


@pytest.mark.parametrize("b, R", [(0.05, 0.8), *slow_cases((0.03, 0.8), (0.05, 0.5), (0.1, 0.6))])
def test_through_chatter_that_ends_in_a_rest(tmp_path, b, R):
    """The impacts that are summed up at the end of a chatter sequence push M2 as those before them do."""
    values = PAPER | dict(b=b, R=R)
    data = point(tmp_path, values, 300)
    assert data.period == 1
    state = [float(data[name][-1]) for name in ("x1", "v1", "x2", "v2")]
    exact = np.linalg.eigvals(in_digits(machine_of(vs.System(**values).linear), state))
    exact = exact[np.argsort(-abs(exact), kind="stable")][:2]
    found = (data.multiplier_re + 1j * data.multiplier_im).values[:2]
    np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(exact), rtol=1e-13)


def quotients(system, state, period, step=1e-6):
    """The monodromy matrix by central differences of the flow; None if an impact is gained or lost on the way."""
    hits = len(vs.simulate(system, state, period).impacts)
    columns = []
    for i in range(4):
        ends = []
        for sign in (1, -1):
            moved = np.array(state)
            moved[i] += sign * step
            if abs(moved[0]) > system.b:
                return None
            orbit = vs.simulate(system, moved, period)
            if len(orbit.impacts) != hits:
                return None
            ends.append(orbit.section[-1])
        columns.append((ends[0] - ends[1]) / (2 * step))
    return np.transpose(columns)


SWEEPS = {
    "b": ("mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8", "{start: 0.8, stop: 6.9, num: %d}"),
    "mu_k": ("mu_m: 10, b: 5.3, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8", "{start: 3, stop: 7, num: %d}"),
    "omega": ("mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, b: 5, R: 0.8", "{start: 0.5, stop: 0.8, num: %d}"),
    "R": (
        "mu_m: 2.5, mu_k: 2.5, zeta: 0.03, f2: 0.3, omega: 0.492, b: 1, stops: right",
        "{start: 0.3, stop: 0.95, num: %d}",
    ),
}


def against_quotients(tmp_path, key, count):
    """Periodic points of a sweep, how many could be compared, and those that disagree."""
    numbers, axis = SWEEPS[key]
    data = swept(tmp_path, numbers, f"{{{key}: {axis % count}}}", "{transient: 3000, record: 200}")
    base = {name: value for name, value in (pair.split(": ") for pair in numbers.split(", "))}
    tried = compared = 0
    wrong = []
    for n in np.flatnonzero(data.period > 0):
        at = data.isel({key: n})
        values = {name: value if name == "stops" else float(value) for name, value in base.items()}
        system = vs.System(**values, **{key: float(at[key])})
        tried += 1
        M = quotients(system, [float(at[name][-1]) for name in ("x1", "v1", "x2", "v2")], int(at.period))
        if M is None or not float(at.min_impact_speed) > 0.02:  # differences bend where an impact is slow
            if M is None or float(at.min_impact_speed) == float(at.min_impact_speed):
                continue
        compared += 1
        found, seen = (at.multiplier_re + 1j * at.multiplier_im).values, np.linalg.eigvals(M)
        nearest = np.array([seen[np.argmin(np.abs(seen - value))] for value in found])
        # eigenvalues that lie close together move like the square root of the error of the quotients
        if (np.abs(found - nearest) > 3e-3 * np.abs(M).max()).any():
            wrong.append((float(at[key]), int(at.period), found, seen))
    return tried, compared, wrong


@pytest.mark.parametrize("key", ["b", *slow_cases("R", "mu_k", "omega")])
def test_against_difference_quotients(tmp_path, key):
    tried, compared, wrong = against_quotients(tmp_path, key, 25)
    assert compared > 8 and not wrong, (tried, compared, wrong)


@pytest.mark.slow
@pytest.mark.parametrize("key", ["b", "omega"])
def test_every_periodic_point_against_difference_quotients(tmp_path, key, capsys):
    tried, compared, wrong = against_quotients(tmp_path, key, 600)
    with capsys.disabled():
        print(f"\nsweep over {key}: {tried} periodic points, {compared} compared, {len(wrong)} disagree")
    assert compared > 200 and not wrong, wrong
