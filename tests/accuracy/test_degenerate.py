"""Degenerate modes against matrix exponentials of 50 digits and more, and the extremes of every parameter."""

import numpy as np
import pytest
from mpmath import mp, mpf
from reference import naive
from reference.gmp import expm
from support import sample

import vibro_sweep as vs

BASE = dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.0, omega=0.63, R=0.8, b=1e12, tau=0.7)  # stops out of reach
PAPER = dict(mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.0, omega=0.63)
STATE = (0.3, 0.7, -0.5, 0.4)
OMEGA_1, OMEGA_2 = np.sqrt(vs.System(**BASE).modes.omega_squared).tolist()

CASES = {
    **{f"zeta={zeta}": dict(zeta=zeta) for zeta in (0.0, 1e-12)},
    **{
        f"critical-{j}{off:+.0e}": dict(zeta=(1 + off) / omega)
        for j, omega in ((1, OMEGA_1), (2, OMEGA_2))
        for off in (0.0, -1e-12, 1e-12)
    },
    "one-overdamped": dict(zeta=(1 / OMEGA_1 + 1 / OMEGA_2) / 2),
    **{f"both-overdamped-{f}": dict(zeta=f / OMEGA_1) for f in (1.5, 10.0)},
    **{
        f"resonance-{j}-zeta={zeta}": dict(omega=omega, zeta=zeta)
        for j, omega in ((1, OMEGA_1), (2, OMEGA_2))
        for zeta in (1.0, 0.1, 1e-3, 1e-6, 1e-9, 1e-12, 0.0)
    },
    **{
        f"{name}={value}-zeta={zeta}": {name: value, "zeta": zeta}
        for zeta in (0.05, 0.0)
        for name, values in (
            ("mu_m", (1e-6, 1e-4, 1e-2, 1e2, 1e4, 1e6)),
            ("mu_k", (1e-6, 1e-4, 1e-2, 1e2, 1e4, 1e6)),
            ("f2", (0.25, 0.5, 1.0)),
        )
        for value in values
    },
}


def after_a_period(parameters, state):
    """The state after one free forcing period, by the exponential of the autonomous system, to 50 digits."""
    mu_m, mu_k, zeta, f2, omega, tau = (mpf(parameters[n]) for n in ("mu_m", "mu_k", "zeta", "f2", "omega", "tau"))
    A = mp.zeros(6)
    A[0, 1] = A[2, 3] = 1
    for j, a in enumerate((-1, -2 * zeta, 1, 2 * zeta, 1 - f2)):
        A[1, j] = a
    for j, a in enumerate((1, 2 * zeta, -(1 + mu_k), -2 * zeta * (1 + mu_k), f2)):
        A[3, j] = a / mu_m
    A[4, 5], A[5, 4] = omega, -omega
    start = mp.matrix([*map(mpf, state), mp.sin(tau), mp.cos(tau)])
    return (expm(A * (2 * mp.pi / omega)) * start)[:4]


def distance(x, y):
    return mp.norm(mp.matrix([mpf(a) - mpf(b) for a, b in zip(x, y, strict=True)]))


def error_and_condition(case):
    """Relative error of the state after a period, and the sum of the effects of 2^-53 on every input."""
    parameters = {**BASE, **CASES[case]}
    found = vs.simulate(vs.System(**parameters), STATE, periods=1).section[1].tolist()
    with mp.workdps(90):  # 50, and what squaring loses where the rates are large
        exact = after_a_period(parameters, STATE)
        size = mp.norm(exact)
        moved = naive.perturbed_inputs({**parameters, "b": 1.0}, STATE)
        condition = sum(distance(after_a_period(*inputs), exact) for inputs in moved)
        return float(distance(found, exact) / size), float(condition / size)


@pytest.mark.parametrize("case", sample(5, CASES))
def test_flight_over_a_period(case):
    """To 1e-12, also where rounding the inputs alone makes 6.6e-9 of it."""
    error, condition = error_and_condition(case)
    assert error < 1e-12, f"2^-53 on the inputs makes {condition:.1e}"
    assert error < max(10 * condition, 1e-15)


def test_thousands_of_impacts_in_a_period():
    system = vs.System(**PAPER, R=1.0, b=1e-3, tau=0.0)
    orbit = vs.simulate(system, (0.0, 1.0, 0.0, 0.0), 1)
    assert orbit.status == "ok"
    assert len(orbit.impacts) > 3000
    # nothing is passed through: nearly always stop to stop, and M1 is back on the stop where it is hit twice
    assert np.mean(orbit.impacts["side"][1:] != orbit.impacts["side"][:-1]) > 0.9
    times = np.sort(np.random.default_rng(0).uniform(0, system.period, 20000))
    samples = orbit.sample(times)
    assert np.abs(samples[:, 0]).max() <= system.b + 64 * 2.0**-52 * np.abs(samples).max()


def energy(system, states):
    x1, v1, x2, v2 = states.T
    return (v1**2 + system.mu_m * v2**2 + (x1 - x2) ** 2 + system.mu_k * x2**2) / 2


@pytest.mark.parametrize("f2", [0.0, 0.4])
def test_energy_balance_of_the_elastic_undamped_oscillator(f2):
    """zeta = 0, R = 1: the energy changes by the work of the force, and by nothing else."""
    system = vs.System(mu_m=10.0, mu_k=5.0, zeta=0.0, f2=f2, omega=0.63, R=1.0, b=2.0, tau=0.3)
    orbit = vs.simulate(system, (0.5, 0.4, -0.3, 0.2), periods=100)
    assert len(orbit.impacts) > 100
    grid = np.linspace(0, orbit.section_times[-1], 100 * 16 + 1)
    edges = np.unique(np.concatenate([grid, orbit.impacts["t"]]))
    nodes, weights = np.polynomial.legendre.leggauss(12)
    widths = np.diff(edges)[:, None]
    times = (edges[:-1, None] + widths * (nodes + 1) / 2).ravel()
    states = orbit.sample(times)
    power = np.sin(system.omega * times + system.tau) * ((1 - f2) * states[:, 1] + f2 * states[:, 3])
    work = (weights * widths / 2 * power.reshape(len(widths), -1)).sum()
    start, end = energy(system, orbit.section[[0, -1]])
    assert abs(end - start - work) < 1e-10 * max(start, end, np.abs(power).max())


SCENE = """\
system: {{mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: {R}, b: {b}}}
start: {{x1: 0, v1: 0, x2: 0, v2: 0}}
orbit: {{transient: {transient}, record: 60}}
observe: [section, impacts]
"""


@pytest.mark.slow
@pytest.mark.parametrize("R, b", [(0.8, 6.8), (0.8, 5.0), (0.8, 6.6), (0.3, 0.5)])
def test_a_million_periods(R, b, tmp_path):
    """The phase does not drift: the section points of a stable orbit are the same after 10^4 and many more periods."""
    points = []
    for transient in (10_000, 1_000_000):
        scene = tmp_path / f"long{transient}.yaml"
        scene.write_text(SCENE.format(R=R, b=b, transient=transient))
        vs.run(vs.load_scene(scene), tmp_path / f"long{transient}.h5")
        with vs.open(tmp_path / f"long{transient}.h5") as data:
            assert int(data["status"]) == 0
            assert int(data["period"]) > 0
            points.append(np.stack([data[name].values.ravel() for name in ("x1", "v1", "x2", "v2")], -1))
    shifts = [np.abs(points[0][-30:] - points[1][n : n + 30]).max() for n in range(30)]
    assert min(shifts) < 1e-12


@pytest.mark.parametrize(
    ("omega", "contact_normal", "force", "size"),
    [
        (1.0, (1, -1), (1, -1), 1.0),  # the mode in resonance is neither driven nor seen by the contact,
        (1.0, (1, 0), (1, -1), 0.5),  # not driven
        (np.sqrt(3.0), (1, 0), (1, 1), 0.5),
        (1.0, (1, 0), (1, 0), np.nan),  # driven
    ],
)
def test_an_undamped_mode_in_resonance_that_is_not_driven(omega, contact_normal, force, size):
    """Masses 1 with modes (1, 1), (1, -1) of omega^2 = 1, 3: the other one alone answers, with 1/(3 - 1)."""
    system = vs.Oscillator(
        np.eye(2), [[2, -1], [-1, 2]], contact_normal=contact_normal, force=force, omega=omega, b=0.5, R=0.7
    )
    touch = vs.grazing(system)
    assert touch.b == pytest.approx(size, rel=1e-14, nan_ok=True) and not touch.satisfied
    paper = vs.grazing(vs.System(mu_m=1, mu_k=0, zeta=0, f2=0.5, omega=np.sqrt(2.0), R=0.8, b=0.3))
    assert paper.b == pytest.approx(0.25, rel=1e-14) and not paper.satisfied


def test_an_undamped_mode_that_repeats_itself_leaves_no_single_motion():
    """(15) vanishes where the frequency of a mode is a multiple of omega, exactly so only without rounding."""
    system = vs.System(mu_m=1, mu_k=1, zeta=0, f2=0, omega=1.0, R=0.8, b=1)
    omega = float(np.sqrt(system.modes.omega_squared[0])) / 2
    assert not vs.grazing(system.replace(omega=omega)).satisfied and vs.grazing(system).satisfied
