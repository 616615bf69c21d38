"""Machines with several contacts and friction drawn at random, for the references."""

import numpy as np
from reference.machine import Contact, Friction, Harmonic, Machine, Stop


def drawn_machine(rng) -> tuple[Machine, list[float]]:
    """A machine of one to three masses with two elements or more, and a start."""
    N, contacts, rubbing = int(rng.integers(1, 4)), int(rng.integers(0, 3)), int(rng.integers(0, 3))
    contacts = max(contacts, 2 - rubbing)

    def between(low, high):
        return float(np.round(rng.uniform(low, high), 3))

    M = np.diag([between(0.5, 3) for _ in range(N)])
    if N > 1 and rng.random() < 0.3:
        M[0, 1] = M[1, 0] = between(-0.2, 0.2)
    springs = rng.normal(size=(N, N)).round(2)
    K = springs @ springs.T / 2 + np.diag([between(0.1, 2) for _ in range(N)])
    K = (K + K.T) / 2
    friction = []
    for _ in range(rubbing):
        row, kinetic = drawn_row(rng, N), between(0.02, 0.4)
        static = kinetic * float(rng.choice([1.0, between(1, 1.6)]))
        if all(row != [*one.direction] and row != [-a for a in one.direction] for one in friction):
            friction.append(Friction(row, kinetic, static, between(-0.5, 0.5) if rng.random() < 0.4 else 0.0))
    harmonics = [Harmonic(1, [between(-1, 1) for _ in range(N)], [between(-1, 1) for _ in range(N)])]
    if rng.random() < 0.3:
        harmonics.append(Harmonic(3, [between(-0.5, 0.5) for _ in range(N)], [0.0] * N))
    machine = Machine(
        M.tolist(), K.tolist(), (K * between(0, 0.1)).tolist(), [between(-0.3, 0.3) for _ in range(N)],
        tuple(harmonics), between(0.4, 2), between(-3, 3), tuple(drawn_contact(rng, N) for _ in range(contacts)),
        tuple(friction),
    )  # fmt: skip
    return machine, [between(-1, 1) if i % 2 else between(-0.09, 0.09) for i in range(2 * N)]


def drawn_row(rng, N: int) -> list[float]:
    row, i = [0.0] * N, int(rng.integers(N))
    row[i] = 1.0
    if N > 1 and rng.random() < 0.4:
        row[(i + 1) % N] = -1.0
    return row


def drawn_contact(rng, N: int) -> Contact:
    kind, b = rng.integers(4), round(float(rng.uniform(0.1, 1.5)), 3)
    sides = {"both": (1, -1), "right": (1,), "left": (-1,)}[
        str(rng.choice(["both", "right", "left"], p=[0.5, 0.25, 0.25]))
    ]
    return Contact(drawn_row(rng, N), tuple(drawn_stop(rng, kind, side, side * b) for side in sides))


def drawn_stop(rng, kind: int, side: int, place: float) -> Stop:
    if kind == 0:
        return Stop(side, place, R=round(float(rng.uniform(0, 1)), 3))
    k = float(10 ** rng.uniform(0.5, 4))
    c, p = float(2 * np.sqrt(k) * rng.uniform(0, 0.4)), round(float(rng.uniform(0.05, 0.6)), 3)
    if kind == 3:
        return Stop(side, place, k=k, c=c, p=p, by_force=bool(rng.random() < 0.5))
    return Stop(side, place, k=k, c=c, by_force=bool(kind == 2))
