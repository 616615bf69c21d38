"""Stacks of linear oscillators as points of the kernels, in contact coordinates.

Of those that differ in their stops alone one is worked out.
"""

from operator import attrgetter

import numpy as np

from vibro_sweep.engine.points.confinement import confinement_of
from vibro_sweep.engine.points.contact import (
    ContactCoordinates,
    by_mass,
    contact_coordinates,
    coordinates,
    distance,
    fastest_rate,
    is_own,
    least_restrained,
    natural_coordinates,
    origin_of,
)
from vibro_sweep.engine.points.exact import exact_motion
from vibro_sweep.engine.points.exponentials import gap_exponentials
from vibro_sweep.engine.points.frame import frame_of
from vibro_sweep.engine.points.plain_points import APART, UNEVEN, machine_of, modes_of, set_plain_points
from vibro_sweep.engine.records import Kind, point_of
from vibro_sweep.engine.tables import cells
from vibro_sweep.engine.tables.flight import WIDTH
from vibro_sweep.oscillator.linear import MOTION, Linear, grazing_state, mapped, selected
from vibro_sweep.oscillator.stacks import different, dot, finite, only, unrepeated
from vibro_sweep.oscillator.steady import gap_responses, steady_amplitudes

motion_numbers = attrgetter(*MOTION)  # of an oscillator


def kind_of(q: Linear) -> Kind:
    """The kind for which kernels must be compiled: oscillators with the same number of masses.

    With one mass a constant force takes no time, also where it is 0: kernels with room for it serve both.
    """
    masses = q.masses
    constant = masses == 1 or bool(np.any(q.constant) or np.any(origin_of(q)))
    return Kind(masses, constant, bool(np.any(q.compliant)))


def any_points(q: Linear, kind: Kind, frames: bool = True) -> np.ndarray:
    """Points of a stack of oscillators, tau resolved, of its shape. frames: whether tangent vectors are wanted."""
    shape, origin = q.omega.shape, origin_of(q)
    once = unrepeated([*motion_numbers(q), origin], len(shape))
    few = _flat(mapped(lambda name, x: x[once], q))
    numbers = motion_numbers(few)
    rows = np.concatenate([_row(one) for one in (*numbers, origin[once].reshape(few.contact.normal.shape))], -1)
    unlike, place = different(rows)
    place = np.broadcast_to(place.reshape(q.omega[once].shape), shape)
    result = _repeated(_points(few, rows[unlike], unlike, kind, frames), place)
    low, high = (distance(q, origin, gap) for gap in (q.contact.low, q.contact.high))
    result["stops"] = np.stack([low, high, q.contact.R_low, q.contact.R_high], -1)
    if kind.compliant:
        _set_contact(result, q)
    return result


def _repeated(points: np.ndarray, place: np.ndarray) -> np.ndarray:
    """points[place], as bytes: NumPy copies records field by field."""
    return points.view(np.uint8).reshape(len(points), -1)[place].view(points.dtype)[..., 0]


def _flat(q: Linear) -> Linear:
    """The same stack with one dimension."""
    lead = q.omega.ndim
    return mapped(lambda name, x: x.reshape(-1, *x.shape[lead:]), q)


def _row(values: np.ndarray) -> np.ndarray:
    return values.reshape(len(values), -1)


def _set_contact(points: np.ndarray, q: Linear) -> None:
    """The compliant stops of points, over m_e = 1/(n M^-1 n), and the fastest rate in contact with each."""
    mass = 1 / dot(q.contact.normal, by_mass(q.M, q.contact.normal[..., None])[..., 0])
    points["contact_mass"], points["release"] = mass, q.contact.by_force
    for n, side in enumerate((-1, 1)):
        for j, number in enumerate(q.contact.law(side)):
            points["contact_law"][..., n, j] = number / mass
    for n in range(2):
        stiffness, damping = points["stiffness"].copy(), points["damping"].copy()
        stiffness[..., 0] += points["push"] * points["contact_law"][..., n, 0, None]
        damping[..., 0] += points["push"] * points["contact_law"][..., n, 1, None]
        points["contact_rate"][..., n] = np.maximum(fastest_rate(stiffness, damping), q.omega)


def grazing_points(q: Linear, expand_at: float | None) -> np.ndarray:
    """X* at the right stop (..., 2 N), in contact coordinates; NaN where no steady motion grazes.

    expand_at : the gap there, in place of the exact one
    """
    response = gap_responses(q, steady_amplitudes(q))
    result = np.full((*response.shape, 2 * q.masses), np.nan)
    for place in np.ndindex(response.shape):  # () where it is one oscillator
        if np.isnan(response[place]) or response[place] == 0:
            continue
        one = selected(q, place)
        state = np.kron(coordinates(one.contact.normal, least_restrained(one))[0], np.eye(2)) @ grazing_state(one)
        state[0] = state[0] if expand_at is None else expand_at
        result[place] = state
    return result


def _points(q: Linear, rows: np.ndarray, which: np.ndarray, kind: Kind, frames: bool) -> np.ndarray:
    """Points of the oscillators `which` of a stack, all but the stops; rows: their numbers, and x0."""
    n = kind.masses
    points, plain = np.zeros(len(which), point_of(kind)), np.empty(len(which), bool)
    machines = np.ascontiguousarray(rows[:, :-n]).view(machine_of(n))[:, 0]
    set_plain_points(machines, points, plain, np.empty(1, modes_of(n)), frames)
    points["cells"] = cells.cells_for(np.maximum(points["rate"], points["omega"]), points["omega"])
    plain &= (points["cells"] > 0) & (points["cells"] != cells.STIFF_CELLS) & ~points["apart"] & ~rows[:, -n:].any(-1)
    if not plain.all():
        others = which[~plain]
        points[~plain] = _other_points(selected(q, others), kind, frames)
    return points


def is_uneven(stiffness: np.ndarray) -> np.ndarray:
    """Whether stiffnesses over masses (..., N, N) have soft modes beside stiff ones, (...)."""
    sizes = np.abs(np.linalg.eigvals(only(finite(stiffness), stiffness)))
    return sizes.min(-1) < UNEVEN * sizes.max(-1)


@np.errstate(all="ignore")  # numbers beyond the range of the floats give infinite rates, which are a status
def _other_points(q: Linear, kind: Kind, frames: bool) -> np.ndarray:
    """The same of any oscillators."""
    points = np.zeros(q.omega.shape, point_of(kind))
    contact = contact_coordinates(q)
    points["omega"], points["tau"] = q.omega, q.tau
    for name in ("P", "back", "origin", "turned", "stiffness", "damping", "force", "constrained", "push"):
        points[name] = getattr(contact, name)
    points["divergence"] = -np.trace(contact.damping, axis1=-2, axis2=-1)
    # without forces many move alike: those that differ in omega alone
    unlike, of = different(np.concatenate([_row(one) for one in (q.M, q.K, q.C, q.contact.normal, contact.P)], -1))
    points["rate"] = fastest_rate(contact.stiffness[unlike], contact.damping[unlike])[of]
    n = kind.masses
    held, damped = contact.constrained[unlike, 1:, 1:n], contact.constrained[unlike, 1:, n + 1 : 2 * n]
    points["constrained_rate"] = fastest_rate(-held, -damped)[of]
    far = np.isfinite(points["rate"]) & (points["rate"] > APART * q.omega)
    points["apart"] = far & (~is_own(q) | is_uneven(contact.stiffness))
    points["cells"] = cells.cells_for(np.maximum(points["rate"], q.omega), q.omega)
    for name, values in confinement_of(q, contact)._asdict().items():
        points["confining" if name == "form" else name] = values
    for i in np.flatnonzero(points["apart"]):
        _set_apart(points[i], selected(q, i), ContactCoordinates(*(one[i] for one in contact)))
    for i in np.flatnonzero(points["cells"] == cells.STIFF_CELLS):
        _set_exponentials(points[i], ContactCoordinates(*(one[i] for one in contact)))
    there = np.flatnonzero(points["cells"] > 0)
    if frames and len(there):
        unlike, of = np.unique(unlike[of[there]], return_inverse=True)
        some = ContactCoordinates(*(one[unlike] for one in contact))
        frame = frame_of(natural_coordinates(selected(q, unlike), some), q.omega[there], of)
        points["rounding"][there] = frame.rounding
        points["frame_eta"][there], points["frame_square"][there] = frame.eta, frame.square
        points["frame_scale"][there] = frame.scale
        points["to_frame"][there], points["from_frame"][there] = frame.to, frame.back
    return points


def _set_apart(point: np.void, q: Linear, contact: ContactCoordinates) -> None:
    """The motion of an oscillator whose rates lie apart, in twice the digits."""
    n = q.masses
    rounded, point["low"] = exact_motion(q, contact)
    point["stiffness"], point["damping"] = -rounded[:, :n], -rounded[:, n : 2 * n]
    point["force"] = rounded[:, 2 * n :]


def _set_exponentials(point: np.void, contact: ContactCoordinates) -> None:
    """The gap of a stiff oscillator as a sum of exponentials."""
    fast = WIDTH * point["omega"] * cells.STIFF_CELLS / (2 * np.pi)
    sums = gap_exponentials(contact, point["omega"], point["tau"], fast)
    point["valid"], point["begin"] = sums.valid, sums.begin
    point["root"], point["part"] = (np.stack([one.real, one.imag], -1) for one in (sums.roots, sums.parts))
