"""Closed orbits of the reference: each is an orbit of its simulator, multipliers are differences of its orbits."""

import pytest
from mpmath import mp, mpf
from reference.closed_orbit import ClosedOrbit
from reference.conditions import Condition
from reference.events import simulate
from reference.flow import FREE, HELD, RELAXING, SLIP
from reference.machine import Contact, Friction, Harmonic, Machine, Stop

STEP = mpf(10) ** -18


def driven(stops=(), friction=(), **numbers):
    """One mass with F sin(omega t + tau)."""
    n = dict(k=1, c=0.1, constant=0, F=1, omega=0.8, tau=0) | numbers
    return Machine(
        [[1]], [[n["k"]]], [[n["c"]]], [n["constant"]], (Harmonic(1, [n["F"]], [0]),), n["omega"], n["tau"],
        (Contact([1], tuple(stops)),) if stops else (), tuple(friction),
    )  # fmt: skip


MACHINES = {
    "impact": (driven([Stop(1, 0.5, R=0.5)]), {"impact"}),
    "rest": (driven([Stop(1, 0.3, R=0)], omega=0.5), {"impact", "rest", "leave"}),
    "contact": (driven([Stop(1, 0.5, k=29, c=1, p=0.1)]), {"touch", "release"}),
    "contact that ends by force": (driven([Stop(1, 0.5, k=29, c=2, by_force=True)]), {"touch", "relax"}),
    "stop that relaxes at the section": (
        driven([Stop(1, -0.2, k=2, c=9, by_force=True)], omega=1.5, tau=4.5), {"touch", "relax"}
    ),
    "stick and slip": (driven(friction=[Friction([1], 0.3, 0.4, 0.1)], F=0.4), {"stick", "slip-", "turn+"}),
    "turns": (driven(friction=[Friction([1], 0.1, 0.1)]), {"turn+", "turn-"}),
    "impact and friction": (driven([Stop(1, 0.5, R=0.5)], [Friction([1], 0.1, 0.1)]), {"impact", "turn+"}),
}  # fmt: skip


def steps_of(machine, orbit, begin, modes):
    """The events of an orbit as those of a `ClosedOrbit`, and their times from `begin` on."""
    steps, times, frictions = [], [], sum(len(contact.stops) for contact in machine.contacts)
    modes = list(modes)
    for event in orbit.events:
        if event.t <= begin:
            continue
        rubs = event.kind in ("stick", "slip")
        e, kind = (frictions if rubs else 0), event.kind
        if kind == "slip" and times and event.t - begin == times[-1]:  # an impact turns it
            steps[-1] = (*steps[-1], {e: SLIP[event.side]})
            modes[e] = SLIP[event.side]
            continue
        if kind == "slip":
            kind = ("turn" if modes[e] in SLIP.values() else "slip") + ("+" if event.side > 0 else "-")
            modes[e] = SLIP[event.side]
        elif kind == "stick":
            modes[e] = HELD
        elif kind == "release" and machine.contacts[0].stops[0].relaxes:
            kind = "relax"
        elif kind == "rest":  # in place of the impact before it
            steps.pop(), times.pop()
        steps.append((kind, e))
        times.append(event.t - begin)
    return steps, times


@pytest.mark.parametrize("name", MACHINES)
def test_multipliers_are_differences_of_orbits(name):
    machine, kinds = MACHINES[name]
    transient = 40
    with mp.workdps(50):
        first = simulate(machine, [0, 0], periods=transient)
        start, places = first.end, first.places[-1]
        orbit = simulate(machine, start, periods=1, places=places)
        modes = [RELAXING if places and places[0] > 0 else FREE] * len(machine.contacts)
        modes += [SLIP[1 if start[1] > friction.belt_speed else -1] for friction in machine.friction]
        steps, times = steps_of(machine, orbit, 0, modes)
        assert {kind for kind, *_ in steps} == kinds
        closed = ClosedOrbit(machine, steps, 1, modes=modes)
        state, times = closed.solve([*start, *(s for s in places if s > 0)], times)
        size = len(state)
        assert size == 3 or "relaxes at" not in name
        assert max(abs(a - b) for a, b in zip(state[:2], start, strict=True)) < mpf("1e-4")

        def mapped(state):
            orbit = simulate(machine, state[:2], periods=1, places=[*state[2:]] or [0] * len(places))
            return [*orbit.end, *orbit.places[-1][: size - 2]]

        assert max(abs(a - b) for a, b in zip(mapped(state), state, strict=True)) < mpf("1e-28")
        closure = closed.closure(state, times)
        for j in range(size):
            ends = [mapped([a + sign * STEP * (i == j) for i, a in enumerate(state)]) for sign in (1, -1)]
            column = [(a - b) / (2 * STEP) for a, b in zip(*ends, strict=True)]
            assert max(abs(closure[i, j] - a) for i, a in enumerate(column)) < mpf("1e-9")
        near = [a + mpf("1e-3") * (i == 0) for i, a in enumerate(state)]
        assert max(abs(a - b) for a, b in zip(closed.image(near, times), mapped(near), strict=True)) < mpf("1e-28")


def test_a_mirrored_half_of_an_orbit():
    """The map over a period is that over half of it, twice."""
    machine = driven([Stop(1, 0.8, R=0.5), Stop(-1, -0.8, R=0.5)])
    with mp.workdps(50):
        start = simulate(machine, [0, 0], periods=80).end
        orbit = simulate(machine, start, periods=1)
        times = [hit.t for hit in orbit.impacts]
        steps = [("impact", 0 if hit.side > 0 else 1) for hit in orbit.impacts]
        assert len(steps) == 2
        whole, half = ClosedOrbit(machine, steps, 1), ClosedOrbit(machine, steps[:1], mpf("0.5"), -1)
        squares = [mu * mu for mu in half.multipliers(*half.solve(start, times[:1]))]
        wanted = whole.multipliers(*whole.solve(start, times))
        assert max(min(abs(mu - a) for a in squares) for mu in wanted) < mpf("1e-28")


@pytest.mark.parametrize("kind", ["flip", "fold"])
def test_bifurcations_of_a_bouncing_ball(kind):
    """On a table A sin(t), gravity 1, an impact each period: from A = pi (1 - R)/(1 + R), a fold, to the flip at
    A^2 = (pi (1 - R)/(1 + R))^2 + 4 (1 + R^2)^2/(1 + R)^4. The gap is closed with the speed 2 pi/(1 + R)."""
    with mp.workdps(50):
        R = mpf(0.75)
        least = mp.pi * (1 - R) / (1 + R)
        wanted = mp.sqrt(least**2 + 4 * (1 + R**2) ** 2 / (1 + R) ** 4) if kind == "flip" else least
        A = wanted * (1 + mpf("1e-5"))
        t, v = mp.acos(least / A), R * 2 * mp.pi / (1 + R)  # of the impact, and the speed after it
        u = mp.pi  # from there to the section
        x = v * u - u**2 / 2 + A * (mp.sin(t) - mp.sin(t + u) + mp.cos(t) * u)
        state = [x, v - u + A * (mp.cos(t) - mp.cos(t + u))]

        def machine_at(change):
            return driven([Stop(-1, 0, R=R)], k=0, c=0, constant=-1, F=A + change[0], omega=1)

        condition = Condition(machine_at, 1, [("impact", 0)], 1, 1, t + u, [kind])
        closed = ClosedOrbit(machine_at([0]), *condition.of)
        there, times = closed.solve(state, [t + 2 * mp.pi])
        assert abs(closed.speed([*there, *times], 0) + 2 * mp.pi / (1 + R)) < mpf("1e-28")
        off, change = condition.solve(state, [t + 2 * mp.pi])
        assert change < 1e-20 and abs(off[0] - (wanted - A)) < 1e-12 * abs(A - wanted)
