"""What kernels are given of each point of a sweep, and what they give back of each orbit."""

import functools
import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.oscillator.contact_laws.compliant import StopLaw
from vibro_sweep.tables.observables import OF_AN_ORBIT, dimensions


class Kind(NamedTuple):
    """The kind of oscillators for which kernels are compiled."""

    masses: int
    constant: bool  # whether there is room for a constant force
    compliant: bool = False  # whether some stops are (engine/compliant/)


@functools.cache
def point_of(kind: Kind) -> np.dtype:
    """A point: an oscillator in contact coordinates q = P (x - x0)."""
    n = kind.masses
    contact = [
        # of the left stop and the right one the numbers of its law, over m_e: k, which is 0 if it is rigid, c and p
        ("contact_law", float, (2, len(StopLaw._fields))),
        ("release", np.int64),  # of engine/compliant/stop_laws.py
        ("contact_rate", float, 2),  # the fastest in contact
        ("contact_mass", float),  # m_e
    ]
    return np.dtype(
        [
            *(contact if kind.compliant else []),
            ("stops", float, 4),  # left, right, and the restitution of each
            ("omega", float),
            ("tau", float),
            ("cells", np.int64),  # 0: its rates are too far apart
            ("rate", float),  # the fastest of free flight, and
            ("constrained_rate", float),  # while a stop holds the gap
            ("divergence", float),  # trace of -damping
            ("stiffness", float, (n, n)),  # q'' + damping q' + stiffness q = force (sin, cos, 1)
            ("damping", float, (n, n)),
            ("force", float, (n, 3)),
            ("apart", np.bool_),  # its flights are computed in twice the digits (engine/tables/twofold.py), with
            ("low", float, (n, 2 * n + 3)),  # what rounding left of -stiffness, -damping and force, side by side
            (
                "constrained",
                float,
                (n, 2 * n + 3),
            ),  # q'' as a function of (q, q', sin, cos, 1) while a stop holds the gap
            ("push", float, (n,)),  # what an impulse on the gap does to q'
            ("turned", np.bool_),  # states are others than those of the masses
            ("P", float, (n, n)),
            ("back", float, (n, n)),
            ("origin", float, (n,)),  # x0
            ("graze", float, (2 * n,)),  # the point at which the discontinuity mapping is expanded
            ("steady", float, (2 * n,)),  # of points/confinement.py, as far as
            ("middle", float),
            ("swing", float),
            ("confining", float, (2 * n, 2 * n)),  # here
            ("valid", np.bool_),  # of points/exponentials.py, for a stiff system:
            ("root", float, (2 * n + 3, 2)),  # real and imaginary parts
            ("part", float, (2 * n + 1, 2 * n + 3, 2)),
            ("begin", float, (2 * n,)),
            ("rounding", float),  # how far rounding may have moved the real part of a root
            ("frame_eta", float, (n,)),  # of tangent vectors (points/frame.py)
            ("frame_square", float, (n,)),
            ("frame_scale", float, (n,)),
            ("to_frame", float, (2 * n, 2 * n)),
            ("from_frame", float, (2 * n, 2 * n)),
        ]
    )


def result_of(masses: int) -> np.dtype:
    """Results of an orbit."""
    extents = dimensions(masses)
    fields = [  # what files can hold, and what is needed beside it:
        (one.name, one.dtype, tuple(extents[name].extent for name in one.dimensions)) for one in OF_AN_ORBIT
    ]
    return np.dtype(
        [
            *fields,
            ("end", float, (2 * masses,)),  # the state at the last section, and
            ("resting", float),  # the side of the stop that M1 rests on there, or 0
            ("relaxed", float, 2),  # where compliant stops are that relax
            ("begin", float, (2 * masses,)),  # as `end`, `resting` and `relaxed`, at the first section of the record,
            ("begin_resting", float),  # where the energy is observed
            ("begin_relaxed", float, 2),
            ("more", np.int64),  # forcing periods over which it is carried before its record; 0: it has not begun
        ]
    )


@functools.cache  # each block has some
def _new_result(masses: int) -> np.ndarray:
    """The result (1,) of a point that is not computed yet."""
    result = np.zeros(1, result_of(masses))
    for one in OF_AN_ORBIT:
        result[one.name] = one.fill
    result["end"] = np.nan
    return result


def new_results(shape: tuple[int, ...], masses: int = 2) -> np.ndarray:
    """Results of points that are not computed yet."""
    return _new_result(masses).repeat(math.prod(shape)).reshape(shape)


def starts_at(states: np.ndarray) -> np.ndarray:
    """Starts (..., 2 N + 3) of orbits at these states (..., 2 N) at t = 0, with all stops relaxed."""
    return np.concatenate(
        [states, np.zeros((*states.shape[:-1], 2)), np.full((*states.shape[:-1], 1), np.nan)], axis=-1
    )


def starts_after(results: np.ndarray, tau: np.ndarray) -> np.ndarray:
    """Starts (..., 2 N + 3) of orbits that go on from these results: states, the places of stops that relax, and the
    phase of the force there, tau (...)."""
    return np.concatenate([results["end"], results["relaxed"], tau[..., None]], axis=-1)
