"""A slow and obvious simulator of the paper's oscillator, which the fast one is held against: events.py does it.

`python tests/reference/naive.py --write` computes the reference sequences in tests/data/impacts.json anew (minutes).
"""

import json
import math
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from types import SimpleNamespace
from typing import NamedTuple

from mpmath import mp, mpf

from reference.events import simulate as simulate_machine
from reference.machine import machine_of, with_contacts

REFERENCE = Path(__file__).parents[1] / "data" / "impacts.json"
NAMES = ("mu_m", "mu_k", "zeta", "f2", "omega", "R", "b", "tau")
SIDES = {"both": (1, -1), "right": (1,), "left": (-1,)}


class Impact(NamedTuple):
    t: mpf
    side: int
    v1: mpf  # before the impact
    x2: mpf
    v2: mpf


class Sticking(NamedTuple):
    t_on: mpf
    t_off: mpf  # the end of the simulation if M1 is still at rest then
    side: int


class NaiveOrbit(NamedTuple):
    impacts: list[Impact]
    section: list[tuple]  # (x1, v1, x2, v2) at every t = 0 mod T, both ends included
    sticking: list[Sticking]


def linear_of(params):
    """The paper's oscillator as any other one, in the working precision."""
    mu_m, mu_k, zeta, f2, omega, R, b, tau = (mpf(params[name]) for name in NAMES)
    none, K = [mpf(0)] * 2, [[mpf(1), mpf(-1)], [mpf(-1), 1 + mu_k]]
    sides = SIDES[params.get("stops", "both")]
    low, high = -b if -1 in sides else -math.inf, b if 1 in sides else math.inf
    contact = SimpleNamespace(normal=[mpf(1), mpf(0)], low=low, high=high, R_low=R, R_high=R)
    numbers = SimpleNamespace(
        M=[[mpf(1), mpf(0)], [mpf(0), mu_m]], K=K, C=[[2 * zeta * a for a in row] for row in K],
        sine=[1 - f2, f2], cosine=none, constant=none, omega=omega, tau=tau,
    )  # fmt: skip
    return with_contacts(numbers, [contact])


def simulate(params, state, periods=None, impacts=None, start_time=0, digits=40):
    """Orbit over `periods` forcing periods or until `impacts` are listed, whichever comes first.

    params: mu_m, mu_k, zeta, f2, omega, R, b, tau (a number) and perhaps stops ("both", "right", "left");
    floats count as the exact doubles.
    """
    with mp.workdps(digits + 10):
        machine = machine_of(linear_of(params))
    orbit = simulate_machine(machine, state, periods, impacts=impacts, start_time=start_time, digits=digits)
    return NaiveOrbit(
        [Impact(hit.t, hit.side, *hit.y[1:]) for hit in orbit.impacts],
        [tuple(at) for at in orbit.section],
        [Sticking(*rest[:3]) for rest in orbit.rests],
    )


def response(params):
    """Complex amplitudes X of the steady motion x = Im(X e^{i (omega t + tau)}) of M1 and M2."""
    mu_m, mu_k, zeta, f2, omega = (mpf(params[name]) for name in NAMES[:5])
    K = mp.matrix([[1, -1], [-1, 1 + mu_k]])
    M = mp.diag([1, mu_m])
    return mp.lu_solve(K - omega**2 * M + 2j * omega * zeta * K, mp.matrix([1 - f2, f2]))


def grazing(params, digits=40):
    """b and tau of the double grazing motion: the steady x1 has its maximum b at t = 0."""
    with mp.workdps(digits + 10):
        x1 = response(params)[0]
        return abs(x1), mp.atan2(x1.real, x1.imag)


# The paper's parameters, and the orbits of tests/data/impacts.json: rest and two other starts, in units of b.
PAPER = {"mu_m": 10.0, "mu_k": 5.0, "zeta": 0.05, "f2": 0.0, "omega": 0.63, "R": 0.8}
CLEARANCES = (6.69, 6.6, 5.0, 3.0, 1.0)
STARTS = ((0.0, 0.0, 0.0, 0.0), (0.3, 0.05, -0.2, 0.1), (-0.5, -0.2, 0.3, 0.1))
ORBITS = [(b, tuple(b * x for x in start)) for b in CLEARANCES for start in STARTS]
COUNT = 30
FIELDS = ("t", "v1", "x2", "v2")


def perturbed_inputs(params, state):
    """Each input in turn moved by one part in 2^53: of itself, for a state of b, for f2 = 0 of one."""
    part = mp.ldexp(1, -53)
    for name in NAMES:
        value = mpf(params[name])
        yield {**params, name: value + part * (abs(value) or 1)}, state
    for i in range(4):
        yield params, [mpf(x) + (part * params["b"] if i == j else 0) for j, x in enumerate(state)]


def reference(b, state, count=COUNT):
    """The first impacts of one orbit, and what moving every input by one part in 2^53 does to them, as JSON.

    `effect` is the sum of the absolute effects of the single inputs, and half a unit in the last place of the
    double that holds the result.
    """
    with mp.workdps(40):
        params = {**PAPER, "b": b, "tau": float(grazing(PAPER)[1])}
        impacts = simulate(params, state, impacts=count).impacts
        effect = {f: [mpf(math.ulp(float(getattr(hit, f)))) / 2 for hit in impacts] for f in FIELDS}
        for moved in perturbed_inputs(params, state):
            others = simulate(*moved, impacts=count).impacts
            if [hit.side for hit in others] != [hit.side for hit in impacts]:
                raise ArithmeticError(f"b = {b}, start {state}: too near a graze to compare doubles with")
            for f in FIELDS:
                pairs = zip(effect[f], impacts, others, strict=True)
                effect[f] = [e + abs(getattr(p, f) - getattr(q, f)) for e, p, q in pairs]
        return {
            "params": params,
            "state": list(state),
            "side": [hit.side for hit in impacts],
            "impacts": {f: [mp.nstr(getattr(hit, f), 25) for hit in impacts] for f in FIELDS},
            "effect": {f: [float(mp.nstr(e, 3)) for e in effect[f]] for f in FIELDS},
        }


def write_reference(path=REFERENCE):
    with ProcessPoolExecutor() as pool:
        orbits = list(pool.map(reference, *zip(*ORBITS, strict=True)))
    path.parent.mkdir(exist_ok=True)
    path.write_text("[\n" + ",\n".join(json.dumps(orbit) for orbit in orbits) + "\n]\n")


if __name__ == "__main__":
    if sys.argv[1:] != ["--write"]:
        sys.exit(f"usage: python {sys.argv[0]} --write")
    write_reference()
