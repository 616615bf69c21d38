"""Oscillators of any number of masses, drawn at random: full matrices, damping not proportional, unequal stops."""

import numpy as np

import vibro_sweep as vs
from vibro_sweep.model.contact import contact_coordinates, natural_coordinates
from vibro_sweep.model.frame import Frame, frame_of
from vibro_sweep.model.linear import amplitudes, stacked, static_state


def positive(rng, n, least):
    """A symmetric positive definite matrix."""
    A = rng.normal(size=(n, n))
    return A @ A.T / n + least * np.eye(n)


def frame_of_one(system) -> Frame:
    """The frame of tangent vectors of one oscillator."""
    q = stacked([system.linear])
    return Frame(*(one[0] for one in frame_of(natural_coordinates(q, contact_coordinates(q)), q.omega)))


def drawn(seed, n, constant=True, contact_normal=None, **changes):
    """An oscillator whose free motion would pass both stops, and a state at rest between them.

    Two masses meet each other (n = e1 - e2); of others the gap is any combination.
    """
    rng = np.random.default_rng([n, seed])
    numbers = dict(
        M=positive(rng, n, 1.0), K=positive(rng, n, 0.2), C=0.05 * positive(rng, n, 0.1),
        contact_normal=np.array([1.0, -1.0]) if n == 2 else rng.normal(size=n),
        force=3 * rng.normal(size=n), force_cos=2 * rng.normal(size=n), omega=0.8, tau=0.3,
        R=0.85, R_left=0.7, b=1.0,
    )  # fmt: skip
    numbers["constant"] = 0.2 * rng.normal(size=n) if constant else np.zeros(n)
    if contact_normal is not None:
        numbers["contact_normal"] = np.array(contact_normal, float)
    free = vs.Oscillator(**numbers).linear
    size, middle = abs(free.normal @ amplitudes(free)), free.normal @ static_state(free)
    numbers |= {"b": 0.45 * size, "offset": middle - 0.05 * size} | changes
    system = vs.Oscillator(**numbers)
    state = np.zeros(2 * n)
    state[0::2] = np.linalg.lstsq(free.normal[None], [system.offset], rcond=None)[0]
    return system, state


def one_mass(**numbers):
    """A free mass, unless the numbers say otherwise."""
    return vs.Oscillator(**(dict(M=[[1.0]], K=[[0.0]], contact_normal=[1.0]) | numbers))
