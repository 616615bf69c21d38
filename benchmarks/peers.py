"""The methods that are compared, behind one small interface.

A method makes a solver for one oscillator and one or more orbits. Optional packages are imported when a solver that
needs them is made; one that is not installed leaves its curve out, with a message.
"""

from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from typing import NamedTuple

import numpy as np


class Solver(NamedTuple):
    """One oscillator and the orbits from `states` at t = 0.

    impacts : count -> (times, sides) of the first impacts of the first orbit
    job : periods -> a function without arguments that carries the orbits over so many forcing periods, and returns
        how many impacts they had; setting up is done before, so that the function can be timed
    orbits : how many a job carries
    """

    impacts: Callable[[int], tuple[np.ndarray, np.ndarray]]
    job: Callable[[int], Callable[[], int]]
    orbits: int = 1


class Method(NamedTuple):
    name: str
    module: str  # where `make` is
    make: str  # make(params, states, **setting) -> Solver
    knob: str = ""  # the setting that trades speed for error
    values: tuple = ()  # of the knob, from coarse to fine
    fine: dict = {}  # noqa: RUF012  # the setting in which it is compared
    note: str = ""

    def solver(self, params, states, **setting) -> Solver:
        return getattr(import_module(self.module), self.make)(params, np.atleast_2d(states), **setting)


TOLERANCES = (1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16)
COARSE = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
STEPS = (100, 300, 1000, 3000, 10000)

ENGINE, EXPONENTS, ALONE = "vibro_sweep", "vibro_sweep, exponents", "vibro_sweep, one orbit"
BATCH, SCALAR, BARE = "heyoka, batch of 8", "heyoka, one orbit", "heyoka, batch of 8, no events"
TANGENT_BATCH, TANGENT = "heyoka, batch of 8, exponents", "heyoka, one orbit, exponents"
RK4 = "RK4, bisection"

NEEDS = {"heyoka": "heyoka", "CVODE": "sksundae", "SciPy": "scipy"}  # package, by the first word of the name
CALLS = "a Python callback at each impact"
COMPILED = "restarted at each impact; right-hand side compiled, called through Python"
METHODS = (
    Method(ENGINE, "engine", "batch", "cells", (8, 16, 24, 32, 64, 128), note="eight orbits, as the points of a sweep"),
    Method(EXPONENTS, "engine", "exponents", note="eight orbits"),
    Method(ALONE, "engine", "scalar"),
    Method(BATCH, "peer_heyoka", "batch", "tol", TOLERANCES, {"tol": 1e-16}, CALLS),
    Method(SCALAR, "peer_heyoka", "scalar", "tol", TOLERANCES, {"tol": 1e-16}, CALLS),
    Method(BARE, "peer_heyoka", "bare", note="flies through the stops: the floor of the peer"),
    Method(TANGENT_BATCH, "peer_heyoka", "variational_batch", note=f"{CALLS}, saltation compiled"),
    Method(TANGENT, "peer_heyoka", "variational", note=f"{CALLS}, saltation compiled"),
    Method("closed form, scan", "peer_handwritten", "scan", "nodes", (16, 64, 256, 1024), {"nodes": 64}, "bisection"),
    Method(RK4, "peer_handwritten", "rk4", "steps", STEPS, {"steps": 1000}, "what people write"),
    Method("RK4, linear", "peer_handwritten", "rk4_linear", "steps", STEPS, {"steps": 1000}, "linear interpolation"),
    Method("CVODE Adams", "peer_solvers", "adams", "tol", COARSE, {"tol": 1e-12}, COMPILED),
    Method("CVODE BDF", "peer_solvers", "bdf", "tol", COARSE, {"tol": 1e-12}, COMPILED),
    Method("SciPy DOP853", "peer_solvers", "dop853", "tol", COARSE, {"tol": 1e-12}, COMPILED),
    Method(
        "CVODE Adams, short steps", "peer_solvers", "adams", "longest", (1 / 40, 1 / 400),
        {"longest": 1 / 400}, f"no step longer than a part of T; {COMPILED}",
    ),
    Method(
        "SciPy DOP853, short steps", "peer_solvers", "dop853", "longest", (1 / 40, 1 / 100, 1 / 400),
        {"longest": 1 / 400}, f"no step longer than a part of T; {COMPILED}",
    ),
)  # fmt: skip


def method(name: str) -> Method:
    return next(m for m in METHODS if m.name == name)


def available(methods=METHODS) -> list[Method]:
    """The methods whose package is installed; says which are not."""
    found = []
    for one in methods:
        package = NEEDS.get(one.name.split()[0].rstrip(","))
        if package is None or find_spec(package):
            found.append(one)
        else:
            print(f"{one.name}: left out, no module {package}; pip install '.[bench]'")
    return found
