"""Contacts of eight orbits at once: what is known of their stops, and how long a contact lasts about.

With K = k0 + k and 2 gamma = c0 + c of the row of delta (law.py), and the flight g from a unit velocity on the stop,

    g = e^{-gamma u} sin(kd u)/kd,   kd^2 = K - gamma^2,   P = (1 - g' - 2 gamma g)/K

(P: from a unit acceleration), a contact begun at the speed V in which the acceleration a stays what it is at the touch
ends where V h(u) + a H(u) + r = 0, with

    h = g, H = P, r = 0                           where delta is zero again
    h = k g + c g', H = k P + c g, r = p          where the force is

Without a and r that is at a time `duration` which V does not change; they move it, and the first guess is

    duration (1 + (2/pi) arctan y),   y = (lean a + pull)/V,   arctan y = y (15 + 4 y^2)/(15 + 9 y^2) for |y| < 1
"""

import math

import numpy as np

from vibro_sweep.engine.compliant.closed_tables import SLOW, closed_fields, set_closed_form
from vibro_sweep.engine.simd.jit import jit
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.engine.simd.memory import record
from vibro_sweep.engine.tables import economy
from vibro_sweep.engine.tables.economy import TO_TERMS, economise
from vibro_sweep.engine.tables.flight import decaying, inputs_of, width_of

TERMS = 22  # of a series in contact
REACH = 1.6  # rate * time that one serves: the first term left out is below 3e-17
NEARLY = 1.15  # of `duration`, or its inverse: the contacts whose end `firm` is good for
TAKEN = 0.77  # the part of a contact in which delta > 0 follows from P/g, in its rest from g' (`firm_of`)


def passages_of(masses: int, constant: bool = False) -> np.dtype:
    """The record of eight orbits that may pass through a contact, one column each; pairs are of the left stop and the
    right one."""
    states, inputs, width = 2 * masses, inputs_of(masses, constant), width_of(masses, constant)
    fields = [
        # of the oscillator and its stops
        ("series", float, ((masses - 1) * inputs * economy.TERMS, LANES)),  # of x2, ... in free flight, economised
        ("equations", float, (2 * masses * (states + 3), LANES)),  # as of `law_of`
        ("compliant", float, (2, LANES)),  # 1: compliant, 0: rigid
        ("ends", float, (2, LANES)),  # 1: contacts end by themselves, and are passed here
        ("stiffness", float, (2, LANES)),  # k
        ("damping", float, (2, LANES)),  # c
        ("preload", float, (2, LANES)),  # p
        ("by_force", float, (2, LANES)),  # 1: contacts end where the force is zero
        ("duration", float, (2, LANES)),
        ("lean", float, (2, LANES)),
        ("pull", float, (2, LANES)),
        ("half_turn", float, (2, LANES)),  # pi/kd
        ("firm", float, (2, LANES)),  # the acceleration, for V = 1, below which a contact has one end for certain
        ("rate", float, (2, LANES)),  # the fastest in contact
        ("trace", float, (2, LANES)),  # the rate of volumes without the stop's damping
        ("push", float, (masses, LANES)),  # p_j
        ("omega", float, (LANES,)),
        # of the cell in which the stop is touched
        ("finer", float, (LANES,)),  # what x1 has beside its float there; then, at the end of the cell of the release
        ("close", float, (LANES,)),  # 1: the next state, too, needs all digits of the gap (distance.py)
        ("ahead", float, (LANES,)),  # cells from its beginning to the section, and
        ("last", float, (LANES,)),  # to where a contact may last at most
        # of the contact
        ("row", float, (masses * (states + 3), LANES)),  # the equations of the stop that is touched
        ("x", float, (masses * TERMS, LANES)),  # Taylor coefficients of delta, w2, ..., and
        ("v", float, (masses * TERMS, LANES)),  # of their velocities
        ("drive", float, (TERMS, LANES)),  # of delta'' + 2 gamma delta' + K delta = a
        ("end", float, (TERMS, LANES)),  # of what is zero at the end
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
        ("parts", float, (LANES,)),  # series that this time takes
        ("crossed", float, (LANES,)),  # cells between the one of the touch and the one of the release
        ("vector", float, (states, LANES)),  # a tangent vector on its way
        *closed_fields(masses),
        # of what is recorded
        ("watched", np.bool_),  # whether the peaks are wanted
        ("force", float, (TERMS, LANES)),  # the series of F/m_e
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
    masses, states, inputs = len(contact.push), len(contact.y), len(q.force)
    passage.omega[i], power = q.omega, 1.0
    for n in range(SLOW):
        passage.powers[n, i] = power
        power *= q.omega / (n + 1.0)
    for m in range(masses):
        passage.push[m, i] = contact.push[m]
        for j in range(inputs if m > 0 else 0):
            economise(TO_TERMS, q, q.series[m, j], passage.series[:], ((m - 1) * inputs + j) * economy.TERMS, i)
    for n in range(2):
        for m in range(masses):
            for j in range(states + 3):
                passage.equations[(n * masses + m) * (states + 3) + j, i] = contact.equations[n, m, j]
        passage.compliant[n, i] = contact.compliant[n]
        passage.stiffness[n, i], passage.damping[n, i] = contact.stiffness[n], contact.damping[n]
        passage.preload[n, i], passage.rate[n, i] = contact.preload[n], point.contact_rate[n]
        passage.by_force[n, i] = 1.0 if contact.by_force and contact.damping[n] > 0.0 else 0.0
        passage.trace[n, i] = contact.trace[n]
        set_duration(passage, n, i, -contact.equations[n, 0, 0], -0.5 * contact.equations[n, 0, 1])
        set_closed_form(passage, n, i, contact, q.omega)


@jit
def set_duration(passage, n, i, K, gamma):
    """How long contacts with stop n of orbit i last about."""
    k, c, by_force = passage.stiffness[n, i], passage.damping[n, i], passage.by_force[n, i] > 0.0
    kd, half_turn, duration = math.sqrt(max(K - gamma * gamma, 0.0)), np.inf, 0.0
    if kd > 0.0:
        half_turn = math.pi / kd
        duration = (math.pi - math.atan2(c * kd, k - c * gamma)) / kd if by_force else half_turn
    elif by_force and 0.0 < K < gamma * gamma:
        root = math.sqrt(gamma * gamma - K)  # half the difference of the rates, gamma + root and K/(gamma + root)
        fast, slow = k - c * (gamma + root), k - c * (K / (gamma + root))
        duration = math.log(fast / slow) / (2.0 * root) if fast < slow < 0.0 else 0.0
    passage.ends[n, i] = 1.0 if passage.compliant[n, i] > 0.0 and duration > 0.0 else 0.0
    if passage.ends[n, i] == 0.0:
        return
    _, g, _, slope = decaying(gamma, K, duration)
    P = (1.0 - slope - 2.0 * gamma * g) / K
    if by_force:
        fall, H, r = k * slope - c * (K * g + 2.0 * gamma * slope), k * P + c * g, passage.preload[n, i]
    else:
        fall, H, r = slope, P, 0.0
    share = -0.5 * math.pi / (duration * fall)
    passage.duration[n, i], passage.half_turn[n, i] = duration, half_turn
    passage.lean[n, i], passage.pull[n, i] = share * H, share * r
    passage.firm[n, i] = 0.0 if by_force else firm_of(kd, gamma)


@jit
def firm_of(kd, gamma):
    """The least |a| for V = 1 from which the one end of a contact is not certain by its size alone; 0: nothing is.

    delta = V g + (g * a) with |g * a| <= |a| P, and P/g rises, so delta > 0 up to a time m where V g(m) > |a| P(m).
    After it delta' = V g' + (g' * a) < 0 where V |g'| > |a| (total variation of g). With theta = kd u, E =
    e^{-gamma u} at the latest end, sin theta E/kd <= g and P <= (1 - cos theta)/kd^2; m is TAKEN of the contact, whose
    theta is between pi/NEARLY and NEARLY pi.
    """
    if not gamma <= kd:
        return 0.0
    early, late, end = TAKEN * math.pi / NEARLY, TAKEN * NEARLY * math.pi, NEARLY * math.pi
    E = math.exp(-gamma * end / kd)
    first = math.tan(0.5 * late)
    steepest = min(-math.cos(early), -math.cos(end) + gamma / kd * math.sin(end))
    second = (2.0 - math.sin(end)) / steepest
    return kd * E / max(first, second)
