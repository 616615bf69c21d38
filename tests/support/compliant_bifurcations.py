"""Special points of branches and curves with contacts, held against thirty digits."""

import math
from typing import NamedTuple

import numpy as np
from reference.closed_orbit import contacts_of, element_of
from reference.conditions import Condition
from reference.machine import machine_of, moved

import vibro_sweep as vs
from vibro_sweep.analysis.branches.special import bare
from vibro_sweep.analysis.periodic.joined_contacts import flights_between, joined
from vibro_sweep.model.linear import family_of

PAPER = dict(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63)


def paper(b, k, z=0.07, **more):
    return vs.System(**PAPER, b=b, k_stop=k, c_stop=2 * z * math.sqrt(k), **more)


def one_mass(**numbers):
    given = dict(k=1, zeta=0.05, F=0.5, omega=0.8, k_stop=29, b=1, stops="right", tau=0.0)
    return vs.Oscillator.named("one_mass", **(given | numbers))


CHAIN = vs.Oscillator.named(
    "chain", m=[1, 2, 1.5], k=[1, 1, 0.5, 1], c=[0.05] * 4, force=[0, 0, 1], omega=0.5, b=1.2, stops="right",
    stop_at=3, k_stop=40, c_stop=0.3, tau=0.0,
)  # fmt: skip
# of branches: system, itinerary, number, bounds
BRANCHES = {
    "one mass": (one_mass(), "R", "omega", (0.3, 3)),
    "one mass, preloaded": (one_mass(preload=0.05, omega=0.75), "R", "omega", (0.3, 3)),
    "one mass, damped stop": (one_mass(c_stop=0.5, preload=0.03), "R", "omega", (0.3, 3)),
    "one mass, left by force": (one_mass(c_stop=0.5, release="force"), "R", "omega", (0.3, 3)),
    "R": (paper(4, 1e2), "R", "b", (1, 7)),
    "R, stiff": (paper(4, 1e4), "R", "b", (1, 7)),
    "LR": (paper(2, 1e2), "LR", "b", (1, 7)),
    "LR, preloaded": (paper(2, 1e2, preload=0.5), "LR", "b", (1, 7)),
    "one mass, its force": (one_mass(), "R", "F", (0.05, 1.5)),
    "one mass, its damping": (one_mass(), "R", "zeta", (0, 0.5)),
    "one mass, its clearance": (one_mass(), "R", "b", (0.2, 3)),
    "one mass, left by force, its force": (one_mass(c_stop=0.5, release="force"), "R", "F", (0.05, 1.5)),
    "R, its frequency": (paper(4, 1e2), "R", "omega", (0.4, 0.9)),
    "R, its mass": (paper(4, 1e2), "R", "mu_m", (1, 20)),
    "R, its spring": (paper(4, 1e2), "R", "mu_k", (1, 10)),
    "R, its damping": (paper(4, 1e2), "R", "zeta", (0, 0.2)),
    "LR, its frequency": (paper(2, 1e2), "LR", "omega", (0.4, 0.9)),
    "LR, its spring": (paper(2, 1e2), "LR", "mu_k", (1, 10)),
    "LR, its mass": (paper(3, 1e2), "LR", "mu_m", (1, 20)),
    "LR, stops unlike": (paper(2, 1e2, k_stop_left=50), "LR", "b", (1, 7)),
    "three masses": (CHAIN, "R", "omega", (0.2, 1.5)),
}
CONDITIONS = {
    "fold": ["fold"],
    "flip": ["flip"],
    "pitchfork": ["flip"],
    "neimark_sacker": ["pair"],
    "graze": [],
    "split": [],
    "cusp": ["fold", "cusp"],
    "degenerate_flip": ["flip", "third"],
    "degenerate_neimark_sacker": ["pair", "third"],
    "fold_flip": ["fold", "flip"],
    "fold_neimark_sacker": ["fold", "pair"],
    "flip_neimark_sacker": ["flip", "pair"],
    "resonance_1_1": ["fold", "double_1"],
    "resonance_1_2": ["flip", "double_-1"],
    "resonance_1_3": ["pair"],
    "resonance_1_4": ["pair"],
    "fold_graze": ["fold"],
    "flip_graze": ["flip"],
    "pitchfork_graze": ["flip"],
    "neimark_sacker_graze": ["pair"],
    "double_graze": [],
}
ANGLES = {"resonance_1_3": 2 * np.pi / 3, "resonance_1_4": np.pi / 2}
NO_LENGTH = 1e-7  # of the period: a contact that short is a touch


def branch_of(name):
    system, itinerary, number, bounds = BRANCHES[name]
    return vs.continue_orbit(vs.periodic_orbit(system, itinerary=itinerary), number, bounds)


class Described(NamedTuple):
    """A special point as the reference needs it: the oscillator with t = 0 in its longest flight, and guesses."""

    q: object
    of: tuple  # sides, periods, sigma
    guess: tuple  # state, times of contacts, times of touches, theta
    touched: list  # stops of the touches


def described(special) -> Described:
    system, solution = special.orbit.system, special.orbit._solution
    q, P = family_of(system).linear, solution.P
    touching, sides = [], []
    if special.type == "split":
        solution, time, side = turning_within(special)
        touching, sides = [time], [side]
    elif solution.K:
        lengths = np.full(solution.K, np.inf)
        lengths[list(solution.rests)] = solution.ends - solution.times[list(solution.rests)]
        gone = np.flatnonzero(np.abs(lengths) < NO_LENGTH * P)
        touching, sides = solution.times[gone].tolist(), [solution.sides[k] for k in gone]
        solution = bare(solution, gone) if len(gone) else solution
    if special.type.endswith("graze") and len(touching) < 1 + (special.type == "double_graze"):
        touching, sides = [*touching, solution.nearest[1]], [*sides, solution.nearest[2]]
    # t = 0 of the reference is in the middle of the longest flight
    begins, ends = (solution.times, solution.ends) if solution.K else (np.array([touching[0] + P / 2]),) * 2
    gaps = np.append(begins[1:], begins[0] + P) - ends
    k = int(np.argmax(gaps))
    start = float(ends[k] + 0.37 * gaps[k]) if solution.K else float(begins[0])
    order = np.roll(np.arange(solution.K), -k - 1)
    turns = np.floor((solution.times[order] - start) / P)
    signs = (float(solution.sigma) ** turns).astype(int) if solution.sigma < 0 else np.ones(solution.K, int)
    begins = solution.times[order] - turns * P - start
    lengths = (solution.ends - solution.times)[order]
    around = np.column_stack([begins, begins + lengths]).ravel()
    touched = [(t - start) % P for t in touching]
    sides = [
        int(side) * (solution.sigma ** int(np.floor((t - start) / P))) for side, t in zip(sides, touching, strict=True)
    ]
    state = type(special.orbit)(system, "ok", solution, (0, 0)).sample([start])[0]
    begun = q._replace(tau=float(q.tau + q.omega * start))
    theta = None
    if "pair" in CONDITIONS[special.type]:
        mu = solution.multipliers
        theta = float(np.angle(mu[np.argmin(np.where(mu.imag > 1e-9, np.abs(np.abs(mu) - 1), np.inf))]))
    of = np.array(solution.sides)[order] * signs, solution.half_periods / 2, solution.sigma
    return Described(begun, of, (state, around, touched, theta), sides)


def turning_within(special):
    """The orbit with one contact in place of two that meet; when, and at which stop, the mass comes back within it."""
    solution = special.orbit._solution
    apart = flights_between(solution)
    if apart.min() == 0:
        index = int(apart.argmin())
        return joined(solution, index), solution.ends[solution.rests.index(index)], solution.sides[index]
    orbit, found = type(special.orbit)(special.orbit.system, "ok", solution, (0, 0)), []
    for begin, end, side in zip(solution.times, solution.ends, solution.sides, strict=True):
        times = np.linspace(begin, end, 4001)[1:-1]
        depth = side * (orbit.sample(times)[:, 0::2] @ family_of(special.orbit.system).linear.normal)
        inner = np.flatnonzero((depth[1:-1] < depth[:-2]) & (depth[1:-1] < depth[2:])) + 1
        found += [(depth[k], times[k], side) for k in inner]
    return solution, *min(found)[1:]


def distance_in_digits(special, pulled=False) -> tuple[np.ndarray, float]:
    """By how much the parameters of a special point differ from those of the reference, and its last change.

    pulled : whether its contacts end by their force although there is a preload
    """
    d, family = described(special), family_of(special.orbit.system)
    slopes = [family.derivative(name)._replace(tau=0.0) for name in special.parameters]
    conditions = CONDITIONS[special.type]
    if special.type == "split" and len(slopes) > 1:  # the end of a curve
        conditions = CONDITIONS[special.curve]
    machine, (sides, periods, sigma) = machine_of(d.q), d.of
    exact = Condition(
        lambda changes: machine_of(moved(d.q, slopes, changes)), len(slopes), contacts_of(machine, sides, pulled),
        periods, sigma, 0, conditions, [element_of(machine, side) for side in d.touched], ANGLES.get(special.type),
    )  # fmt: skip
    off, change = exact.solve(*d.guess)
    return np.array(off), change
