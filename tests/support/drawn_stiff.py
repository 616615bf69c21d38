"""Oscillators with masses held stiffly and softly, and stops far from the origin."""

import numpy as np

import vibro_sweep as vs
from vibro_sweep.model.linear import amplitudes


def positive(rng, n):
    A = rng.normal(size=(n, n))
    return A @ A.T / n + 0.3 * np.eye(n)


def drawn(seed):
    """Oscillator number `seed`, its state at t = 0, and what it is."""
    rng = np.random.default_rng([28, seed])
    n = int(rng.choice([2, 2, 3, 4]))
    ratio, far = 10.0 ** rng.uniform(0, 12), 10.0 ** rng.uniform(0, 3) * rng.choice([-1, 1]) * (rng.random() < 0.7)
    stiff = rng.permutation(n) < rng.integers(1, n)  # at least one mass, but not all
    M = np.diag(rng.uniform(0.5, 2, n)) if rng.random() < 0.6 else positive(rng, n)
    springs = np.where(stiff, ratio * rng.uniform(0.5, 1, n), 0.0)
    K = positive(rng, n) + np.diag(springs)
    C = rng.choice([0.0, 0.05]) * positive(rng, n)
    damper = rng.choice(["none", "little", "critical", "strong"])
    share = {"none": 0.0, "little": 0.05, "critical": 2.0, "strong": 10.0 ** rng.uniform(0.5, 2)}[damper]
    C = C + np.diag(share * np.sqrt(springs * np.diag(M)))
    if rng.random() < 0.7:
        i, j = rng.choice(np.flatnonzero(stiff)), rng.choice(np.flatnonzero(~stiff))
        along = (np.arange(n) == i) - 1.0 * (np.arange(n) == j)
    else:
        along = rng.normal(size=n)
    force = np.where(stiff & (rng.random(n) < 0.5), 0.0, rng.normal(size=n))
    soft = np.linalg.eigvalsh(np.linalg.solve(np.diag(np.sqrt(np.diag(M))), K) / np.sqrt(np.diag(M)))[0]
    omega = float(np.sqrt(max(soft, 0.1)) * 10.0 ** rng.uniform(-0.3, 0.3))
    numbers = dict(M=M, K=K, C=C, contact_normal=along, force=force, omega=omega, tau=float(rng.uniform(-3, 3)),
                   R=float(rng.uniform(0.5, 0.95)), b=1.0)  # fmt: skip
    if rng.random() < 0.3:
        numbers["R_left"] = float(rng.uniform(0.5, 0.95))
    if rng.random() < 0.2:
        numbers["stops"] = "right"
    q = vs.Oscillator(**numbers).linear
    size = abs(q.normal @ amplitudes(q))
    b = float(size * 10.0 ** rng.uniform(-1.5, -0.3))
    offset = far * b
    x = along * 0.0
    if offset:
        soft_held = np.linalg.solve(K, along)
        x = soft_held * (offset / (along @ soft_held))
        numbers["constant"] = K @ x
    system = vs.Oscillator(**numbers | {"b": b, "offset": float(offset)})
    state = np.zeros(2 * n)
    state[0::2] = x
    return system, state, {"masses": n, "ratio": ratio, "offset/b": far, "damper": str(damper)}
