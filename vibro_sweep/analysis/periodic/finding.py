"""`periodic_orbit`: finds an orbit by Newton's method, whether it attracts or repels.

The unknowns are the times and impulses of the impacts, so that nothing is singular at a graze.
"""

from itertools import pairwise

import numpy as np

from vibro_sweep.analysis.periodic.contact_numbers import presses_too_long
from vibro_sweep.analysis.periodic.from_itinerary import from_itinerary
from vibro_sweep.analysis.periodic.from_state import from_guess, from_state
from vibro_sweep.analysis.periodic.itinerary import SIDES, word
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.analysis.single.orbit import simulate
from vibro_sweep.checks.arguments import checked_count, names_its_arguments
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.real import array_of
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.engine.impulses.free_modes import ResonanceError, TooStiffError, without_orbit
from vibro_sweep.oscillator.family import family_of
from vibro_sweep.tables.coordinates import checked_state

MOST_PERIODS = 10**6
FROM_REST = 1000  # periods before a state is taken where none is given
MOST_IMPACTS = 1000  # of an itinerary: each has thousands of seeds


@names_its_arguments
def periodic_orbit(
    system, state=None, periods: int = 1, itinerary: str | None = None, guess=None, which: int = 0
) -> PeriodicOrbit:
    """Find a periodic orbit by Newton's method on its impact times and impulses.

    Parameters
    ----------
    state : near the orbit at t = 0 mod T: the orbit simulated from here over `periods` gives the impacts to start from;
        by default where an orbit from rest is after 1000 periods
    periods : its period in forcing periods, or a multiple of it
    itinerary : the stops it hits, such as "LR", instead of a state; "" for the orbit without impacts
    guess : [(t, side, v), ...] with it or without: impacts of the whole orbit in order, from any one of them, v the gap
        velocity before.
        Without a guess fixed seeds are tried; the first real orbit with this itinerary counts. With compliant stops a
        few simulations are tried last.

    which : of several orbits with the itinerary, in the order in which seeds lead to them; `.others` says of such

    Raises ValueError for arguments that say nothing or contradict each other. `.status` says what fails.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> orbit = vs.periodic_orbit(system, itinerary="R")
    >>> orbit.status, orbit.period, orbit.stable, round(float(abs(orbit.multipliers[0])), 6)
    ('ok', 1, True, 0.903327)
    """
    family = family_of(system)
    periods = checked_count("periods", periods, 1, MOST_PERIODS)
    which = checked_count("which", which, 0, MOST_IMPACTS)
    if which and (itinerary is None or guess is not None):
        raise ArgumentError(not_allowed("which", which, "0 where no itinerary is given, or a guess"))
    sides = None if itinerary is None else _checked_sides(family.linear, itinerary)
    rows = None if guess is None else _checked_guess(family.linear, guess, itinerary)
    if state is not None:
        state = checked_state(state, family.linear.masses)
        if not (sides is None and rows is None):
            raise ArgumentError(not_allowed("state", state, "left out where an itinerary or a guess is given"))
    elif sides is None and rows is None:
        orbit = simulate(system, None, FROM_REST)
        if orbit.status != "ok":
            raise ArgumentError(not_allowed("state", state, f"given, as an orbit from rest ends with {orbit.status!r}"))
        state = orbit.section[-1]
    elif rows is None and len(sides) > MOST_IMPACTS:
        raise ArgumentError(not_allowed("itinerary", itinerary, f"of at most {MOST_IMPACTS} impacts without a guess"))
    try:
        if state is not None:
            found = from_state(system, family, state, periods)
        elif rows is not None:
            found = from_guess(system, family, rows, periods)
        else:
            found = from_itinerary(system, family, sides, periods, which)
    except ResonanceError:
        return PeriodicOrbit(system, without_orbit(family.linear))
    except TooStiffError:
        return PeriodicOrbit(system, "too_stiff")
    too_stiff = found.status == "not_converged" and presses_too_long(family.linear)
    return PeriodicOrbit(system, "too_stiff") if too_stiff else found


def _checked_sides(q, itinerary) -> tuple[int, ...]:
    if not isinstance(itinerary, str) or set(itinerary) - set(SIDES):
        raise ArgumentError(not_allowed("itinerary", itinerary, "a word of R and L"))
    sides = tuple(SIDES[letter] for letter in itinerary)
    if not np.all(np.isfinite(q.contact.stop(sides))):
        raise ArgumentError(not_allowed("itinerary", itinerary, "a word of stops that the system has"))
    return sides


def _checked_guess(q, guess, itinerary):
    rows = array_of(guess, 2)
    none = rows is not None and rows.size == 0
    if rows is None or not (none or (rows.shape[1] == 3 and np.isfinite(rows).all() and {*rows[:, 1]} <= {1, -1})):
        raise ArgumentError(not_allowed("guess", guess, "(t, side, v) for each impact, finite, with side 1 or -1"))
    rows = [] if none else [tuple(row) for row in rows.tolist()]
    if any(b[0] <= a[0] for a, b in pairwise(rows)):
        raise ArgumentError(not_allowed("guess", guess, "(t, side, v) for each impact, in the order of their times"))
    sides = word([side for _, side, _ in rows])
    if not np.all(np.isfinite(q.contact.stop([int(side) for _, side, _ in rows]))):
        raise ArgumentError(not_allowed("guess", guess, "(t, side, v) for each impact on a stop that the system has"))
    if itinerary is not None and (len(itinerary) != len(sides) or itinerary not in 2 * sides):  # any rotation of it
        raise ArgumentError(not_allowed("itinerary", itinerary, f"that of the guess, {sides!r}"))
    return rows
