"""How exact the impacts of the oscillators of drawn_stiff are, and whether they are the right ones.

The reference works in the coordinates of the masses, in 50 digits: a flight is a sum of exponentials, whose contact
nearest to the impact that was found is its root. Moved by one rounding in all its numbers, and at each impact anew in
the stop that is hit (as a gap of the size of b cannot be known better), it says what the data allow.
"""

import math

import numpy as np
from mpmath import mp, mpf
from reference.machine import mapped

import vibro_sweep as vs
from support.drawn_oscillators import drawn_stiff
from support.searching import Report, new_report, size

DIGITS = 50
COUNT = 6  # impacts compared
MOVES = 4
BETWEEN = 1e-9  # of the largest gap: so far behind a stop a flight is still between them
LARGEST = 10  # error, in units of what rounding the data does
CHAOS = 1e-8  # part of a time by which rounding moves it, from which on nothing is compared
PERIODS = 4
NEAR = 0.5  # of a flight: a contact farther than this from the impact that was found is another one
SAMPLES = 2000  # of a flight, at which the reference says that it stays between the stops


class Flight:
    """All flights of one oscillator, of mpf: sums of exponentials. held: while a stop holds the gap."""

    def __init__(self, q, constrained=False):
        n = q.masses
        self.n, self.normal = n, [mpf(a) for a in q.contact.normal]
        M, rows = mp.matrix(q.M.tolist()), np.hstack([-q.K, -q.C, np.stack([q.sine, q.cosine, q.constant], -1)])
        push = mp.lu_solve(M, mp.matrix(self.normal))
        self.push = push / mp.fdot(self.normal, push)
        rows = mp.inverse(M) * mp.matrix(rows.tolist())
        self.pull = [mp.fdot(self.normal, rows.column(j)) for j in range(2 * n + 3)]  # acceleration of the gap
        if constrained:
            rows -= self.push * mp.matrix([self.pull])
        A = mp.zeros(2 * n + 3)
        for i in range(n):
            A[i, n + i] = 1
            for j in range(2 * n + 3):
                A[n + i, j] = rows[i, j]
        A[2 * n, 2 * n + 1], A[2 * n + 1, 2 * n] = q.omega, -q.omega
        self.roots, self.V = mp.eig(A)
        self.W = mp.inverse(self.V)
        self.tau, self.omega = q.tau, q.omega

    def parts(self, state, t):
        """Factors of e^{l s} in the flight from `state` at the time t."""
        phase = self.omega * t + self.tau
        z = mp.matrix([*state, mp.sin(phase), mp.cos(phase), mpf(1)])
        return self.W * z

    def at(self, parts, s):
        """State after the time s."""
        z = self.V * mp.matrix([c * mp.exp(root * s) for c, root in zip(parts, self.roots, strict=True)])
        return [z[i].real for i in range(2 * self.n)]

    def after(self, z, v, R):
        """The state after an impact at the speed v."""
        return z[: self.n] + [a - (1 + R) * v * p for a, p in zip(z[self.n :], self.push, strict=True)]

    def gap(self, z):
        return mp.fdot(self.normal, z[: self.n]), mp.fdot(self.normal, z[self.n :])

    def gaps(self, parts, times):
        """The gap at these times, rounded."""
        row = [mp.fdot(self.normal, [self.V[i, k] for i in range(self.n)]) for k in range(len(self.roots))]
        factors = np.array([complex(a * c) for a, c in zip(row, parts, strict=True)])
        return (factors @ np.exp(np.outer([complex(root) for root in self.roots], times))).real


def first_zero(flight, row, level, z, t, guess):
    """The time s near `guess` after t at which row . (state, sin, cos, 1) is `level`, in the flight from z at t."""
    parts, s = flight.parts(z, mpf(float(t))), mpf(float(guess))
    weights = [mp.fdot(row, flight.V.column(k)[: len(row)]) * part for k, part in enumerate(parts)]
    for _ in range(60):
        terms = [weight * mp.exp(root * s) for weight, root in zip(weights, flight.roots, strict=True)]
        step = ((mp.fsum(terms) - level) / mp.fsum(a * root for a, root in zip(terms, flight.roots, strict=True))).real
        s -= step
        if abs(step) < mpf(10) ** -35 * abs(s):
            return s
    raise AssertionError("Newton's method does not end")


def time_in_units(system, state, t, found, zero):
    """Error of the time `found` after t; zero: the exact one, of moved numbers and state, and of how far stops move."""
    with mp.workdps(DIGITS):
        rng, step = np.random.default_rng(1), mpf(system.b) * mp.ldexp(1, -53)
        exact = zero(*moved(system.linear, state, None), 0)
        others = [zero(*moved(system.linear, state, rng), sign * step) for sign in (1, -1, 1, -1)]
        unit = _largest([other - exact for other in others]) + math.ulp(t + found)
        return float(abs(mpf(float(found)) - exact) / unit)


def impacts_of(q, state, guesses, sides, walls=None, look=False):
    """Impacts (time, speed, state) next to those guessed, up to the first that is not there. look: none is before it.

    walls : by how much the stop that is hit is moved
    """
    flight, found = Flight(q), []
    t, z = mpf(0), [mpf(x) for x in [*state[0::2], *state[1::2]]]
    for i, (guess, side) in enumerate(zip(guesses, sides, strict=True)):
        wall, R = (q.contact.high, q.contact.R_high) if side > 0 else (q.contact.low, q.contact.R_low)
        wall += walls[i] if walls is not None else 0
        parts, s = flight.parts(z, t), mpf(float(guess)) - t
        if look and leaves_stops(q, flight, parts, s):
            return found
        guessed = s
        for _ in range(60):
            there = flight.at(parts, s)
            x, v = flight.gap(there)
            step = (x - wall) / v
            s -= step
            if abs(step) < mpf(10) ** -35 * (abs(s) + abs(t)):
                break
        else:
            return found
        if abs(s - guessed) > NEAR * guessed:
            return found
        there = flight.at(parts, s)
        x, v = flight.gap(there)
        t += s
        found.append((t, v, there))
        z = flight.after(there, v, R)
    return found


def leaves_stops(q, flight, parts, s):
    """Whether a flight passes a stop before the time s."""
    gaps = flight.gaps(parts, np.linspace(0, float(s), SAMPLES)[1:-1])
    stop_distance = BETWEEN * np.abs(gaps).max()
    return gaps.max() > float(q.contact.high) + stop_distance or gaps.min() < float(q.contact.low) - stop_distance


def strikes_until(q, state, hits, true, end):
    """Whether the flight after the impacts `true`, which are those of `hits`, passes a stop before `end`."""
    flight = Flight(q)
    t, z = after_impacts(flight, q, state, hits, true)
    return leaves_stops(q, flight, flight.parts(z, t), end - t)


def after_impacts(flight, q, state, hits, found):
    """Time and state after the last of the impacts found next to `hits`; without one, `state` at 0."""
    if not found:
        return mpf(0), [*state[0::2], *state[1::2]]
    t, v, z = found[-1]
    return t, flight.after(z, v, q.contact.R_high if hits["side"][len(found) - 1] > 0 else q.contact.R_low)


def moved(q, state, rng):
    """All numbers moved by one part in 2^53, up or down; without rng as they are."""
    part = mp.ldexp(1, -53)

    def one(value):
        value = np.atleast_1d(value)
        signs = rng.choice([-1, 1], value.shape) if rng else np.zeros(value.shape, int)
        if value.ndim == 2:
            signs = np.triu(signs) + np.triu(signs, 1).T
        return np.vectorize(lambda x, sign: mpf(float(x)) * (1 + int(sign) * part), otypes=[object])(value, signs)

    numbers = mapped(lambda name, value: one(value) if np.ndim(value) else one(value)[0], q)
    return numbers, list(one(state))


def study(seed) -> Report:
    """How many impacts of an oscillator were compared, and how large their errors are."""
    result = compared(seed)
    if "refused" in result:
        return new_report(drawn=1, refused=1, **{f"refused, {result['refused']}": 1})
    where = ", ".join(f"{name} {result[name]}" for name in ("seed", "masses", "ratio", "offset/b", "damper"))
    report = new_report(drawn=1, impacts=result.get("compared", 0))
    if "defect" in result:
        report.wrong.append(f"{where}: {result['defect']}")
    for name, error in result["errors"].items():
        report.counted[size("errors", error)] += 1
        if not error <= LARGEST:
            report.wrong.append(f"{where}: error of {name} {error:.3g}")
    return report


def compared(seed):
    """What is wrong with the first impacts of oscillator `seed`, in units of what rounding its numbers does."""
    system, state, report = drawn_stiff(seed)
    report |= {"seed": seed, "errors": {}}
    try:
        orbit = vs.simulate(system, state, PERIODS)
    except vs.ParameterError as error:
        return report | {"refused": error.key}
    if orbit.status != "ok":
        return report | {"refused": str(orbit.status)}
    hits = orbit.impacts[:COUNT]
    end = PERIODS * system.period if len(hits) < COUNT else None
    if len(orbit.sticking):
        hits, end = hits[hits["t"] < orbit.sticking["t_on"][0]], None
    return report | {"impacts": len(hits)} | judged(system, state, hits, seed, end)


def judged(system, state, hits, seed, end=None):
    """What is wrong with these impacts, said to be the first ones from `state`; end: and the only ones until then."""
    with mp.workdps(DIGITS):
        numbers = moved(system.linear, state, None)
        true = impacts_of(*numbers, hits["t"], hits["side"], look=True)
        missed = len(true) == len(hits) and end is not None and strikes_until(*numbers, hits, true, end)
        if (missed or len(true) < len(hits)) and is_decided(system, state, hits, true, seed, end):
            return {"errors": {}, "defect": "another impact"}
        errors, count = errors_of(system, state, hits, true, seed, MOVES)
        if max(errors.values()) > LARGEST:  # few moves may by accident do next to nothing to one of the numbers
            errors, count = errors_of(system, state, hits, true, seed, 4 * MOVES)
    return {"errors": errors, "compared": count}


def errors_of_first(system, state, count, periods=2):
    """Of the first impacts of an orbit that strikes so often before it rests: as `compared` finds them."""
    orbit = vs.simulate(system, state, periods)
    hits = orbit.impacts[:count]
    assert len(hits) == count and not np.any(orbit.sticking["t_on"] <= hits["t"][-1])
    with mp.workdps(DIGITS):
        true = impacts_of(*moved(system.linear, state, None), hits["t"], hits["side"], look=True)
        errors, compared = errors_of(system, state, hits, true, 1, MOVES)
    assert compared == count
    return errors


def is_decided(system, state, hits, true, seed, end=None):
    """Whether the data tell that the impact after those of `true` is not the one that was found, if there was one.

    They do not where rounding moves the gap by a tenth of what is missing: by how much it is past a stop before, or
    away from one where it was found to strike; nor where chaos or a graze comes before.
    """
    m, rng, q, gaps = len(true), np.random.default_rng(seed), system.linear, []
    step = mpf(system.b) * mp.ldexp(1, -53)
    if m and errors_of(system, state, hits[:m], true, seed, MOVES)[1] < m:
        return False
    times = np.linspace(float(true[-1][0]) if m else 0.0, hits["t"][m] if m < len(hits) else end, SAMPLES)[1:]
    for i in range(1 + MOVES):
        numbers, x = moved(q, state, rng if i else None)
        walls = [int(sign) * bool(i) * step for sign in rng.choice([-1, 1], m)]
        before = impacts_of(numbers, x, hits["t"][:m], hits["side"][:m], walls)
        if len(before) < m:
            return False
        flight = Flight(numbers)
        t, z = after_impacts(flight, numbers, x, hits, before)
        gaps.append(flight.gaps(flight.parts(z, t), times - float(t)))
    past = np.maximum(gaps[0] - float(q.contact.high), float(q.contact.low) - gaps[0])
    at = int(past[:-1].argmax())
    missing = past[at]
    if missing <= BETWEEN * np.abs(gaps[0]).max():  # it is between the stops until then
        at, missing = -1, abs(gaps[0][-1] - float(q.contact.high if hits["side"][m] > 0 else q.contact.low))
    return missing > 10 * max(abs(gap[at] - gaps[0][at]) for gap in gaps[1:])


def errors_of(system, state, hits, true, seed, moves):
    """Largest errors of times, speeds, positions and velocities, and of how many impacts: those before chaos."""
    rng, step, others = np.random.default_rng(seed), mpf(system.b) * mp.ldexp(1, -53), []
    for _ in range(moves):
        walls = [int(sign) * step for sign in rng.choice([-1, 1], len(hits))]
        others.append(impacts_of(*moved(system.linear, state, rng), hits["t"], hits["side"], walls))
    errors, n = {"t": 0.0, "v": 0.0, "x": 0.0, "xdot": 0.0}, system.linear.masses
    hits = hits[: min(map(len, [true, *others]))]  # up to a graze that rounding takes away
    for i, (hit, (t, v, z)) in enumerate(zip(hits, true[: len(hits)], strict=True)):
        effects = {"t": _largest([other[i][0] - t for other in others])}
        if effects["t"] > CHAOS * t:
            return errors, i
        effects["v"] = _largest([other[i][1] - v for other in others])
        found = {"t": ([hit["t"]], [t]), "v": ([hit["v1"]], [v]), "x": (hit["x"], z[:n]), "xdot": (hit["xdot"], z[n:])}
        for name, part in (("x", slice(0, n)), ("xdot", slice(n, 2 * n))):
            effects[name] = _largest(
                [a - b for other in others for a, b in zip(other[i][2][part], z[part], strict=True)]
            )
        for name, (values, exact) in found.items():
            unit = effects[name] + math.ulp(_largest([float(a) for a in exact]))
            apart = _largest([mpf(float(a)) - b for a, b in zip(values, exact, strict=True)])
            errors[name] = max(errors[name], float(apart / unit))
    return errors, len(hits)


def _largest(values):
    return max(map(abs, values))
