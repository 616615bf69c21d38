"""Several contacts and friction elements at once: the reference beside time stepping, another formulation of laws.

Moreau's scheme takes steps of one length, and the impulses of stops and friction over a step by the projected
Gauss-Seidel method. It converges with the first order in the step.
"""

from itertools import pairwise

import numpy as np
import pytest
from reference.events import simulate
from reference.machine import Contact, Friction, Harmonic, Machine, Stop, elements_of

DURATION, STEPS = 8.0, 8000
FAR = 3e-3


def drawn(seed):
    """Two or three masses, two contacts, the second rigid or compliant, and one or two friction elements."""
    rng = np.random.default_rng([seed, 83])
    N = int(rng.integers(2, 4))
    A, B = rng.normal(size=(2, N, N))
    K = B @ B.T + 0.3 * np.eye(N)
    soft = {"k": 20.0, "c": 0.3} if rng.random() < 0.5 else {"R": rng.uniform(0, 0.6)}
    first, second = rng.uniform(0.2, 0.6, 2)
    R = rng.uniform(0, 0.6)
    contacts = (
        Contact(np.eye(N)[0], (Stop(1, first, R=R), Stop(-1, -first, R=R))),
        Contact(np.eye(N)[1] - np.eye(N)[0], (Stop(1, second, **soft),)),
    )
    loads = rng.uniform(0.05, 0.4, 2)
    friction = (Friction(np.eye(N)[1], loads[0], loads[0]), Friction(np.eye(N)[0], loads[1], loads[1], 0.1))
    harmonics = (Harmonic(1, 1.2 * rng.normal(size=N), np.zeros(N)), Harmonic(3, np.zeros(N), 0.4 * rng.normal(size=N)))
    machine = Machine(
        np.eye(N) + 0.2 * A @ A.T, K, 0.05 * K, 0.3 * rng.normal(size=N), harmonics, rng.uniform(0.6, 1.5), 0.4,
        contacts, friction[: int(rng.integers(1, 3))],
    )  # fmt: skip
    start = np.zeros(2 * N)
    start[1::2] = rng.normal(size=N)
    return machine, start


def by_steps(machine, start, count):
    """The state at DURATION after so many steps of Moreau's scheme."""
    M, K, C = (np.array(a, float) for a in (machine.M, machine.K, machine.C))
    q, v, h = start[0::2].copy(), start[1::2].copy(), DURATION / count
    inverse, elements = np.linalg.inv(M), elements_of(machine)
    rows = np.array([element.row for element in elements])
    push = rows @ inverse
    yielding = (push * rows).sum(1)
    for step in range(count):
        t, middle = (step + 0.5) * h, q + h / 2 * v
        f = machine.constant - K @ middle - C @ v
        for harmonic in machine.harmonics:
            angle = harmonic.order * (machine.omega * t + machine.tau)
            f = f + harmonic.sine * np.sin(angle) + harmonic.cosine * np.cos(angle)
        active = []
        for e, element in enumerate(elements):
            if element.rubs:
                active.append(
                    (e, element.law.belt_speed, -h * element.law.friction_force, h * element.law.friction_force)
                )
                continue
            depth, speed = rows[e] @ middle - element.law.side * element.law.place, rows[e] @ v
            if depth > 0 and element.rigid:
                active.append((e, -element.law.R * max(speed, 0.0), 0.0, np.inf))
            elif depth > 0:
                f = f - rows[e] * (element.law.k * depth + element.law.c * speed)
        v, impulse = v + h * inverse @ f, np.zeros(len(elements))
        for _ in range(30):  # the impulse of each brings its speed to what the law wants, within its limits
            for e, wanted, least, most in active:
                before = impulse[e]
                impulse[e] = min(max(before + (rows[e] @ v - wanted) / yielding[e], least), most)
                v = v - push[e] * (impulse[e] - before)
        q = middle + h / 2 * v
    return np.column_stack([q, v]).ravel()


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 2, 3, 4, 6, 8])
def test_time_stepping_comes_to_the_same_end(seed):
    """In none of these orbits are two contacts struck at one instant, where the laws differ."""
    machine, start = drawn(seed)
    orbit = simulate(machine, start.tolist(), until=DURATION)
    hits, kinds = orbit.impacts, {event.kind for event in orbit.events}
    assert "impact" in kinds and kinds & {"stick", "slip"}
    assert not any(a.t == b.t and a.element != b.element for a, b in pairwise(hits))
    end = by_steps(machine, start, STEPS)
    assert np.abs(end - np.array(orbit.end, float)).max() < FAR
    other = machine._replace(
        friction=[one._replace(friction_force=0.8 * one.friction_force) for one in machine.friction]
    )
    assert np.abs(end - np.array(simulate(other, start.tolist(), until=DURATION).end, float)).max() > 3 * FAR
