"""Guesses of orbits with contacts, from those of the same machine with rigid stops.

A contact of a free mass with the frequency sqrt(K) and the damping ratio z on its stop takes half a period, and its
restitution is exp(-pi z/sqrt(1 - z^2)); with a release by force pi is less by 2 arcsin z. Where the stop is so soft
that this leads nowhere, it is made softer from orbit to orbit.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from vibro_sweep.analysis.periodic.contact_numbers import one_plus_R
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.engine.impulses.flow import contact_coordinates
from vibro_sweep.oscillator.family import Family
from vibro_sweep.oscillator.linear import Linear

MOST_DAMPED = 0.95  # of z, beyond which a contact of a free mass is as long as with this
STIFFER = 1e4, 1e2, 1.0  # times the stiffness, at the same z


def of_free_mass(q: Linear, side: int) -> tuple[float, float]:
    """Restitution and duration of a contact of a free mass with a compliant stop."""
    push = contact_coordinates(q).by_force[0] @ q.contact.normal  # 1/m_e
    law = q.contact.law(side)
    rate = math.sqrt(law.k * push)
    z = min(law.c * push / (2 * rate), MOST_DAMPED)
    root, turned = math.sqrt(1 - z * z), math.pi - (2 * math.asin(z) if q.contact.by_force else 0.0)
    return math.exp(-turned * z / root), turned / (rate * root)


def rigid(family: Family) -> Family:
    """The same machine with rigid stops, of the restitution that a free mass sees."""
    q = family.linear
    one, none = q.contact, {f"{name}_{side}": 0.0 for name in "kcp" for side in ("low", "high")}
    R = [of_free_mass(q, side)[0] if one.is_compliant(side) else float(one.restitution(side)) for side in (-1, 1)]
    hard = q.with_contact(R_low=R[0], R_high=R[1], **none)
    return Family(lambda: hard, {})


def stiffer(q: Linear, times: float) -> Linear:
    """With stops that are stiffer, at the same damping ratio."""
    one, root = q.contact, math.sqrt(times)
    return q.with_contact(
        k_low=one.k_low * times, k_high=one.k_high * times, c_low=one.c_low * root, c_high=one.c_high * root,
    )  # fmt: skip


def with_contacts(family: Family, solution: Solution, t, speeds) -> Solution:
    """A guess with impacts or contacts at these times, with these gap velocities before them."""
    q, sides, there = family.linear, np.array(solution.sides, int), replace(solution, family=family)
    lengths = {side: of_free_mass(q, side)[1] if q.contact.is_compliant(side) else np.nan for side in (1, -1)}
    ends = t + np.array([lengths[side] for side in sides.tolist()])
    return there.with_events(sides, t, -one_plus_R(q, sides) * speeds, ends)


def softened(family: Family, found: Solution) -> Solution | None:
    """The orbit of the family from one with rigid stops."""
    speeds, one = -found.jumps / one_plus_R(found.family.linear, found.sides), None
    for times in STIFFER:
        there = stiffer(family.linear, times)
        at = family if times == 1.0 else Family(lambda there=there: there, {})
        guess = with_contacts(at, found, found.times, speeds) if one is None else replace(one, family=at)
        if one is not None:
            longer = guess.ends - guess.times[list(guess.rests)]
            ends = guess.times[list(guess.rests)] + 10 * longer
            guess = replace(guess, u=np.concatenate([guess.times, guess.jumps, ends]))
        one = guess.corrected()
        if one is None:
            return None
    return one


def contact_seeds(
    start: Solution, seeded: Callable[[Solution], Iterator[Solution | None]]
) -> Iterator[Solution | None]:
    """Orbits with these contacts, from those with rigid stops that are found from fixed seeds; None as of `seeded`."""
    for found in seeded(replace(start, family=rigid(start.family))):
        one = None if found is None else softened(start.family, found)
        if found is None or one is not None:
            yield one
