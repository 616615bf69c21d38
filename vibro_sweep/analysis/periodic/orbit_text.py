"""What `repr` says of a periodic orbit, and of whatever has one: what it is, in ten lines at most."""

from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.oscillator.wording import itinerary_text

if TYPE_CHECKING:
    from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit

LINES = 10
MULTIPLIERS = 4  # of largest modulus
LONGEST_SYSTEM = 400  # letters


def of_orbit(orbit: "PeriodicOrbit") -> str:
    lines = [f"<PeriodicOrbit {motion(orbit)}"]
    if len(orbit.multipliers):
        lines.append(f"multipliers {multipliers_text(orbit.multipliers)}")
    if orbit.others:
        many = "another orbit has" if orbit.others == 1 else f"{orbit.others} other orbits have"
        lines.append(f"{many} this itinerary: which=1 of periodic_orbit gives the next one")
    return repr_text([*lines, system_text(orbit.system)])


def repr_text(lines: list[str]) -> str:
    """The text of `repr` from its lines, empty ones left out; the first opens with "<"."""
    return "\n  ".join(line for line in lines if line) + ">"


def motion(orbit: "PeriodicOrbit") -> str:
    """Itinerary, period, symmetry, stability; or why there is no motion."""
    if not orbit.ok and not orbit.period:
        return f"without a motion, status {orbit.status}"
    stable = "stable" if orbit.stable else "unstable"
    status = "" if orbit.ok else f", status {orbit.status}"
    return f"{itinerary_of(orbit)}, {stable}{status}"


def itinerary_of(orbit: "PeriodicOrbit") -> str:
    if not orbit.period:
        return f"an orbit with the status {orbit.status}"
    return f"{itinerary_text(orbit.itinerary)}, period {orbit.period}" + (", symmetric" if orbit.symmetric else "")


def multipliers_text(values: np.ndarray) -> str:
    """The text of the multipliers of largest modulus."""
    texts = [complex_text(value) for value in values[:MULTIPLIERS]]
    return ", ".join([*texts, *(["..."] if len(values) > MULTIPLIERS else [])])


def complex_text(value: complex) -> str:
    return f"{value.real:.6g}" if value.imag == 0 else f"{value.real:.6g}{value.imag:+.6g}i"


def span(values: np.ndarray) -> str:
    finite = values[np.isfinite(values)]
    return f"{finite.min():.6g} .. {finite.max():.6g}" if finite.size else "unknown"


def system_text(system: object) -> str:
    text = repr(system)
    return text if len(text) <= LONGEST_SYSTEM else f"{text[: LONGEST_SYSTEM - 3]}..."
