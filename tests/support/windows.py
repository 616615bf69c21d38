"""Sweeps whose windows are looked for, and the check of an end: the orbits a little inside and outside of it."""

from dataclasses import replace

import numpy as np
import pytest

import vibro_sweep as vs
from vibro_sweep.analysis.branches.branch_orbits import solution_of
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of
from vibro_sweep.oscillator.family import family_of

SYSTEM = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
BESIDE = 1e-9


@pytest.fixture(scope="session")
def few(tmp_path_factory):
    """A file with 13 orbits: free, periodic on one side and both, chaotic."""
    path = tmp_path_factory.mktemp("windows") / "few.h5"
    b = [4.4, 5.2, 5.3, 5.33, 5.4, 5.6, 6.0, 6.35, 6.596, 6.6, 6.606, 6.664, 6.9]
    vs.sweep(SYSTEM, {"b": b}, transient=20_000, record=100, output=path, workers=1)
    return path


def check_end(window, special, outwards: int) -> str | None:
    """None where an end is what it says: the orbit is there and stable inside, and is not outside. Else what is wrong.

    Orbits are found anew, by Newton's method from the impacts at the end, and flown by the engine. Where the orbit is
    born, Newton's method is singular: there it is the simpler orbit that is stable outside, and is not inside.
    """
    if special.type == "boundary":
        return None
    end = special.parameters[window.parameter]
    beside = BESIDE * max(1.0, abs(end)) + (2 * special.error if special.type == "graze" else 0.0)
    step = min(beside, 1e-3 * (window.hi - window.lo))
    inside, outside = (
        special.orbit.system.replace(**{window.parameter: end + d * step}) for d in (-outwards, outwards)
    )
    if (special.orbit.period, special.orbit.symmetric) != (window.period, window.symmetric):
        within, beyond = (_moved(special.orbit._solution, system) for system in (inside, outside))
        return None if beyond.stable and not within.stable else "its parent does not change stability"
    start = _near(window, special, step)
    within, beyond = (_moved(start, system) for system in (inside, outside))
    if not within.ok:
        return f"inside: {within.status}"
    if special.type == "fold":  # the stable orbit and the one that it meets are equally near
        return "outside: there is an orbit" if beyond.ok and _distance(within, beyond) < 1e-2 else None
    if not within.stable:
        return f"inside: {np.abs(within.multipliers).max()}"
    flown = vs.simulate(inside, within.state, within.period)
    met = len(flown.impacts) + np.count_nonzero(flown.contacts["t_touch"] > flown.start_time)
    if met != len(window.itinerary) or np.abs(flown.section[-1] - within.state).max() > 1e-5:
        return f"inside: flown, {met} impacts and contacts"
    if special.type in ("flip", "pitchfork", "neimark_sacker"):
        near = beyond.ok and _distance(within, beyond) < 1e-5
        return None if near and not beyond.stable else f"outside: {beyond.status}, stable {beyond.stable}"
    return "outside: the orbit is still there" if beyond.ok else None


def _moved(start, system):
    """The orbit near a solution, for another value of the parameter."""
    found = replace(start, family=family_of(system)).corrected()
    return orbit_of(system, found)


def _distance(a, b) -> float:
    return float(np.abs(a.state - b.state).max())


def _near(window, special, step: float):
    """The orbit at an end; the one `step` beside it, roughly, where orbits move like the square root: at a fold, and
    where a contact begins smoothly, or becomes two."""
    arrays, point = window._arrays, 0 if special is window.lower else -1
    distance = np.abs(arrays["value"] - arrays["value"][point])
    (farther,) = np.nonzero(distance > step)  # points lie close together where the branch is about to turn
    beside = farther[point]
    compliant = special.orbit.system.linear.compliant
    root = special.type == "fold" or (special.type in ("graze", "split") and compliant)
    share = np.sqrt(step / distance[beside]) if root else 0.0
    parts = [
        (1 - share) * arrays[name][point] + share * arrays[name][beside]
        for name in ("impact_t", "impact_v", "impact_t_off")
    ]
    return solution_of(arrays, special.orbit.system, *parts)
