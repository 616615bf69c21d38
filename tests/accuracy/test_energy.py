"""`observe: [energy]`: power lost in impacts, root mean squares and peaks, against dense samples and balances."""

import itertools
import math

import numpy as np
import pytest
from support.scene_texts import parsed

import vibro_sweep as vs

TRANSIENT, RECORD = 30, 20
PAPER = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=5.0)
ONE = vs.Oscillator.named("one_mass", zeta=0.02, F=0.35, omega=0.8, R=0.9, b=1, stops="right")
CAVITY = vs.Oscillator.named("ball_in_cavity", mass_ratio=0.05, zeta=0.01, F=0.1, omega=1.0, R=0.7, b=1.0)
CASES = {
    "impacts on both sides": (PAPER, "b", [4.5, 5.0], (0, 0, 0, 0)),
    "no impact": (PAPER, "b", [6.9, 7.0], (0, 0, 0, 0)),
    "rests": (PAPER.replace(R=0.2, R_left=0.0, offset=0.3), "b", [1.0, 2.0], (0, 0, 0, 0)),
    "one mass": (ONE, "F", [0.1, 0.35, 1.0], (0, 0)),
    "a ball in its cavity": (CAVITY, "b", [0.5, 1.0], (0, 0.1, 0, 0)),
}


def swept(system, key, values, start, **more):
    given = dict(observe=("energy", "impacts"), start=start, transient=TRANSIENT, record=RECORD)
    return vs.sweep(system, {key: values}, **(given | more))


@pytest.mark.slow  # compiles kernels for each kind of oscillator
@pytest.mark.parametrize("name", CASES)
def test_against_dense_samples(name):
    system, key, values, start = CASES[name]
    data = swept(system, key, values, start)
    for i, value in enumerate(values):
        one = system.replace(**{key: value})
        T, q = one.period, one.linear
        orbit = vs.simulate(one, start, TRANSIENT + RECORD)
        span = RECORD * T
        times = (TRANSIENT + np.arange(200 * 1000 + 1) / (10 * 1000)) * T
        states = orbit.sample(np.minimum(times, orbit.section_times[-1]))
        hits = orbit.impacts[orbit.impacts["t"] > TRANSIENT * T]
        mass = 1 / (q.contact.normal @ np.linalg.solve(q.M, q.contact.normal))
        R = np.where(hits["side"] > 0, q.contact.R_high, q.contact.R_low)
        loss = (0.5 * mass * (1 - R**2) * hits["v1"] ** 2).sum() / span
        assert data["impact_power"][i] == pytest.approx(loss, rel=1e-7, abs=1e-15)
        jumps = len(hits) / len(times)  # of a velocity, each within one step of the samples
        for j, coordinate in enumerate(("x1", "v1", "x2", "v2")[: 2 * one.masses]):
            mean = math.sqrt(np.trapezoid(states[:, j] ** 2, times) / span)
            known = 1e-7 if coordinate.startswith("x") else 1e-7 + 3 * jumps
            assert data[f"rms_{coordinate}"][i] == pytest.approx(mean, rel=known), coordinate
            peak, found = np.abs(states[:, j]).max(), data[f"peak_{coordinate}"][i]
            beyond = 2e-3 if len(hits) else 1e-7  # of the samples: the largest velocity may be that before an impact
            assert peak * (1 - 1e-8) <= found <= peak * (1 + beyond), coordinate


@pytest.mark.slow
def test_the_free_motion_in_closed_form():
    """x = a cos(omega t + p): the root of a^2/2, and a itself."""
    system = PAPER.replace(b=8.0)
    touch = vs.grazing(system)
    data = swept(system, "b", [8.0, 9.0], touch.state)
    for i in (0, 1):
        assert data["impact_power"][i] == 0
        assert data["rms_x1"][i] == pytest.approx(touch.b / math.sqrt(2), rel=1e-13)
        assert data["rms_v1"][i] == pytest.approx(0.63 * touch.b / math.sqrt(2), rel=1e-13)
        assert data["peak_x1"][i] == pytest.approx(touch.b, rel=1e-13)
        assert data["peak_v1"][i] == pytest.approx(0.63 * touch.b, rel=1e-13)


def test_balance_of_a_periodic_orbit():
    """What the force gives in a period is what the dampers and the impacts take; mean squares between the impacts."""
    system = PAPER.replace(b=4.2, omega=0.65)
    start = vs.simulate(system, (0, 0, 0, 0), 3000).section[-1]
    data = swept(system, "R", [0.8], start, transient=0, record=60, observe=("energy", "section"))
    period = int(data["period"][0])
    assert period > 0 and 60 % period == 0
    orbit = vs.simulate(system, start, period)
    cuts = np.concatenate([[0.0], orbit.impacts["t"], [period * system.period]])
    given = taken = squares = 0.0
    x, w = np.polynomial.legendre.leggauss(60)
    for low, high in itertools.pairwise(cuts):
        t = low + (high - low) * (x + 1) / 2
        v = orbit.sample(t)[:, 1::2]
        force = np.outer(np.sin(system.omega * t + system.phase), system.linear.sine)
        given += (force * v).sum(axis=1) @ w * (high - low) / 2
        taken += np.einsum("ti,ij,tj->t", v, system.linear.C, v) @ w * (high - low) / 2
        squares += w @ v**2 * (high - low) / 2
    lost = (given - taken) / (period * system.period)
    assert data["impact_power"][0] == pytest.approx(lost, rel=1e-9) and lost > 1e-3
    mean = np.sqrt(squares / (period * system.period))
    assert [float(data[name][0]) for name in ("rms_v1", "rms_v2")] == pytest.approx(mean, rel=1e-11)


@pytest.mark.parametrize("start", ["{follow: both}", "{random: 3, seed: 2}"])
def test_parts_do_not_matter(tmp_path, start):
    """The same numbers as of single orbits from where each starts."""
    numbers = "mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8"
    text = f"system: {{{numbers}}}\nsweep: {{b: {{values: [4.2, 4.4, 4.6]}}}}\nstart: {start}\n"
    text += "orbit: {transient: 5, record: 3}\nobserve: [energy, section]"
    vs.run(parsed(text), tmp_path / "one.h5", workers=1)
    vs.run(parsed(text), tmp_path / "two.h5", workers=2)
    with vs.open(tmp_path / "one.h5") as one, vs.open(tmp_path / "two.h5") as two:
        assert one.equals(two) and np.isfinite(one["rms_x1"]).all()
        last = one["x1"].isel(sample=-1)
        assert (one["peak_x1"] >= np.abs(last) * (1 - 1e-12)).all()


def test_nothing_is_computed_unasked():
    data = swept(PAPER, "b", [5.0], (0, 0, 0, 0), observe=("impacts",))
    assert "impact_power" not in data and "rms_x1" not in data
