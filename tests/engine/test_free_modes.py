"""The frame of tangent vectors where roots coincide: free modes, with damping and without."""

import numpy as np
import pytest
from reference.closed_orbit import ClosedOrbit, impacts_of
from reference.machine import machine_of
from support import slow_cases
from support.frames import frame_of_one

import vibro_sweep as vs
from vibro_sweep.engine.points import frame

CASES = pytest.mark.parametrize(
    ("k", "c", "stop_at"),
    [
        ((0, 0, 0, 1.446), (0.016, 0, 0.078, 0), 2),  # two free modes with damping: the root 0 twice
        ((1, 1, 0, 0), (0.1, 0, 0, 0), 1),  # damping that is not classical, and a mass that flies freely,
        ((1, 1, 0, 0), (0.1, 0, 0, 0), 3),  # which hits the stop
        ((0.566, 0, 0, 0), (0, 0.169, 0, 0.0427), 1),  # two free masses that only dampers hold
        ((0, 1.459, 0, 0), (0, 0, 0.04, 0.13), 3),
        ((1.02, 0, 0, 0), (0.07, 0.09, 0, 0.1), 1),
        ((0, 1.3, 0, 0), (0, 0.12, 0, 0.1), 1),
        ((0.6, 0, 1.2, 0.8), (0.9, 0, 0.2, 0), 1),  # overdamped and free modes that the contact does not see
    ],
)


def chain_of(k, c, stop_at):
    numbers = dict(m=[1.7, 1.2, 1.8], force=[0.3, -0.5, 0.6], omega=0.43, R=0.6, b=1.0, tau=0.0)
    return vs.Oscillator.named("chain", k=k, c=c, stop_at=stop_at, **numbers)


@CASES
def test_a_frame_exists(k, c, stop_at):
    """Two roots 0 span no plane, and the two of a free mode without damping have one vector."""
    chain = chain_of(k, c, stop_at)
    found = frame_of_one(chain)
    assert np.abs(found.to @ found.back - np.eye(6)).max() < 1e-9 and np.linalg.cond(found.back) < 1e6


def test_what_no_planes_part_has_no_frame(monkeypatch):
    """No oscillator is known for which this happens; the bound is lowered until it does."""
    chain = chain_of((1.02, 0, 0, 0), (0.07, 0.09, 0, 0.1), 1)
    monkeypatch.setattr(frame, "NO_PLANES", 2.0)
    assert np.isnan(frame_of_one(chain).to).all()


@pytest.mark.parametrize("count", [100, *slow_cases(2000)])
def test_frames_of_random_chains(count):
    """Chains of one mass to five, of which two springs and dampers of three are missing."""
    rng = np.random.default_rng(0)
    for _ in range(count):
        n = int(rng.integers(1, 6))
        k, c = (rng.choice([0, 0, 1], n + 1) * 10 ** rng.uniform(-2, 0.3, n + 1) for _ in range(2))
        numbers = dict(m=rng.uniform(0.5, 2, n), force=np.ones(n), omega=0.5, R=0.6, b=1.0, tau=0.0)
        chain = vs.Oscillator.named("chain", k=k, c=c, stop_at=int(rng.integers(1, n + 1)), **numbers)
        found = frame_of_one(chain)
        assert np.linalg.cond(found.back) < 1e7, (k, c, chain.stop_at)


@pytest.mark.slow
@CASES
def test_exponents_are_those_of_the_jacobians(k, c, stop_at):
    """Those of the reference, which knows no frame, from the impacts of each period."""
    chain, periods = chain_of(k, c, stop_at), 200
    exponents = vs.lyapunov(chain, np.zeros(6), transient=20, record=periods)
    assert abs(exponents.residual) < 1e-11
    machine = machine_of(chain.linear)
    state, Q, growth = vs.simulate(chain, np.zeros(6), 20).section[-1], np.eye(6), np.zeros(6)
    for _ in range(periods):
        orbit = vs.simulate(chain, state, 1)
        hits = orbit.impacts
        period = ClosedOrbit(machine, impacts_of(machine, hits["side"]), 1)  # it need not be closed
        jacobian = np.array(period.closure(list(state), hits["t"].tolist()).tolist(), float)
        Q, R = np.linalg.qr(jacobian @ Q)
        growth += np.log(np.abs(np.diag(R)))
        state = orbit.section[-1]
    found = np.sort(growth)[::-1] / (periods * chain.period)
    assert np.all(np.abs(exponents - found) < 3e-3 + exponents.error)
