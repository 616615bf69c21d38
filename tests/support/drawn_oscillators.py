"""Oscillators drawn at random: full matrices, stiff and soft masses, any laws of contact, the paper's whole range."""

import math

import numpy as np
from mpmath import mp
from reference import naive

import vibro_sweep as vs


def positive(rng, n, least):
    """A symmetric positive definite matrix."""
    A = rng.normal(size=(n, n))
    return A @ A.T / n + least * np.eye(n)


# Of drawn_paper: what is drawn more often than in the whole range.
ROUND = ("narrow", "any", "narrow", "stiff", "narrow", "sticking", "narrow", "little restitution")
PAPER_KINDS = (*ROUND, *ROUND, "narrow", "stiff", "any")


def swing(q) -> float:
    """Of the gap of a `vs.types.Linear` in the steady motion without stops."""
    return float(abs(q.contact.normal @ steady(q)))


def steady(q) -> np.ndarray:
    """Complex amplitudes X of the steady motion x = Re(X e^{i(omega t + tau)})."""
    return np.linalg.solve(q.K - q.omega**2 * q.M + 1j * q.omega * q.C, q.cosine - 1j * q.sine)


def drawn(seed, n, constant=True, contact_normal=None, **changes):
    """An oscillator whose free motion would pass both stops, and a state at rest between them.

    Damping is not proportional, the stops are unequal. Two masses meet each other (n = e1 - e2); of others the gap is
    any combination.
    """
    rng = np.random.default_rng([n, seed])
    numbers = dict(
        M=positive(rng, n, 1.0), K=positive(rng, n, 0.2), C=0.05 * positive(rng, n, 0.1),
        contact_normal=np.array([1.0, -1.0]) if n == 2 else rng.normal(size=n),
        force=3 * rng.normal(size=n), force_cos=2 * rng.normal(size=n), omega=0.8, tau=0.3,
        R=0.85, R_left=0.7, b=1.0,
    )  # fmt: skip
    numbers["constant"] = 0.2 * rng.normal(size=n) if constant else np.zeros(n)
    if contact_normal is not None:
        numbers["contact_normal"] = np.array(contact_normal, float)
    free = vs.Oscillator(**numbers).linear
    size, middle = swing(free), free.contact.normal @ np.linalg.solve(free.K, free.constant)
    numbers |= {"b": 0.45 * size, "offset": middle - 0.05 * size} | changes
    system = vs.Oscillator(**numbers)
    state = np.zeros(2 * n)
    state[0::2] = np.linalg.lstsq(free.contact.normal[None], [system.offset], rcond=None)[0]
    return system, state


def drawn_stiff(seed):
    """An oscillator with masses held stiffly and softly and stops far from the origin, its state, and what it is."""
    rng = np.random.default_rng([28, seed])
    n = int(rng.choice([2, 2, 3, 4]))
    ratio, far = 10.0 ** rng.uniform(0, 12), 10.0 ** rng.uniform(0, 3) * rng.choice([-1, 1]) * (rng.random() < 0.7)
    stiff = rng.permutation(n) < rng.integers(1, n)  # at least one mass, but not all
    M = np.diag(rng.uniform(0.5, 2, n)) if rng.random() < 0.6 else positive(rng, n, 0.3)
    springs = np.where(stiff, ratio * rng.uniform(0.5, 1, n), 0.0)
    K = positive(rng, n, 0.3) + np.diag(springs)
    C = rng.choice([0.0, 0.05]) * positive(rng, n, 0.3)
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
    b = float(swing(vs.Oscillator(**numbers).linear) * 10.0 ** rng.uniform(-1.5, -0.3))
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


def stop_of(rng, mass):
    """k_stop, c_stop and preload of a stop; z, the damping ratio of the gap's mass on it: 0, or 0.01 to 3."""
    k, z = 10 ** rng.uniform(-1, 8), rng.choice([0, 10 ** rng.uniform(-2, 0.5)])
    preload = rng.choice([0, 10 ** rng.uniform(-2, 0.5)])
    return {"k_stop": k * mass, "c_stop": 2 * z * math.sqrt(k) * mass, "preload": preload}


def drawn_compliant(seed):
    """An oscillator of one to four masses with any laws of contact, and a start; one in five begins inside a stop."""
    rng = np.random.default_rng([seed, 20])
    N = int(rng.integers(1, 5))
    A, B = rng.normal(size=(2, N, N))
    M = np.eye(N) + 0.3 * A @ A.T if rng.random() < 0.5 else np.diag(rng.uniform(0.5, 3, N))
    K = B @ B.T + 0.2 * np.eye(N)
    normal = np.eye(N)[0] if rng.random() < 0.6 else rng.normal(size=N)
    mass = 1 / (normal @ np.linalg.solve(M, normal))
    stops = str(rng.choice(["both", "right"]))
    laws = stop_of(rng, mass) | {"release": str(rng.choice(["displacement", "force"]))}
    if stops == "both":
        kind = rng.integers(3)  # the same law as on the right, another one, or a rigid stop
        left = [{}, {f"{name}_left": x for name, x in stop_of(rng, mass).items()}, {"R_left": rng.uniform(0.2, 1)}]
        laws |= left[kind]
    numbers = dict(force=rng.normal(size=N), omega=rng.uniform(0.4, 2), b=rng.uniform(0.05, 0.5), tau=rng.uniform(0, 6))
    system = vs.Oscillator(M, K, rng.uniform(0, 0.2) * K, contact_normal=normal, stops=stops, **numbers, **laws)
    start = np.zeros(2 * N)
    start[1::2] = 0.5 * rng.normal(size=N)
    if rng.random() < 0.2:
        start[0::2] = normal / (normal @ normal) * system.b * (1 + 10 ** rng.uniform(-6, 0.3))
    return system, start


def drawn_with_a_stiff_spring(seed, masses, damping):
    """One spring far stiffer than the others, along any direction, and dampers of any size."""
    rng = np.random.default_rng([masses, seed])
    link = rng.normal(size=masses)
    K = positive(rng, masses, 0.2) + 10.0 ** rng.uniform(7, 8) / (link @ link) * np.outer(link, link)
    C = 0.05 * positive(rng, masses, 0.1)
    if damping == "strong":
        C = C + 10.0 ** rng.uniform(3, 4) / (link @ link) * np.outer(link, link)
    along = np.eye(masses)[0] if rng.random() < 0.5 else rng.normal(size=masses)
    system = vs.Oscillator(
        positive(rng, masses, 1.0), K, C, contact_normal=along, force=rng.normal(size=masses),
        constant=0.1 * rng.normal(size=masses), omega=0.8, tau=float(rng.uniform(-3, 3)),
        b=10.0 ** rng.uniform(-1.5, 0), R=0.8, R_left=0.6,
    )  # fmt: skip
    return system, np.zeros(2 * masses)


def one_mass(**numbers):
    """A free mass, unless the numbers say otherwise."""
    return vs.Oscillator(**(dict(M=[[1.0]], K=[[0.0]], contact_normal=[1.0]) | numbers))


def fastest_rate(mu_m, mu_k, zeta) -> tuple[list[float], float]:
    """Squares of the paper's natural frequencies, and the fastest rate of its free motion."""
    squares = vs.System(mu_m=mu_m, mu_k=mu_k, zeta=0, f2=0, omega=1.2345, R=1, b=1, tau=0).modes.omega_squared
    eta = zeta * squares[1]
    return squares, max(eta + math.sqrt(max(eta**2 - squares[1], 0.0)), math.sqrt(squares[1]))


def drawn_paper(n):
    """The paper's oscillator over its whole range, number n -> (numbers of the system, state, start time)."""
    rng = np.random.default_rng([11, n])
    kind = PAPER_KINDS[n % len(PAPER_KINDS)]

    def power(low, high):
        return 10.0 ** rng.uniform(low, high)

    def one_of(*choices):
        return choices[rng.integers(len(choices))]

    wide = rng.random() < 0.5
    mu_m, mu_k = (power(-6, 6), power(-6, 6)) if wide else (power(-1.5, 1.5), power(-1.5, 1.5))
    mu_k = (1.0 + mu_k) - 1.0  # what is left of it in the stiffness matrix, whose 1 + mu_k is rounded
    zeta = one_of(0.0, power(-6, 1), power(-6, 1), rng.uniform(0, 0.3))
    squares, rate = fastest_rate(mu_m, mu_k, zeta)
    omega = one_of(power(-3, 3), math.sqrt(one_of(*squares)) * power(-1, 1), power(-1, 0.5))
    R = one_of(0.0, 1.0, rng.uniform(0, 1), rng.uniform(0, 1), rng.uniform(0, 1), power(-20, -1), 1 - power(-12, -1))
    f2 = one_of(0.0, 1.0, rng.uniform(0, 1))
    clearance = one_of(power(-6, 0.0), power(-2, 0), rng.uniform(0, 1.1))
    if kind == "sticking":
        R, clearance, omega = rng.uniform(0, 0.6), power(-3, -0.2), math.sqrt(squares[0]) * power(-1.5, 0)
        zeta = one_of(0.0, power(-4, 0))
    elif kind == "little restitution":
        R = one_of(0.0, rng.uniform(0, 0.1), rng.uniform(0, 0.1), power(-12, -1), power(-300, -12))
    elif kind == "stiff":
        omega = rate * 2 * math.pi / power(3.95, 6.95)
    elif kind == "narrow":
        clearance, R = power(-6, -2), one_of(1.0, rng.uniform(0.2, 1), rng.uniform(0.2, 1), R)
    omega = min(max(omega, 1e-3), 1e3)

    with mp.workdps(40):
        response = naive.response(dict(mu_m=mu_m, mu_k=mu_k, zeta=zeta, f2=f2, omega=omega))
    d, e = ([float(part) for part in parts] for parts in zip(*((x.real, x.imag) for x in response), strict=True))
    b_star, size = math.hypot(d[0], e[0]), math.hypot(d[1], e[1])
    stops = one_of("both", "both", "both", "right", "left") if kind != "narrow" else "both"
    tau = one_of(0.0, rng.uniform(-math.pi, math.pi), rng.uniform(-math.pi, math.pi))
    start_time = one_of(0.0, 0.0, 0.0, rng.uniform(-1, 3) * 2 * math.pi / omega)
    place = one_of("anywhere", "anywhere", "origin", "at rest on a stop", "moving on a stop", "graze")
    if kind == "narrow" and rng.random() < 0.8:
        place = one_of("anywhere", "moving on a stop")
    if place == "graze":
        clearance = 1 + one_of(1, -1, -1) * power(-16, -1)
    b = clearance * b_star
    side = {"both": one_of(1.0, -1.0), "right": 1.0, "left": -1.0}[stops]
    scale = one_of(b, size, b)
    v1, x2, v2 = rng.normal(size=3) * power(-2, 0.5) * scale * np.array([omega, 1, omega])
    if kind == "narrow":
        v1 = one_of(1, -1) * 4 * b * max(4 * omega, rate) * power(0.2, 2)  # across the clearance within a cell
    state = [rng.uniform(-b, b), v1, x2, v2]
    if place == "origin":
        state = [0.0] * 4
    elif place == "at rest on a stop":
        state[:2] = side * b, 0.0
    elif place == "moving on a stop":
        state[0] = side * b
    elif place == "graze":
        start_time = 0.0
        phase = one_of(side * math.pi / 2, rng.uniform(-math.pi, math.pi))  # pi/2: x1 at its largest
        tau = phase - math.atan2(e[0], d[0])
        sin, cos = math.sin(tau), math.cos(tau)
        state = [d[0] * sin + e[0] * cos, omega * (d[0] * cos - e[0] * sin)]
        state += [d[1] * sin + e[1] * cos, omega * (d[1] * cos - e[1] * sin)]
        state[0] = min(max(state[0], -b), b)
    numbers = dict(mu_m=mu_m, mu_k=mu_k, zeta=zeta, f2=f2, omega=omega, R=R, b=b, tau=tau, stops=stops)
    return numbers, tuple(map(float, state)), float(start_time)
