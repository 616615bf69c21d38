"""The frame of tangent vectors where roots coincide: free modes, with damping and without."""

import numpy as np
import pytest

import vibro_sweep as vs
from vibro_sweep.model.contact import contact_coordinates
from vibro_sweep.model.frame import frame_of

CASES = pytest.mark.parametrize(
    ("k", "c", "stop_at"),
    [
        ((0, 0, 0, 1.446), (0.016, 0, 0.078, 0), 2),  # two free modes with damping: the root 0 twice
        ((1, 1, 0, 0), (0.1, 0, 0, 0), 1),  # damping that is not classical, and a mass that flies freely,
        ((1, 1, 0, 0), (0.1, 0, 0, 0), 3),  # which hits the stop
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
    frame = frame_of(contact_coordinates(chain.linear), chain.omega)
    assert np.abs(frame.to @ frame.back - np.eye(6)).max() < 1e-9 and np.linalg.cond(frame.back) < 1e6


@pytest.mark.slow
@CASES
def test_exponents_have_the_exact_sum(k, c, stop_at):
    exponents = vs.lyapunov(chain_of(k, c, stop_at), np.zeros(6), transient=20, periods=60)
    assert np.all(np.isfinite(exponents)) and abs(exponents.residual) < 1e-11
