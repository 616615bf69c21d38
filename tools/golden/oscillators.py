"""Oscillators drawn at random, of groups that need the same kernels; each with the state from which it is simulated."""

from typing import NamedTuple

import numpy as np

PAPER = dict(type="two_mass", mu_m=10.0, mu_k=5.0, zeta=0.05, f2=0.25, omega=0.63, R=0.8, b=4.0)
DIGITS = 4  # of drawn numbers
STIFF = 50.0  # springs


class Group(NamedTuple):
    masses: int
    compliant: bool  # whether some stops are
    constant: bool  # whether there is a constant force
    count: int  # of simulated oscillators


GROUPS = {
    "one mass, rigid": Group(1, False, True, 16),
    "one mass, compliant": Group(1, True, True, 30),
    "two masses, rigid": Group(2, False, False, 26),
    "two masses, rigid, constant force": Group(2, False, True, 12),
    "two masses, compliant": Group(2, True, False, 22),
    "two masses, compliant, constant force": Group(2, True, True, 12),
    "three masses, rigid": Group(3, False, False, 12),
    "three masses, rigid, constant force": Group(3, False, True, 8),
    "three masses, compliant": Group(3, True, False, 12),
    "three masses, compliant, constant force": Group(3, True, True, 8),
    "four masses, rigid, constant force": Group(4, False, True, 8),
    "four masses, compliant": Group(4, True, False, 8),
    "five masses, rigid": Group(5, False, False, 3),
    "six masses, compliant, constant force": Group(6, True, True, 2),
    "seven masses, compliant": Group(7, True, False, 3),
    "eight masses, rigid, constant force": Group(8, False, True, 2),
}


def drawn(group: Group, rng) -> tuple[dict, list[float]]:
    """The numbers of an oscillator and a state between its stops, or pressed into a compliant one."""
    n = group.masses
    M = np.diag(rng.uniform(0.5, 3, n)) if rng.random() < 0.5 else np.eye(n) + 0.3 * _positive(rng, n)
    K, C = _held(rng, n, M)
    normal = np.eye(n)[0] if rng.random() < 0.5 else rng.normal(size=n)
    numbers = {
        "type": "linear", "M": M, "K": K, "C": C, "contact_normal": normal, "force": rng.normal(size=n),
        "omega": rng.uniform(0.4, 2), "b": rng.uniform(0.05, 0.5),
        "stops": str(rng.choice(["both", "both", "right", "left"])),
    }  # fmt: skip
    if rng.random() < 0.6:
        numbers["tau"] = rng.uniform(0, 6)
    if group.constant and (n > 1 or rng.random() < 0.6):
        numbers["constant"] = 0.3 * rng.normal(size=n)
    if rng.random() < 0.5:
        numbers["offset"] = rng.uniform(-0.5, 0.5) * numbers["b"] * (3.0 if group.constant else 1.0)
    mass = 1 / (normal @ np.linalg.solve(M, normal))
    numbers |= _compliant_laws(rng, mass, numbers["stops"]) if group.compliant else _rigid_laws(rng)
    state = _between(rng, n, normal, numbers)
    return {name: _rounded(value) for name, value in numbers.items()}, _rounded(state)


def _positive(rng, n: int) -> np.ndarray:
    A = rng.normal(size=(n, n))
    return A @ A.T


def _held(rng, n: int, M) -> tuple[np.ndarray, np.ndarray]:
    """K and C; of some oscillators one mass is held so stiffly that rates lie up to 10^8 apart."""
    K = _positive(rng, n) + 0.2 * np.eye(n)
    C = rng.choice([0.0, 0.02, 0.1, 0.2]) * K
    if n > 1 and rng.random() < 0.3:
        held = np.arange(n) == rng.integers(n)
        springs = held * 10.0 ** rng.uniform(2, 13)
        ratio = rng.choice([0.0, 0.05, 2.0, 30.0])
        K, C = K + np.diag(springs), C + np.diag(ratio * np.sqrt(springs * np.diag(M)))
    return K, C


def _rigid_laws(rng) -> dict:
    laws = {"R": rng.choice([0.0, 1.0, rng.uniform(0.02, 0.3), *rng.uniform(0.3, 0.98, 3)])}
    return laws | ({"R_left": rng.uniform(0.0, 1.0)} if rng.random() < 0.3 else {})


def _compliant_laws(rng, mass: float, stops: str) -> dict:
    laws = _stop(rng, mass) | {"release": str(rng.choice(["displacement", "force"]))}
    if stops != "both":
        return laws
    other = {f"{name}_left": value for name, value in _stop(rng, mass).items()}
    return laws | ({}, other, {"R_left": rng.choice([0.0, 1.0, rng.uniform(0.2, 0.9)])})[rng.integers(3)]


def _stop(rng, mass: float) -> dict:
    """k_stop, c_stop and preload; the damping ratio of the gap's mass on it is 0, or 0.01 to 3."""
    k, ratio = 10 ** rng.uniform(-1, 8), rng.choice([0, 10 ** rng.uniform(-2, 0.5)])
    preload = rng.choice([0, 0, 10 ** rng.uniform(-2, 0.5)])
    return {"k_stop": k * mass, "c_stop": 2 * ratio * np.sqrt(k) * mass, "preload": preload}


def _between(rng, n: int, normal, numbers) -> np.ndarray:
    """A state between the stops, or in a compliant one; masses that are held stiffly are at rest."""
    state = np.zeros(2 * n)
    pressed = "k_stop" in numbers and rng.random() < 0.2
    share = 1.0 + 10 ** rng.uniform(-4, -1) if pressed else rng.uniform(-0.9, 0.9)
    if numbers["stops"] == "left":
        share = -share
    state[0::2] = normal / (normal @ normal) * (numbers.get("offset", 0.0) + share * numbers["b"])
    state[1::2] = 0.5 * rng.normal(size=n) * (np.diag(numbers["K"]) < STIFF)
    return state


def _rounded(value):
    """As JSON has it, of few digits."""
    if isinstance(value, str):
        return value
    value = np.asarray(value, float)
    return np.vectorize(lambda x: float(f"{x:.{DIGITS}g}"), otypes=[float])(value).tolist()
