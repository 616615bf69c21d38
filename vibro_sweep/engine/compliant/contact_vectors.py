"""Tangent vectors in the coordinates of a contact: (delta, delta', w2, w2', ..), of law.py."""

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.variational.tangent_at_rest import motion_in


@jit
def set_before(t, i, contact, side, j):
    """Vector j as (delta, delta', w2, ..)."""
    for m in range(len(contact.push)):
        contact.before[2 * m], contact.before[2 * m + 1] = motion_in(t, i, m, j)
    to_contact(contact, side, contact.before)


@jit
def put_after(t, i, contact, side, j):
    """Vector j becomes the one that is (delta, delta', w2, ..) in `after`."""
    Z, to, after, size = t.Z, t.to_frame, contact.after, len(t.growth)
    from_contact(contact, side, after)
    for m in range(size):
        z = 0.0
        for a in range(size):
            z += to[size * m + a, i] * after[a]
        Z[size * m + j, i] = z


@jit
def to_contact(contact, side, x):
    """(q1, q1', q2, ..) as (delta, delta', w2, ..)."""
    for m in range(1, len(contact.push)):
        x[2 * m] -= contact.push[m] * x[0]
        x[2 * m + 1] -= contact.push[m] * x[1]
    x[0], x[1] = side * x[0], side * x[1]


@jit
def from_contact(contact, side, x):
    """(delta, delta', w2, ..) as (q1, q1', q2, ..)."""
    x[0], x[1] = side * x[0], side * x[1]
    for m in range(1, len(contact.push)):
        x[2 * m] += contact.push[m] * x[0]
        x[2 * m + 1] += contact.push[m] * x[1]
