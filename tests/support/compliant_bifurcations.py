"""Branches with compliant stops that tests know by name."""

import math

import vibro_sweep as vs

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


def branch_of(name):
    system, itinerary, number, bounds = BRANCHES[name]
    return vs.continue_orbit(vs.periodic_orbit(system, itinerary=itinerary), number, bounds)
