"""Special points and changes of stability along a branch, by monodromy matrices that do not come from the engine."""

from operator import attrgetter

import numpy as np
from reference.machine import machine_of
from reference.saltation import expm, field, monodromy, normal_and_push

NEAR = 1e-6  # distance of a multiplier from the unit circle within which it counts as on neither side
MEETS = 1e-6  # distance of a critical multiplier from where it should be
SAMPLES = 48  # of a flight


class Pieces:
    """Multipliers of all points of a branch, over half the period where the orbits are symmetric.

    multipliers : (points, 2N)
    sure : (points,) whether rounding leaves no doubt on which side of the unit circle they are
    off : (points,) by how much the equations of each orbit are not met
    """

    def __init__(self, branch, case):
        self.branch, self.case, points = branch, case, branch.points
        middle = branch.orbit(points.sizes["point"] // 2)  # at an end it may be that of another branch
        self.symmetric = middle.symmetric
        self.values = points[case.name].values
        system = case.orbit.system
        self.oscillators = [system.replace(**{case.name: float(value)}).linear for value in self.values]
        t, v = points.impact_t.values, points.impact_v.values
        sides = points.impact_side.values[0].astype(int)
        half_periods = middle.period * (1 if self.symmetric else 2)
        periods = half_periods * np.pi / np.array([q.omega for q in self.oscillators])
        self.sigma = -1 if self.symmetric else 1
        if self.symmetric:
            K = len(sides) // 2
            t, v, sides = t[:, :K], v[:, :K], sides[:K]
        self.t, self.v, self.sides, self.periods = t, v, sides, periods
        with np.errstate(all="ignore"):
            found = monodromy([machine_of(q) for q in self.oscillators], self.sigma, periods, t, sides, v)
        self.off, self.states, matrix = found.off, found.states, found.matrix
        finite = np.all(np.isfinite(matrix), axis=(1, 2))
        self.multipliers = np.full(matrix.shape[:2], np.nan, complex)
        values, vectors = np.linalg.eig(matrix[finite])
        self.multipliers[finite] = values
        kappa = np.ones(matrix.shape[:2])
        with np.errstate(all="ignore"):
            kappa[finite] = np.linalg.norm(np.linalg.pinv(vectors), axis=2)  # of unit vectors: conditions
        self.doubt = 1e-12 * np.linalg.norm(matrix, axis=(1, 2))[:, None] * kappa + NEAR * (1 + 0 * kappa)
        self.sure = finite & np.all(np.abs(np.abs(self.multipliers) - 1) > self.doubt, axis=1)

    @property
    def counts(self) -> np.ndarray:
        """(points, 3) real multipliers above 1 and below -1, complex pairs outside."""
        mu = self.multipliers
        real = np.abs(mu.imag) <= 1e-9 * np.abs(mu)
        return np.stack([
            np.sum(real & (mu.real > 1), axis=1), np.sum(real & (mu.real < -1), axis=1),
            np.sum(~real & (np.abs(mu) > 1) & (mu.imag > 0), axis=1),
        ], axis=1)  # fmt: skip

    @property
    def losses(self) -> bool:
        """Whether areas shrink: else multipliers stay on the circle."""
        return bool(np.abs(np.abs(np.prod(self.multipliers, axis=1)) - 1).min() > 1e-6)


def places(branch, case) -> list[int]:
    """The point of each special point, -1 for those that are not on the branch."""
    values, found, least = branch.points[case.name].values, [], 0
    for special in branch.special:
        there = np.flatnonzero(values[least:] == special.parameters[case.name])
        least += int(there[0]) if len(there) else 0
        found.append(least if len(there) else -1)
    return found


def unexplained(pieces: Pieces) -> list[tuple[str, str]]:
    """Changes of stability between neighbouring points that no special point between them explains."""
    branch, case = pieces.branch, pieces.case
    if not len(pieces.sides) or not pieces.losses:
        return []
    at = places(branch, case)
    counts, found = pieces.counts, []
    usable = np.flatnonzero(pieces.sure & (pieces.off < 1e-6))
    specials = [(k, one.type) for k, one in zip(at, branch.special, strict=True) if k >= 0]
    usable = usable[~np.isin(usable, at)]
    for a, b in zip(usable[:-1].tolist(), usable[1:].tolist(), strict=True):
        inner = [kind for k, kind in specials if a < k < b and kind in ("fold", "flip", "pitchfork", "neimark_sacker")]
        if not explains(counts[a], counts[b], inner):
            value = pieces.values
            found.append(
                (
                    "change of stability",
                    f"above, below, pairs {counts[a]} to {counts[b]} between {value[a]!r} and {value[b]!r} "
                    f"(points {a}, {b}) with {inner or 'nothing'}",
                )
            )
    return found


def explains(before, behind, kinds) -> bool:
    """Whether special points change the numbers of multipliers outside so, up to real ones that become a pair."""
    sets = {tuple(map(int, before))}
    for kind in kinds:
        moves = {"fold": (1, 0, 0), "flip": (0, 1, 0), "pitchfork": (0, 1, 0), "neimark_sacker": (0, 0, 1)}[kind]
        sets = _met(
            {tuple(x + sign * y for x, y in zip(one, moves, strict=True)) for one in _met(sets) for sign in (-1, 1)}
        )
    return tuple(map(int, behind)) in _met(sets)


def _met(sets):
    """With all that collisions outside the circle make of them: two real ones of one sign become a pair, or reverse."""
    sets = {one for one in sets if min(one) >= 0}
    while True:
        more = {
            (a + x, b + y, c + z) for a, b, c in sets for x, y, z in ((2, 0, -1), (-2, 0, 1), (0, 2, -1), (0, -2, 1))
        }
        more = {one for one in more if min(one) >= 0} - sets
        if not more:
            return sets
        sets |= more


def at_point(orbit):
    """(`MapOverPeriod`, q, t, sides, v, P) of a periodic orbit, over half the period if it is symmetric."""
    q, impacts = orbit.system.linear, orbit.impacts
    sigma = -1 if orbit.symmetric else 1
    K = len(impacts) // 2 if orbit.symmetric else len(impacts)
    period = orbit.period * (np.pi if orbit.symmetric else 2 * np.pi) / q.omega
    t, sides, v = impacts["t"][:K], impacts["side"][:K], impacts["v1"][:K]
    with np.errstate(all="ignore"):
        found = monodromy([machine_of(q)], sigma, np.array([period]), t[None], sides, v[None])
    return found, q, t, sides, v, period


def distance(special) -> tuple[float, str]:
    """How far a special point is from its condition, and words; nan where nothing is checked."""
    orbit = special.orbit
    if special.type in ("boundary", "closed", "failed", "sticking"):
        return np.nan, ""
    found, q, t, sides, v, period = at_point(orbit)
    size = max(np.abs(found.states).max(), 1e-300)
    if special.type == "graze":
        speed = np.abs(v).min(initial=np.inf) / (q.omega * size)
        gap = _nearest(found, q, t, sides, v, period) / size
        return float(min(speed, abs(gap)) if special.impact is None else speed), f"speed {speed:.1e}, gap {gap:.1e}"
    mu = np.linalg.eigvals(found.matrix[0])
    if special.type == "fold":
        far = np.abs(mu - 1).min()
    elif special.type in ("flip", "pitchfork"):
        far = np.abs(mu + 1).min()
        if special.type == "pitchfork" and not orbit.symmetric:
            return np.inf, "the orbit of a pitchfork is not symmetric"
    else:
        pairs = mu[np.abs(mu.imag) > 1e-9]
        far = np.abs(np.abs(pairs) - 1).min(initial=np.inf)
    return float(far), f"multipliers {np.array2string(mu, precision=9)}"


def flown(found, q, t, sides, v, period, k, lengths):
    """(len(lengths), 2N + 3) states at these times after impact k."""
    N = q.masses
    if len(t):
        _, push = normal_and_push(machine_of(q))
        one_plus_R = 1 + (q.contact.R_high if sides[k] > 0 else q.contact.R_low)
        x, at = found.states[0, k].copy(), t[k]
        x[N:] -= one_plus_R * v[k] * push
    else:
        x, at = found.states[0, 0], 0.0
    phase = q.omega * at + q.tau
    z = np.concatenate([x, [np.sin(phase), np.cos(phase), 1.0]])
    return expm(field(machine_of(q))[None] * np.asarray(lengths)[:, None, None]) @ z


def _nearest(found, q, t, sides, v, period) -> float:
    """The least distance of the gap's turning points from a stop."""
    N, best = q.masses, np.inf
    # of the free motion a little more than a period: with the phase `grazing` a turning point lies at its ends
    ends = np.append(t, t[0] + period) if len(t) else np.array([0.0, 1.01 * period])
    for k in range(len(ends) - 1):
        s = np.linspace(0, ends[k + 1] - ends[k], 400)
        z = flown(found, q, t, sides, v, period, k, s)
        rate = z[:, N : 2 * N] @ q.contact.normal
        turns = np.flatnonzero(rate[:-1] * rate[1:] <= 0)
        for i in turns.tolist():
            low, high = s[i], s[i + 1]
            if i == 0 and len(t):
                continue
            for _ in range(60):  # by halves
                middle = (low + high) / 2
                there = flown(found, q, t, sides, v, period, k, [middle])[0]
                low, high = (middle, high) if (there[N : 2 * N] @ q.contact.normal) * rate[i] > 0 else (low, middle)
            g = there[:N] @ q.contact.normal
            best = min(best, abs(q.contact.high - g), abs(g - q.contact.low), key=abs)
    return best


def passing(pieces: Pieces) -> list[tuple[str, str]]:
    """Points of a branch at which a flight is beyond a stop."""
    q0, K = pieces.oscillators[0], len(pieces.sides)
    N, m = q0.masses, len(pieces.values)
    machines = [machine_of(q) for q in pieces.oscillators]
    A = np.array([field(machine) for machine in machines])
    along, push = np.swapaxes([normal_and_push(machine) for machine in machines], 0, 1)
    omega, tau, low, high = (
        np.array([attrgetter(name)(q) for q in pieces.oscillators], float)
        for name in ("omega", "tau", "contact.low", "contact.high")
    )
    t = pieces.t if K else np.zeros((m, 1))
    ends = np.concatenate([t[:, 1:], (t[:, 0] + pieces.periods)[:, None]], axis=1)
    worst = np.full(m, -np.inf)
    for k in range(max(K, 1)):
        x = pieces.states[:, k].copy()
        if K:
            one_plus_R = np.array(
                [1 + (q.contact.R_high if pieces.sides[k] > 0 else q.contact.R_low) for q in pieces.oscillators]
            )
            x[:, N:] -= (one_plus_R * pieces.v[:, k])[:, None] * push
        phase = omega * t[:, k] + tau
        z = np.concatenate([x, np.stack([np.sin(phase), np.cos(phase), np.ones(m)], axis=1)], axis=1)
        E = expm(A * ((ends[:, k] - t[:, k]) / SAMPLES)[:, None, None])
        for _ in range(SAMPLES - 1):
            z = (E @ z[..., None])[..., 0]
            gap = np.sum(along * z[:, :N], axis=1)
            worst = np.maximum(worst, np.maximum(gap - high, low - gap))
    size = np.abs(pieces.states[..., :N]).max((1, 2))
    bad = np.flatnonzero((worst > 1e-9 * size) & (pieces.off < 1e-6))
    return [("passes a stop", f"at point {k}, {pieces.values[k]!r} by {worst[k]:.1e}") for k in bad[:1].tolist()]


def free_passes(branch, case) -> list[tuple[str, str]]:
    """Places between the ends of a branch without impacts where the free motion is beyond a stop."""
    if branch.points.sizes.get("impact", 0):
        return []
    values = branch.points[case.name].values
    system = case.orbit.system
    for value in np.linspace(values[0], values[-1], 2001)[1:-1].tolist():
        q = system.replace(**{case.name: value}).linear
        Z = q.K - q.omega**2 * q.M + 1j * q.omega * q.C
        size = abs(q.contact.normal @ np.linalg.solve(Z, q.cosine - 1j * q.sine))
        middle = q.contact.normal @ np.linalg.lstsq(q.K, q.constant)[0]
        over = max(middle + size - q.contact.high, q.contact.low - middle + size)
        if over > 1e-9 * size:
            return [
                ("free motion beyond a stop", f"at {value!r} by {over:.1e}, between {values[0]!r} and {values[-1]!r}")
            ]
    return []


def not_reduced(orbit, parameter) -> list[tuple[str, str]]:
    """Whether an orbit is a shorter one repeated, or symmetric, and does not say so."""
    q, n = orbit.system.linear, orbit.period
    T, found = 2 * np.pi / q.omega, []
    t = np.linspace(0, n * T, 41)[:-1] + 0.123
    x = orbit.sample(t)
    size = np.abs(x).max()
    for part in [part for part in range(1, n) if n % part == 0]:
        if np.abs(orbit.sample(t + part * T) - x)[:, ::2].max() < 1e-9 * size:
            found.append(("period not reduced", f"{orbit.itinerary} of period {n} has {part}"))
    mirrored = moved(orbit.system, parameter).linear.symmetric  # else the branch is of orbits without it
    if (
        mirrored
        and q.symmetric
        and n % 2
        and not orbit.symmetric
        and np.abs(orbit.sample(t + n * T / 2) + x)[:, ::2].max() < 1e-9 * size
    ):
        found.append(("symmetry not seen", f"{orbit.itinerary} of period {n}"))
    return found


def moved(system, parameter: str):
    """The oscillator with another value of a number, which is allowed."""
    value = getattr(system, parameter)
    return system.replace(**{parameter: 0.999 * value if value else 1e-3 * system.b})
