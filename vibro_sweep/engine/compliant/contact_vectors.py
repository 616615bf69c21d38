"""Tangent vectors in the coordinates of a contact: (delta, delta', w2, w2', ..), of law.py."""

from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.variational.mapped import put_vector, vector_of


@jit
def set_before(t, i, contact, side, j):
    """Vector j as (delta, delta', w2, ..)."""
    vector_of(t, i, j, contact.before)
    to_contact(contact, side, contact.before)


@jit
def put_after(t, i, contact, side, j):
    """Vector j becomes the one that is (delta, delta', w2, ..) in `after`."""
    from_contact(contact, side, contact.after)
    put_vector(t, i, j, contact.after)


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
