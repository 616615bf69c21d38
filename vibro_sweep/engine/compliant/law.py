"""What kernels know of compliant stops: the numbers of each, the equations of contact, and the contact of each orbit.

In contact the gap is g = stop + side delta, and the force F = m_e (k delta + c delta' + p) acts on it, with k = k_stop,
c = c_stop and p = preload, each over m_e = 1/(n M^-1 n). The other coordinates are w_j = q_j - p_j g: an impulse on the
gap leaves them alone, and so does F, so that of a soft motion beside a stiff contact no digit is lost:

    delta'' = -(k0 + k) delta - (c0 + c) delta' + (coupling to w, force, what k0 does at the stop) - p

Lanes of stops: 0 left, 1 right, as in the records of orbits.
"""

from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.compliant.passage_tables import passages_of, set_passage
from vibro_sweep.engine.compliant.relaxing import bring_stops
from vibro_sweep.engine.compliant.slow_manifold import slow_manifold_fields
from vibro_sweep.engine.compliant.stop_laws import law_fields, set_law_of_stop
from vibro_sweep.engine.compliant.vectors_set_apart import vectors_fields
from vibro_sweep.engine.motion.distance import NEAR
from vibro_sweep.engine.records import Kind
from vibro_sweep.engine.simd.jit import inline, jit
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.simd.memory import new_lines, record
from vibro_sweep.engine.tables.flight import ORDER, WIDTH

LOGGED = 11  # numbers in a row of the log


class Law(NamedTuple):
    """The compliant stops of eight orbits. Where all stops are rigid there is None in its place, and nothing of it is
    compiled."""

    orbits: np.ndarray  # (LANES,) `law_of`
    # (LANES, m, LOGGED): period, cell and offset of touch and of release (NaN where there is none yet), side, speed
    # into the stop at both, largest delta, and largest force
    log: np.ndarray
    passage: np.ndarray  # (1,) `passages_of`
    halt: np.ndarray  # that of the ensemble


def law_of(masses: int) -> np.dtype:
    """The record of the stops of one orbit, and of the contact that it is in."""
    states = 2 * masses
    fields = [
        ("compliant", np.int64, 2),
        ("stiffness", float, 2),  # k, c and p
        ("damping", float, 2),
        ("preload", float, 2),
        *law_fields(),
        ("mass", float),  # m_e
        ("trace", float, 2),  # the rate at which volumes change without the stop's damping
        ("equations", float, (2, masses, states + 3)),  # (delta'', w2'', ..) by (delta, delta', w2, .., sin, cos, 1)
        ("step", float, 2),  # of Taylor series in contact; in single precision, so that sums of thousands are exact
        ("push", float, (masses,)),  # p_j
        # of the contact
        ("pressed", float),  # the side of the stop that it is with, or 0
        ("entered", np.bool_),  # whether this is its beginning, where delta is zero, as are its derivatives
        ("least", np.int64),  # below this order
        ("ended_by", np.int64),  # the guard that ended it
        ("y", float, (states,)),  # delta, delta', w2, w2', ..., and
        ("low", float, (states,)),  # what rounding leaves of them
        ("form", float, (ORDER,)),  # Taylor coefficients of a linear form of (delta, delta', 1)
        ("steps", np.int64),  # series in this cell
        ("ending", np.bool_),  # whether its end is near, of a slow motion (slow_contact.py)
        ("uncarried", float),  # time that tangent vectors have not been carried over
        # of flights (distance.py)
        ("near", float, 2),  # how near to each stop, and how slow in a cell, one is that needs all digits of the gap
        ("close_until", np.int64),  # until which cell since t = 0: a period after the last release
        # of stops that relax
        ("relaxed", float, 2),  # s: how far the massless stop is from where it is relaxed; and where it was left
        ("left", float, 2),
        ("cell", np.int64, 2),  # when: cells since t = 0, and
        ("offset", float, 2),
        ("touched_last", np.int64),  # which of the stops
        ("unit", float, 2),  # of the places of stops that relax at the section (section_vectors.py)
        # of tangent vectors: entries of the matrix of a contact, by (delta, delta' + c delta, w2, ..)
        ("matrix", float, (states, states)),
        ("terms", float, (2, states)),
        ("before", float, (states,)),
        ("after", float, (states,)),
        ("begun", np.int64),  # how they come in (tangent_in_contact.py)
        ("touched", float),  # delta' at the touch
        ("acceleration", float),  # delta'' at the end
        ("decay", float),  # of what a vector does to a stop that relaxes, since it was left
        ("touch", float, (states, states)),  # R, and
        ("vectors", float, (states, states)),  # Q of the touch of a stop that relaxes
        # of the contact where it lasts
        *slow_manifold_fields(masses),
        *vectors_fields(masses),
        # of what is recorded
        ("watched", np.bool_),  # whether the peaks are wanted
        ("largest", float),  # delta so far in this contact
        ("strongest", float),  # F/m_e
        ("row", np.int64),  # of the log, of the contact that goes on; -1 where there is no room
        ("logged", np.int64),
        ("contacts", np.int64, 2),
        ("counted", np.int64, 2),  # of the orbit itself while another is followed beside it
        ("time", float),  # in contact
        ("work", float),  # of F/m_e on the masses that press the stop
        ("peak", float),  # delta
        ("peak_force", float),
        ("restitutions", float),  # sum of -v_release/v_touch, and
        ("ended", np.int64),  # of how many contacts
    ]
    return record(fields)


def new_law(kind: Kind, halt: np.ndarray, room: int = 0) -> Law | None:
    """None where all stops are rigid."""
    if not kind.compliant:
        return None
    passage = new_lines(1, passages_of(kind.masses, kind.constant))
    return Law(new_lines(LANES, law_of(kind.masses)), np.empty((LANES, room, LOGGED)), passage, halt)


@jit
def set_law(law, i, point, q):
    """Give orbit i of the oscillator q its stops."""
    contact, masses, width = law.orbits[i], len(point.push), q.width
    contact.mass = point.contact_mass
    for m in range(masses):
        contact.push[m] = point.push[m]
    for n in range(2):
        set_law_of_stop(contact, n, point.contact_law[n], point.release)
        contact.compliant[n] = int(contact.stiffness[n] > 0.0)
        step = min(width, WIDTH / point.contact_rate[n]) if contact.compliant[n] else width
        contact.step[n] = np.float32(step)
        contact.relaxed[n] = 0.0
        contact.near[n] = NEAR * (abs(point.stops[n]) + q.largest) if contact.compliant[n] else 0.0
        contact.trace[n] = fill_equations(contact.equations[n], contact.force[n], point, 2.0 * n - 1.0, n)
    contact.pressed, contact.entered, contact.watched, contact.row = 0.0, False, False, -1
    for part in range(len(contact.apart)):
        contact.apart[part] = 0
    contact.close_until, contact.touched_last = -1, 0
    set_passage(law.passage[0], i, contact, point, q)


@jit
def fill_equations(G, force, point, side, n):
    """The equations of contact with one stop. Returns the rate at which all but its damping changes volumes."""
    p, S, D, f = point.push, point.stiffness, point.damping, point.force
    masses, states, wall = len(p), 2 * len(p), point.stops[n]
    k0, c0 = 0.0, 0.0
    for j in range(masses):
        k0 += S[0, j] * p[j]
        c0 += D[0, j] * p[j]
    for i in range(masses):
        k, c = 0.0, 0.0
        for j in range(masses):
            k += S[i, j] * p[j]
            c += D[i, j] * p[j]
        # of row i >= 1 what the gap's own row does is taken off
        share, turned = (p[i], 1.0) if i > 0 else (0.0, side)
        k, c = k - share * k0, c - share * c0
        G[i, 0], G[i, 1] = (-side * k, -side * c) if i > 0 else (-k, -c)
        for j in range(1, masses):
            G[i, 2 * j] = -turned * (S[i, j] - share * S[0, j])
            G[i, 2 * j + 1] = -turned * (D[i, j] - share * D[0, j])
        for j in range(3):
            G[i, states + j] = turned * (f[i, j] - share * f[0, j])
        G[i, states + 2] -= turned * k * wall
    trace = 0.0
    for m in range(masses):
        trace += G[m, 2 * m + 1]
    G[0, 0] -= force[0]
    G[0, 1] -= force[1]
    G[0, states + 2] -= force[2]
    return trace


@inline
def relax_from(law, i, places, cell, offset):
    """None of the stops of orbit i is pressed; from these places, at this offset of this cell, they relax."""
    if law is not None:
        contact = law.orbits[i]
        contact.pressed = 0.0
        for n in range(2):
            contact.relaxed[n] = contact.left[n] = places[n]
            contact.cell[n], contact.offset[n] = cell, offset


@inline
def begin_beside(law, o, width):
    """Another orbit is followed from beside this one: nothing is pressed, and stops relax from where they are.

    width: of a cell.
    """
    if law is not None:
        contact = law.orbits[o.lane]
        contact.counted[0], contact.counted[1] = contact.contacts[0], contact.contacts[1]
        bring_stops(contact, o, 0, 0.0, width)
        contact.pressed, contact.close_until = 0.0, -1
        for n in range(2):
            contact.cell[n], contact.offset[n] = 0, 0.0


@inline
def end_beside(law, i):
    """The contacts of orbit i are again those of the orbit itself."""
    if law is not None:
        contact = law.orbits[i]
        contact.contacts[0], contact.contacts[1] = contact.counted[0], contact.counted[1]


@inline
def contacts_of(law, i):
    """The contacts of orbit i that are counted."""
    if law is not None:
        return law.orbits[i].contacts[0] + law.orbits[i].contacts[1]
    return 0


@inline
def count_contacts_anew(law, i):
    """Count the contacts of orbit i from here on."""
    if law is not None:
        law.orbits[i].contacts[0] = law.orbits[i].contacts[1] = 0


@inline
def keep_between(law, i, state, stops):
    """Put a state that is behind a rigid stop on it."""
    if law is not None:
        contact = law.orbits[i]
        left, right = -np.inf if contact.compliant[0] else stops.left, np.inf if contact.compliant[1] else stops.right
        state[0] = min(max(state[0], left), right)
    else:
        state[0] = min(max(state[0], stops.left), stops.right)


@inline
def is_at_rest(law, o):
    """Whether a stop holds the mass: not whether the mass presses in a compliant one."""
    if law is not None:
        return o.resting != 0.0 and law.orbits[o.lane].pressed == 0.0
    return o.resting != 0.0


@inline
def is_pressed(law, o):
    """Whether the orbit is in contact with a compliant stop."""
    if law is not None:
        return law.orbits[o.lane].pressed != 0.0
    return False


@inline
def is_compliant(law, o, side):
    """Whether the stop on `side` is."""
    if law is not None:
        return law.orbits[o.lane].compliant[lane_of(side)] != 0
    return False


@jit
def lane_of(side):
    """Place of the stop on this side."""
    return 1 if side > 0.0 else 0


@jit
def clear_contacts(contact, watched):
    """Count contacts from here on; watched: and watch their peaks."""
    contact.watched = watched
    contact.contacts[0] = contact.contacts[1] = contact.ended = 0
    contact.time = contact.work = contact.restitutions = 0.0
    contact.peak = contact.peak_force = contact.largest = contact.strongest = -np.inf
