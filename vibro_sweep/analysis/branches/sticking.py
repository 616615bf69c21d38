"""The sticking onset: where impacts accumulate, and the orbits beyond it rest on a stop.

Towards the onset impacts appear at the end of a chatter sequence, one at a time, at grazes that accumulate like R^K.
At the onset itself the sequence is infinite: a single point of the equations with its end as an event
(engine/continuation/chatter_tail.py), with one free number. Newton's method goes to it from the orbit at a graze.
"""

import numpy as np

from vibro_sweep.analysis.branches.sizes import LEAST, least_size
from vibro_sweep.analysis.branches.special import SpecialPoint, inserted
from vibro_sweep.analysis.continuation.chatter import Chatter, chatter_at, written_out
from vibro_sweep.analysis.continuation.first_point import converge, guess_of
from vibro_sweep.analysis.continuation.solution_curve import NoPlaneError, SolutionCurve
from vibro_sweep.analysis.continuation.starting_orbit import StartingOrbit
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.analysis.periodic.solution import Solution
from vibro_sweep.checks.arguments import check_type, names_its_arguments
from vibro_sweep.engine.continuation.workspace import FIRST, Place

SHORTEST_CHATTER = 7  # impacts on one stop, the one that appears among them
EARLIER = 1.0, 1.3, 0.0  # by how much the sequence may end before the graze: times since the acceleration has vanished


@names_its_arguments
def sticking_onset(special: SpecialPoint) -> SpecialPoint | None:
    """The sticking onset beyond a graze at which an impact appears at the end of a chatter sequence.

    A special point of type "sticking"; its orbit has no finite list of impacts, and the status "sticking". None where
    there is no such sequence, or no onset near it. An orbit that gains impacts at both ends of its branch has an onset
    beyond either: the nearest of those found is taken.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=0.08)
    >>> orbit = vs.periodic_orbit(system, state=vs.simulate(system, (0, 0, 0, 0), 500).section[-1])
    >>> branch = vs.continue_orbit(orbit, "b", (0.06, 0.09))
    >>> round(vs.sticking_onset(branch.begins).parameters["b"], 10)
    0.0646391434
    """
    check_type("special", special, SpecialPoint, "a special point of a branch")
    if special.type != "graze" or special.impact is not None or special.orbit._solution.rests:
        return None
    name = next(iter(special.parameters))
    solution, index = inserted(special.orbit._solution)
    R = float(solution.family.linear.contact.restitution(solution.sides[index : index + 1])[0])
    if not 0 < R < 1 or solution.is_free:
        return None
    found = [onset for guess in _guesses(solution, index) if (onset := _onset(guess, name)) is not None]
    if not found:
        return None
    curve, place = min(found, key=lambda one: abs(one[1].p[FIRST] - special.parameters[name]))
    onset, error = float(place.p[FIRST]), place.rounding
    orbit = PeriodicOrbit(special.orbit.system.replace(**{name: onset}), "sticking")
    none, chatter = np.empty(0, complex), chatter_at(curve, place, False)
    return SpecialPoint("sticking", {name: onset}, orbit, none, error, special.stop, _chatter=chatter)


def _guesses(touching: Solution, index: int) -> list[Chatter]:
    """Guesses of the onset from the orbit at which a chatter sequence gains impact `index`; none where it does not.

    At the end of the sequence the acceleration vanishes. The last impacts are unlike those of the onset: the second
    half of the sequence is left out.
    """
    K, P, sigma, N = touching.K, touching.P, touching.sigma, touching.family.linear.masses
    t = np.append(touching.times[index:], touching.times[:index] + P)
    D = np.append(touching.jumps[index:], sigma * touching.jumps[:index])
    sides = [*touching.sides[index:], *(sigma * side for side in touching.sides[:index])]
    length = next((k for k in range(K - 1) if sides[-1 - k] != sigma * sides[0]), K - 1) + 1
    if length < SHORTEST_CHATTER or np.any(np.diff(t[1 - SHORTEST_CHATTER : -2], 2) >= 0):  # flights grow
        return []
    kept = K - length // 2
    _, acceleration, jerk = touching.motion[index]
    state, guesses = touching.states[index, : 2 * N], []
    for times in EARLIER:
        u = np.concatenate([t[:kept], [0.0], D[1:kept]])
        u[0] -= times * acceleration / jerk
        guesses.append(Chatter(Solution(touching.family, sigma, touching.half_periods, tuple(sides[:kept]), u), state))
    return guesses


def _onset(guess: Chatter, name: str) -> tuple[SolutionCurve, Place] | None:
    """The onset near a guess, whose impacts are nearer to those of the guess than these to each other."""
    s = guess.solution
    value, size = s.family.free[name], least_size(s, name) / LEAST
    try:
        curve = SolutionCurve(
            StartingOrbit("sticking", s, state=guess.state), (name,), [(value - size / 2, value + size / 2)]
        )
    except NoPlaneError:
        return None
    first = guess_of(curve)
    found = first and written_out(curve, first)
    if not found:
        return None
    curve, place = found[0], converge(*found)
    if place is None or not curve.is_real(place):
        return None
    shared = slice(1, min(s.K, curve.K))
    flights = np.diff(first.phases, append=first.phases[0] + np.pi * s.half_periods)
    moved = np.abs(place.phases[shared] - first.phases[shared])
    return (curve, place) if np.all(moved < flights[shared]) else None
