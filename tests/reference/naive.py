"""A slow and obvious simulator of the impact oscillator, which the fast one is held against.

It shares no formula with the package. With y = (x1, v1, x2, v2, sin(omega t + tau), cos(omega t + tau))
free flight is the autonomous linear system y' = A y, which mpmath carries forward by exp(A h); rest on a stop
is the same system with the first two rows of A set to zero. A contact is a root of the Taylor polynomial of
the gap b - side x1, isolated by halving the step until a bound on the polynomial decides. Inside, numbers are those of
gmpy2.

`python tests/reference/naive.py --write` computes the reference sequences in tests/data/impacts.json anew (minutes).
"""

import json
import math
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import NamedTuple

import gmpy2
from mpmath import mp, mpf

from reference.gmp import context, dot, expm, from_gmp, to_gmp
from reference.roots import ZERO, evaluate, falling_root

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


class LinearFlow:
    """y' = A y over steps of h, with |A| h = 1/2."""

    def __init__(self, A):
        self.A = A
        self.rows = [[(a, j) for j, a in enumerate(row) if a] for row in A]  # most entries are zero
        norm = max(sum(abs(a) for a in row) for row in A)
        self.h = 1 / (2 * norm)
        self.growth = gmpy2.exp(norm * self.h)  # |y(u)| <= growth |y(0)| within a step
        exact = expm(mp.matrix([[from_gmp(a * self.h) for a in row] for row in A]))
        self.E = [[to_gmp(a) for a in row] for row in exact.tolist()]
        self.order = 1
        while mp.ldexp(1, -self.order) / mp.factorial(self.order) > mp.eps / 16:
            self.order += 1

    def step(self, y):
        return [dot(row, y) for row in self.E]

    def taylor(self, y):
        """Coefficients y_n of y(u) = sum of y_n u^n, each a state."""
        terms = [list(y)]
        for n in range(1, self.order + 1):
            last = terms[-1]
            terms.append([sum((a * last[j] for a, j in row), ZERO) / n for row in self.rows])
        return terms


class Oscillator:
    """The two flows, the stops, and what happens on them."""

    def __init__(self, params, digits):
        self.mu_m, self.mu_k, self.zeta, self.f2, self.omega, self.R, self.b, self.tau = (
            to_gmp(params[name]) for name in NAMES
        )
        self.sides = SIDES[params.get("stops", "both")]
        self.brief = to_gmp(mpf(10) ** (-digits / mpf(2)))
        o, one, drag, above = ZERO, ZERO + 1, 2 * self.zeta, 1 + self.mu_k
        M2_forces = [one, drag, -above, -drag * above, self.f2, o]
        M2_rows = [
            [o, o, o, one, o, o],
            [force / self.mu_m for force in M2_forces],
            [o, o, o, o, o, self.omega],
            [o, o, o, o, -self.omega, o],
        ]
        self.acceleration = [-one, -drag, one, drag, 1 - self.f2, o]  # of M1 in free flight
        self.free = LinearFlow([[o, one, o, o, o, o], self.acceleration, *M2_rows])
        self.stuck = LinearFlow([[o] * 6, [o] * 6, *M2_rows])
        # How far x1 can leave its chord within a step, h^2 / 8 max |x1''|, for |y| = 1 at the step's start.
        self.bulge = sum(map(abs, self.acceleration)) * self.free.growth * self.free.h**2 / 8

    def gap(self, terms, side):
        """Taylor coefficients of b - side x1."""
        c = [-side * term[0] for term in terms]
        c[0] += self.b
        return c

    def strike(self, y, side):
        """Restitution at the stop M1 touches -> (state, leading, delay).

        leading: the order of the first coefficient of the gap afterwards that is not zero.
        delay: None if M1 leaves; else the time after which it rests, that of the chatter still to come.
        """
        y = list(y)
        if side * y[1] > 0:
            y[1] *= -self.R
        gap = self.gap(self.free.taylor(y), side)
        leading = next(n for n, c in enumerate(gap) if c)
        speed, pull = gap[1], -2 * gap[2]
        if gap[leading] < 0:
            return y, leading, ZERO
        if pull > 0 and 2 * speed < self.brief * pull * (1 - self.R):
            y[1] = ZERO
            return y, 2, 2 * speed / (pull * (1 - self.R))
        return y, leading, None

    def fly(self, y, touching, leading):
        """One step, or less up to a contact -> (duration, state, side struck or 0, Taylor terms or None)."""
        flow = self.free
        ahead = flow.step(y)
        bulge = self.bulge * max(map(abs, y))
        near = [s for s in self.sides if s == touching or max(s * y[0], s * ahead[0]) + bulge >= self.b]
        if not near:
            return flow.h, ahead, 0, None
        terms = flow.taylor(y)
        contacts = []
        for side in near:
            # The zero at u = 0, from which M1 just left, is divided out: it cannot be found again.
            root = falling_root(self.gap(terms, side)[leading if side == touching else 0 :], ZERO, flow.h)
            if root is not None:
                contacts.append((root, side))
        if not contacts:
            return flow.h, ahead, 0, terms
        u, side = min(contacts)
        at = evaluate(terms, u)
        at[0] = side * self.b
        return u, at, side, terms

    def rest(self, y, side, leading):
        """One step at rest, or less up to the release -> (duration, state, released, Taylor terms)."""
        terms = self.stuck.taylor(y)
        pull = [side * dot(self.acceleration, term) for term in terms]
        u = falling_root(pull[leading:], ZERO, self.stuck.h)
        if u is None:
            return self.stuck.h, self.stuck.step(y), False, terms
        return u, evaluate(terms, u), True, terms


def simulate(params, state, periods=None, impacts=None, start_time=0, digits=40):
    """Orbit over `periods` forcing periods or until `impacts` are listed, whichever comes first.

    params: mu_m, mu_k, zeta, f2, omega, R, b, tau (a number) and perhaps stops ("both", "right", "left");
    floats count as the exact doubles. Chatter is followed impact by impact until what remains of it lasts
    less than 10^(-digits / 2) and is summed up as a geometric series.
    """
    if periods is None and impacts is None:
        raise ValueError("say when to stop: periods or impacts")
    with mp.workdps(digits + 10), context():
        o = Oscillator(params, digits)
        t, period = to_gmp(start_time), 2 * gmpy2.const_pi() / o.omega
        end = gmpy2.inf() if periods is None else t + to_gmp(periods) * period
        wanted = math.inf if impacts is None else impacts
        y = [to_gmp(x) for x in state] + [gmpy2.sin(o.omega * t + o.tau), gmpy2.cos(o.omega * t + o.tau)]
        if any(side * y[0] > o.b for side in o.sides):
            raise ValueError("the start lies behind a stop")
        struck = next((side for side in o.sides if y[0] == side * o.b), 0)

        hits, section, sticking = [], [], []
        next_section = int(gmpy2.ceil(t / period))
        resting = touching = leading = 0  # the stop M1 rests on, the stop it leaves in this step
        while t <= end:
            if struck:
                if struck * y[1] > 0:
                    hits.append(Impact(from_gmp(t), struck, *map(from_gmp, y[1:4])))
                if len(hits) == wanted:
                    break
                y, leading, delay = o.strike(y, struck)
                touching = struck
                if delay is not None:
                    resting, t_on, leading = struck, t + delay, leading - 2
            if resting:
                u, y_next, released, terms = o.rest(y, resting, leading)
                struck = 0
            else:
                u, y_next, struck, terms = o.fly(y, touching, leading)
                released = False
            while next_section * period <= min(t + u, end):
                terms = terms or o.free.taylor(y)
                section.append(tuple(map(from_gmp, evaluate(terms, next_section * period - t)[:4])))
                next_section += 1
            t, y, touching, leading = t + u, y_next, 0, 0
            if released:
                sticking.append(Sticking(from_gmp(t_on), from_gmp(t), resting))
                # Gap, speed and acceleration are zero at the release, whatever the rounding says.
                resting, touching, leading = 0, resting, 3
        if resting:
            sticking.append(Sticking(from_gmp(t_on), from_gmp(end), resting))
        return NaiveOrbit(hits, section, sticking)


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
