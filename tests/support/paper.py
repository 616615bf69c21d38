"""The paper's scenes, and the numbers of the table "what the paper says / the map / the exact flow".

tests/paper/test_paper.py holds them. No number of the table is typed in but those that the paper prints (`PAPER`).
"""

import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

import vibro_sweep as vs
from support import ROOT
from support.scene_texts import parsed
from vibro_sweep.tables.outcomes import VALID

SCENES = ROOT / "configs" / "paper"
FIGURES = {  # scene: the kind of picture that the paper shows, and what else is worth a look
    "figure_02": ["phase-portrait"],
    "figure_03": ["history"],
    "figure_04": ["configuration"],
    "figure_06": ["bifurcation"],
    "figure_07": ["iteration", "convergence"],
    "figure_08": ["iteration", "convergence"],
    "figure_09": ["phase-portrait"],
    "figure_10": ["phase-portrait", "convergence"],
}
PAPER = {
    "b*": 6.7107356,
    "tau*": 2.229311,
    6.8: "period 1, no impacts (fig. 9)",
    6.69: "periodic (fig. 7)",
    6.68: "chaotic (fig. 8)",
    6.6: "chaotic (fig. 10)",
}
SYSTEM = "mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8"
MODELS = {
    "map, order 1": "dynamics: map",
    "  expanded at the printed b": f"dynamics: map\nexpand_at: {PAPER['b*']}",
    "map, order 2": "dynamics: map\norder: 2",
    "exact flow": "dynamics: flow",
}
STEP = 0.0002  # of figure 6
WIDTH = 1e-9  # to which an edge is bisected where it is one
OBSERVE = "observe: [section, lyapunov, impacts]\n"
PATIENT = "{transient: 4000, record: 4000}"
HASTY = "{transient: 1300, record: 200}"  # figure 6
LASTING = "{transient: 100000, record: 1000}"
STARTS = 40
FAR = 100  # an orbit of a map that comes here does not come back


class Runner:
    """Scenes from text to data, through the package's front door."""

    def __init__(self, workers):
        self.workers, self.folder = workers, tempfile.TemporaryDirectory()

    def __call__(self, model, orbit, start, b, tau=None):
        """Sections, exponents and impacts for one clearance, or for an array of them."""
        one = np.ndim(b) == 0
        sweep = "" if one else f"sweep: {{b: {{values: {[float(x) for x in b]}}}}}\n"
        numbers = [SYSTEM, *([f"b: {b!r}"] if one else []), *([f"tau: {float(tau)!r}"] if tau is not None else [])]
        system = f"system: {{{', '.join(numbers)}}}\n"
        text = f"{system}{model}\n{sweep}start: {start}\norbit: {orbit}\n{OBSERVE}"
        path = Path(self.folder.name) / "scene.h5"
        vs.run(parsed(text), path, workers=self.workers, mode="overwrite")
        with vs.open(path) as data:
            return data.load()


class Attractor(NamedTuple):
    kind: str  # what it is, in words
    starts: int  # that end on it
    exponent: float  # lambda_1
    error: float
    impacts: tuple[float, float]  # per forcing period, on the right and on the left

    def __str__(self):
        right, left = self.impacts
        if np.isnan(self.exponent):
            return f"{self.kind} [{self.starts}]"
        error = max(self.error, 1e-15)  # of rounding
        digits = min(-int(np.floor(np.log10(error))), 6)
        value = f"{self.exponent:+.{digits}f} +- {error:.0e}"
        return f"{self.kind}, lambda_1 = {value}, impacts/T {right:.3f} right {left:.3f} left [{self.starts}]"


def attractors(data, record) -> list[Attractor]:
    """Where the starts of one clearance end, the most frequent first; chaotic orbits are taken for one attractor."""
    exponent, error = data.lyapunov.values[:, 0], data.lyapunov_error.values[:, 0]
    impacts = np.stack([data.impacts_right.values, data.impacts_left.values], 1) / record
    away = ~bounded(data).values
    period = np.where(away, -1, data.period.values)
    kinds = []
    for p, right, left in sorted({(p, *np.round(i * p)) for p, i in zip(period, impacts, strict=True) if p > 0}):
        chosen = (period == p) & (np.round(impacts * p) == (right, left)).all(axis=1)
        what = f"period {p}, {right:.0f} + {left:.0f} impacts" if right + left else f"period {p}, no impacts"
        kinds.append((what, chosen, np.max(error[chosen])))
    if (period == 0).any():
        chosen, count = period == 0, np.count_nonzero(period == 0)
        spread = np.std(exponent[chosen], ddof=1) / np.sqrt(count) if count > 1 else error[chosen][0]
        sure = abs(np.mean(exponent[chosen])) > 2 * spread
        what = "chaotic" if np.mean(exponent[chosen]) > 0 else "quasi-periodic, or of a very long period"
        kinds.append((what if sure else "not periodic, chaotic or not", chosen, spread))
    found = [
        Attractor(what, int(chosen.sum()), np.mean(exponent[chosen]), spread, tuple(impacts[chosen].mean(axis=0)))
        for what, chosen, spread in kinds
    ]
    if away.any():
        found.append(Attractor("runs away to infinity", int(away.sum()), np.nan, np.nan, (np.nan, np.nan)))
    return sorted(found, key=lambda attractor: -attractor.starts)


def bounded(data):
    """Which orbits have not run away."""
    return data.status.isin(VALID) & (abs(data.x1).max("sample") < FAR)


def strikes(data) -> np.ndarray:
    """Which of them still strike a stop in the recorded periods."""
    return ((data.impacts_right + data.impacts_left > 0) & bounded(data)).values


def end_from_graze(run, model) -> tuple[float, float]:
    """(b, uncertainty) below which an orbit of the map from X* goes on striking the stops."""
    system = vs.System(**{k: float(v) for k, v in (pair.split(": ") for pair in SYSTEM.split(", "))}, b=6.7)
    _, _, x2, v2 = vs.grazing(system).state
    x1 = PAPER["b*"] if "expand_at" in model else vs.grazing(system).b
    start, low, high = f"{{x1: {x1!r}, x2: {x2!r}, v2: {v2!r}}}", 6.5, 6.9
    while high - low > WIDTH:
        b = np.linspace(low, high, 21)
        last = np.flatnonzero(strikes(run(model, HASTY, start, b)))[-1]
        low, high = b[last], b[last + 1]
    return (low + high) / 2, (high - low) / 2


class End(NamedTuple):
    """How far up impacting orbits go on."""

    most: float  # half of the starts still strike a stop
    last: float  # an orbit was found that does so for 1e5 periods
    off: float  # uncertainty of `last`, if no basin was missed


def end_from_elsewhere(run, model) -> End:
    """Up to which b there are impacting orbits.

    Followed upwards in the steps of figure 6; around where that ends, orbits from random starts that have lasted for a
    while are put to the test; and the last one to pass it is continued in ever smaller steps. Chaotic transients grow
    long towards the end, which therefore is no sharper than the test.
    """
    b = np.arange(6.7, 6.8 + STEP / 2, STEP)
    hits = np.flatnonzero(strikes(run(model, HASTY, "{follow: up}", b)))
    if not hits.size:
        return End(np.nan, np.nan, np.nan)
    around = np.arange(b[hits[-1]] - 25 * STEP, b[hits[-1]] + 50 * STEP, STEP)
    sought = run(model, "{transient: 3000, record: 200}", f"{{random: {STARTS}, seed: 1}}", around)
    struck = strikes(sought)
    most = around[np.flatnonzero(struck.mean(axis=1) >= 0.5)[-1]]
    for n in range(len(around) - 1, -1, -1):
        for start in np.flatnonzero(struck[n])[:2]:
            lasting = run(model, LASTING, last_state(sought.isel(b=n, start=start)), [around[n]])
            if strikes(lasting)[0]:
                return End(most, *continued(run, model, around[n], last_state(lasting.isel(b=0))))
    return End(most, np.nan, np.nan)


def continued(run, model, at, state) -> tuple[float, float]:
    """(b, uncertainty) up to which this orbit lasts."""
    step = STEP
    while step > 1e-6:
        step /= 10
        finer = at + step * np.arange(1, 10)
        lasting = run(model, LASTING, state, finer)
        hits = np.flatnonzero(strikes(lasting))
        if hits.size:
            at, state = finer[hits[-1]], last_state(lasting.isel(b=hits[-1]))
    return at, step


def last_state(orbit) -> str:
    """The last section point of one orbit, as a start."""
    return "{" + ", ".join(f"{name}: {float(orbit[name][-1])!r}" for name in ("x1", "v1", "x2", "v2")) + "}"


class Table(NamedTuple):
    b: tuple[float, float]  # b* and how far it is from |e1^T (K - omega^2 M + i omega C)^-1 P|
    tau: tuple[float, float]
    states: dict[float, dict[str, list[Attractor]]]
    from_graze: dict[str, tuple[float, float]]
    from_elsewhere: dict[str, End]


def table(run) -> Table:
    graze = vs.grazing(vs.load_scene(SCENES / "figure_09.yaml").system)
    states = {}
    record = int(PATIENT.split("record: ")[1][:-1])
    for b in (key for key in PAPER if isinstance(key, float)):
        found = {name: run(model, PATIENT, f"{{random: {STARTS}, seed: 1}}", b) for name, model in MODELS.items()}
        states[b] = {name: attractors(data, record) for name, data in found.items()}
    maps = [name for name in MODELS if name != "exact flow"]
    return Table(
        *complex_response(graze),
        states,
        {name: end_from_graze(run, MODELS[name]) for name in maps},
        {name: end_from_elsewhere(run, model) for name, model in MODELS.items()},
    )


def complex_response(graze):
    """b* and tau*, each with its distance from the complex response, which shares no formula with the package."""
    p = {key: float(value) for key, value in (pair.split(": ") for pair in SYSTEM.split(", "))}
    K, M = np.array([[1, -1], [-1, 1 + p["mu_k"]]]), np.diag([1, p["mu_m"]])
    force = np.array([1 - p["f2"], p["f2"]])
    x1 = np.linalg.solve(K - p["omega"] ** 2 * M + 2j * p["omega"] * p["zeta"] * K, force)[0]
    exact = abs(x1), np.arctan2(x1.real, x1.imag)
    return [
        (value, max(abs(value - other), np.spacing(value)))
        for value, other in zip((graze.b, graze.tau), exact, strict=True)
    ]
