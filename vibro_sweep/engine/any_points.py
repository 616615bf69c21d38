"""Any linear oscillators as points of the kernels, in contact coordinates; each different one is worked out once."""

from collections.abc import Iterable

import numpy as np

from vibro_sweep.engine.records import Kind, point_of
from vibro_sweep.engine.tables import cells
from vibro_sweep.engine.tables.flight import WIDTH
from vibro_sweep.model.confinement import confinement_of
from vibro_sweep.model.contact import (
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
from vibro_sweep.model.exact import exact_motion
from vibro_sweep.model.exponentials import gap_exponentials
from vibro_sweep.model.frame import frame_of
from vibro_sweep.model.linear import Linear, gap_response, remembered
from vibro_sweep.model.sensitivity import grazing_state

MOTION = ("M", "K", "C", "normal", "sine", "cosine", "constant", "omega", "tau", "middle")  # all but the stops and R
APART = 8.0  # a rate over that of the force from which on tables are computed in twice the digits


def kind_of(linears: Iterable[Linear]) -> Kind:
    """The kind for which kernels must be compiled: oscillators with the same number of masses."""
    linears = list(linears)
    constant = any(np.any(q.constant) or np.any(origin_of(q)) for q in linears)
    compliant = any(q.compliant for q in linears)
    return Kind(len(linears[0].normal), constant, False, all(is_own(q) for q in linears), compliant)


def any_points(linears: np.ndarray, kind: Kind, frames: bool = True) -> np.ndarray:
    """Points of an array of oscillators (`Linear`, tau resolved). frames: whether tangent vectors are wanted."""
    known, result = {}, np.zeros(linears.shape, point_of(kind))
    for place in np.ndindex(linears.shape):
        q = linears[place]
        key = b"".join(np.asarray(getattr(q, name), float).tobytes() for name in MOTION)
        if key not in known:
            known[key] = _point(q, kind, frames)
        result[place] = known[key]
        low, high = (distance(q, known[key]["origin"], gap) for gap in (q.low, q.high))
        result[place]["stops"] = low, high, q.R_low, q.R_high
        if kind.compliant:
            _set_contact(result[place], q)
    return result


def _set_contact(point: np.void, q: Linear) -> None:
    """The compliant stops of a point, over m_e = 1/(n M^-1 n), and the fastest rate in contact with each."""
    mass = 1 / float(q.normal @ by_mass(q.M, q.normal[:, None])[:, 0])
    point["contact_mass"], point["by_force"] = mass, q.by_force
    pairs = ("contact_stiffness", q.k_low, q.k_high), ("contact_damping", q.c_low, q.c_high)
    for name, low, high in (*pairs, ("contact_preload", q.p_low, q.p_high)):
        point[name] = low / mass, high / mass
    for n in range(2):
        stiffness, damping = point["stiffness"].copy(), point["damping"].copy()
        stiffness[:, 0] += point["push"] * point["contact_stiffness"][n]
        damping[:, 0] += point["push"] * point["contact_damping"][n]
        point["contact_rate"][n] = max(fastest_rate(stiffness, damping), q.omega)


def grazing_points(linears: np.ndarray, expand_at: float | None) -> np.ndarray:
    """X* at the right stop (..., 2 N), in contact coordinates; NaN where no steady motion grazes.

    expand_at : the gap there, in place of the exact one
    """
    result = np.full((*linears.shape, 2 * len(linears.flat[0].normal)), np.nan)
    for place in np.ndindex(linears.shape):
        q = linears[place]
        if gap_response(q):
            state = np.kron(coordinates(q.normal, least_restrained(q))[0], np.eye(2)) @ grazing_state(q)
            state[0] = state[0] if expand_at is None else expand_at
            result[place] = state
    return result


@remembered(*MOTION, most=2048)  # a live page asks for the same points again while a stop or R moves
def _point(q: Linear, kind: Kind, frames: bool) -> np.void:
    point = np.zeros((), point_of(kind))
    contact = contact_coordinates(q)
    point["omega"], point["tau"] = q.omega, q.tau
    point["P"], point["back"], point["origin"], point["turned"] = (
        contact.P,
        contact.back,
        contact.origin,
        contact.turned,
    )
    point["stiffness"], point["damping"], point["force"] = contact.stiffness, contact.damping, contact.force
    point["constrained"], point["push"] = contact.constrained, contact.push
    point["divergence"] = -np.trace(contact.damping)
    point["rate"] = fastest_rate(contact.stiffness, contact.damping)
    n = len(contact.push)
    point["constrained_rate"] = fastest_rate(-contact.constrained[1:, 1:n], -contact.constrained[1:, n + 1 : 2 * n])
    point["apart"] = not is_own(q) and np.isfinite(point["rate"]) and point["rate"] > APART * q.omega
    if point["apart"]:
        rounded, point["low"] = exact_motion(q, contact)
        point["stiffness"], point["damping"], point["force"] = (
            -rounded[:, :n],
            -rounded[:, n : 2 * n],
            rounded[:, 2 * n :],
        )
    point["cells"] = cells.cells_for(np.maximum(point["rate"], q.omega), q.omega)
    point["steady"], point["middle"], point["swing"], point["confining"] = confinement_of(q, contact)
    if point["cells"] == cells.STIFF_CELLS:
        sums = gap_exponentials(contact, q.omega, q.tau, WIDTH * q.omega * cells.STIFF_CELLS / (2 * np.pi))
        point["valid"], point["begin"] = sums.valid, sums.begin
        point["root"], point["part"] = (np.stack([one.real, one.imag], -1) for one in (sums.roots, sums.parts))
    if frames and point["cells"] > 0:
        frame = frame_of(natural_coordinates(q, contact), q.omega)
        point["rounding"] = frame.rounding
        point["frame_eta"], point["frame_square"], point["frame_scale"] = frame.eta, frame.square, frame.scale
        point["to_frame"], point["from_frame"] = frame.to, frame.back
    return point[()]
