"""What is known of the compliant stops of eight orbits, and of the contacts that they pass side by side."""

import numpy as np

from vibro_sweep.engine.compliant.contact_pieces import piece_fields, set_pieces
from vibro_sweep.engine.compliant.stop_laws import relaxes
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.simd.memory import record
from vibro_sweep.engine.tables import economy
from vibro_sweep.engine.tables.economy import TO_TERMS, economise
from vibro_sweep.engine.tables.flight import inputs_of, width_of


def passages_of(masses: int, constant: bool = False) -> np.dtype:
    """The record of eight orbits that may pass through a contact, one column each; pairs are of the left stop and the
    right one."""
    states, inputs, width = 2 * masses, inputs_of(masses, constant), width_of(masses, constant)
    fields = [
        # of the oscillator and its stops
        ("series", float, ((masses - 1) * inputs * economy.TERMS, LANES)),  # of x2, ... in free flight, economised
        ("compliant", float, (2, LANES)),  # 1: compliant, 0: rigid
        ("stiffness", float, (2, LANES)),  # k
        ("damping", float, (2, LANES)),  # c
        ("preload", float, (2, LANES)),  # p
        ("by_force", float, (2, LANES)),  # 1: contacts end where the force is zero
        ("trace", float, (2, LANES)),  # the rate of volumes without the stop's damping
        ("push", float, (masses, LANES)),  # p_j
        ("omega", float, (LANES,)),
        # of the cell in which the stop is touched
        ("finer", float, (LANES,)),  # what x1 has beside its float there; then, at the end of the cell of the release
        ("close", float, (LANES,)),  # 1: the next state, too, needs all digits of the gap (distance.py)
        ("ahead", float, (LANES,)),  # cells from its beginning to the section, and
        ("last", float, (LANES,)),  # to where a contact may last at most
        # of the contact
        ("y", float, (states, LANES)),  # delta, delta', w2, w2', ...
        ("section", float, (states, LANES)),  # y at a section that is passed in contact;
        ("landing", float, (states, LANES)),  # the state x1, v1, ... there, and
        ("X", float, (LANES, width)),  # the same, one row for each orbit
        ("release", float, (inputs, LANES)),  # the state at the release, with sin, cos, 1
        ("speed", float, (LANES,)),  # delta' at the touch, and
        ("speed_after", float, (LANES,)),  # at the release
        ("place", float, (LANES,)),  # delta at the release
        ("time", float, (LANES,)),  # from touch to release, and
        ("rest", float, (LANES,)),  # from there to the end of the cell
        ("crossed", float, (LANES,)),  # cells between the one of the touch and the one of the release
        ("vector", float, (states, LANES)),  # a tangent vector on its way
        *piece_fields(masses),
        # of what is recorded
        ("watched", np.bool_),  # whether the peaks are wanted
        ("largest", float, (LANES,)),  # delta in this contact, and
        ("strongest", float, (LANES,)),  # F/m_e
        # of all contacts since `clear_passed` (passed_contacts.py)
        ("passed", float, (2, LANES)),  # on the left and on the right
        ("pressed_time", float, (LANES,)),
        ("restitutions", float, (LANES,)),  # sum of -v_release/v_touch
        ("peak", float, (LANES,)),  # delta, and
        ("peak_force", float, (LANES,)),  # F/m_e
    ]
    return record(fields)


@jit
def set_passage(passage, i, contact, point, q):
    """Give orbit i its stops."""
    masses, inputs = len(contact.push), len(q.force)
    passage.omega[i] = q.omega
    for m in range(masses):
        passage.push[m, i] = contact.push[m]
        for j in range(inputs if m > 0 else 0):
            economise(TO_TERMS, q, q.series[m, j], passage.series[:], ((m - 1) * inputs + j) * economy.TERMS, i)
    for n in range(2):
        passage.compliant[n, i] = contact.compliant[n]
        passage.stiffness[n, i], passage.damping[n, i] = contact.stiffness[n], contact.damping[n]
        passage.preload[n, i], passage.trace[n, i] = contact.preload[n], contact.trace[n]
        passage.by_force[n, i] = 1.0 if relaxes(contact, n) else 0.0
    set_pieces(passage, i, contact, point.contact_rate, q.omega)
