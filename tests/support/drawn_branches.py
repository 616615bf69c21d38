"""Branches drawn at random: oscillators of all models, orbits that attract or not, numbers to follow them in."""

from typing import NamedTuple

import numpy as np

import vibro_sweep as vs
from support.drawn_oscillators import positive
from vibro_sweep.oscillator.family import family_of
from vibro_sweep.oscillator.linear import amplitudes, static_state
from vibro_sweep.types import PeriodicOrbit

MODELS = ("two_mass", "one_mass", "ball_in_cavity", "chain", "linear")
MOST_IMPACTS = 24  # of an orbit: longer ones take long to follow, and there are many of them
WORDS = ("R", "L", "RR", "LR", "LLRR", "LRR", "RRR", "")


class Case(NamedTuple):
    """A branch: an orbit, and the number in which it is followed within bounds."""

    orbit: PeriodicOrbit
    name: str
    bounds: tuple[float, float]

    def __str__(self) -> str:
        o = self.orbit
        lo, hi = self.bounds
        word = (o.itinerary or "free") + " symmetric" * o.symmetric
        return f"{self.name} {lo:.9g} .. {hi:.9g} from period {o.period}, {word}"


def drawn_restitution(rng) -> float:
    return float(rng.choice([rng.uniform(0.3, 0.95), 1.0, rng.uniform(0.05, 0.3)], p=[0.8, 0.1, 0.1]))


def drawn_oscillator(model: str, rng):
    """Symmetric or not, one stop or two; the stops near the free motion or within it."""
    symmetric = rng.random() < 0.4
    stops = "both" if symmetric else str(rng.choice(["both", "right", "left"]))
    omega, R = float(rng.uniform(0.3, 2)), drawn_restitution(rng)
    tau = "grazing" if rng.random() < 0.5 else float(rng.uniform(0, 6))
    numbers = {"omega": omega, "R": R, "tau": tau, "b": 1.0}
    if model != "ball_in_cavity":
        numbers["stops"] = stops
    if not symmetric and stops == "both" and model != "ball_in_cavity" and rng.random() < 0.5:
        numbers["R_left"] = drawn_restitution(rng)
    zeta = 10 ** rng.uniform(-2, -0.5)
    force, constant = rng.normal(size=4), (0.0 if symmetric else 0.2) * rng.normal(size=4)
    if model == "two_mass":
        numbers |= {"mu_m": 10 ** rng.uniform(-0.5, 1), "mu_k": 10 ** rng.uniform(-0.5, 1), "zeta": zeta}
        numbers["f2"] = float(rng.choice([0, rng.uniform(0, 1)]))
    elif model == "one_mass":
        numbers |= {"zeta": zeta, "F": float(rng.uniform(0.2, 2)), "constant": float(constant[0])}
        numbers["k"] = float(rng.choice([1.0, rng.uniform(0.2, 3)]))
    elif model == "ball_in_cavity":
        numbers |= {"mass_ratio": 10 ** rng.uniform(-2, 0), "zeta": zeta, "F": float(rng.uniform(0.1, 1))}
    elif model == "chain":
        n = int(rng.integers(2, 5))
        numbers |= {"m": rng.uniform(0.5, 3, n).tolist(), "k": rng.uniform(0.3, 3, n + 1).tolist()}
        numbers |= {"c": (0.1 * rng.uniform(0.1, 2, n + 1)).tolist(), "force": force[:n].tolist()}
        numbers |= {"constant": constant[:n].tolist(), "stop_at": int(rng.integers(1, n + 1))}
    else:
        n = int(rng.integers(1, 5))
        numbers |= {"M": positive(rng, n, 1.0), "K": positive(rng, n, 0.3), "C": 0.1 * positive(rng, n, 0.1)}
        numbers |= {"contact_normal": rng.normal(size=n), "force": force[:n], "force_cos": rng.normal(size=n)}
        numbers["constant"] = constant[:n]
    q = vs.Oscillator.named(model, **numbers).linear
    size, middle = abs(q.contact.normal @ amplitudes(q)), q.contact.normal @ static_state(q)
    numbers["b"] = size * rng.uniform(0.1, 1.05)
    if not symmetric and model != "ball_in_cavity":
        numbers["offset"] = middle + (0.0 if stops != "both" else 0.1) * size * rng.normal()
    return vs.Oscillator.named(model, **numbers)


def recorded(system, rng):
    """A periodic orbit that attracts, or None."""
    q = system.linear
    low, high = (
        edge if np.isfinite(edge) else other + sign * 2 * system.b
        for edge, other, sign in ((q.contact.low, q.contact.high, -1), (q.contact.high, q.contact.low, 1))
    )
    state = rng.normal(size=2 * q.masses) * system.b * np.tile([1.0, q.omega], q.masses)
    state[::2] += (
        q.contact.normal
        * (rng.uniform(low, high) - q.contact.normal @ state[::2])
        / (q.contact.normal @ q.contact.normal)
    )
    if not q.contact.low < q.contact.normal @ state[::2] < q.contact.high:
        return None
    section = vs.simulate(system, state, 1500).section
    for n in range(1, 25):
        if np.abs(section[-1] - section[-1 - n]).max() < 1e-10 * np.abs(section[-1]).max():
            return vs.periodic_orbit(system, state=section[-1], periods=n)
    return None


def drawn_orbit(system, rng, tries=6):
    """A periodic orbit that is ok: mostly one that attracts, else one with an itinerary of a few impacts; or None."""
    for _ in range(tries):
        if rng.random() < 0.6:
            orbit = recorded(system, rng)
        else:
            word = str(rng.choice(WORDS))
            stops = getattr(system, "stops", "both")
            if set(word) - {"both": set("LR"), "right": set("R"), "left": set("L")}[stops]:
                continue
            orbit = vs.periodic_orbit(system, itinerary=word, periods=int(rng.integers(1, 4)))
        if orbit is not None and orbit.ok and len(orbit.impacts) <= MOST_IMPACTS:
            return orbit
    return None


def drawn_number(system, rng) -> tuple[str, tuple[float, float]]:
    """A number of the oscillator, and bounds around it."""
    numbers = family_of(system).numbers
    names = [name for name, value in numbers.items() if isinstance(value, (int, float)) and name != "stops"]
    often = [name for name in ("b", "b", "R", "offset") if name in names]
    name = str(rng.choice(often if rng.random() < 0.6 else names))
    value, q = float(numbers[name]), system.linear
    if name == "b":
        graze = abs(q.contact.normal @ amplitudes(q))
        return name, (min(0.1 * graze, 0.9 * value), max(1.1 * graze, 1.1 * value))
    reach = {"offset": 0.3 * system.b, "tau": 1.0}.get(name, 0.3 * abs(value) or 0.2)
    lo, hi = value - reach, value + reach
    return name, (lo, min(hi, 1.0) if name.startswith("R") else hi)


def drawn_case(model: str, rng) -> Case | None:
    system = drawn_oscillator(model, rng)
    orbit = drawn_orbit(system, rng)
    return None if orbit is None else Case(orbit, *drawn_number(system, rng))


def beyond(branch, case: Case, rng) -> Case | None:
    """Another branch, that begins at a special point of this one; None where there is none."""
    able = [one for one in branch.special if one.type in ("graze", "pitchfork", "flip")]
    for special in rng.permutation(np.array(able, object)).tolist():
        orbits = [one for one in vs.switch(special) if len(one.impacts) <= MOST_IMPACTS]
        orbits = [one for one in orbits if case.bounds[0] <= getattr(one.system, case.name) <= case.bounds[1]]
        if orbits:
            return Case(orbits[int(rng.integers(len(orbits)))], case.name, case.bounds)
    return None
