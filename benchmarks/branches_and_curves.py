"""Periodic orbits, branches, curves and windows: what an orbit or a point takes, by the number of its impacts.

A point has all tests and the certificate. "Short steps" tells what a point more takes: steps are so short that the
calls in Python, special points and ends drop out. Beside them shooting: Newton's method on the state, with differences
of the map over a period, by heyoka (tol 1e-16) and SciPy's DOP853 (1e-12).
"""

from functools import cache, partial
from importlib.util import find_spec

import numpy as np
import peers
import problem
from bench import digits, figures, in_turns, least, main, measured, spent, table

import vibro_sweep as vs

ORBITS = {  # by impacts: a clearance at which an orbit is stable, and its period
    1: (4.0, 1), 2: (3.0, 1), 4: (5.6, 8), 8: (4.9, 13), 12: (5.82, 26), 28: (4.64, 37),
}  # fmt: skip
TOUCHES = (1, 2, 4, 8)
CURVES = {  # the type of special point, and the clearance and period of the branch on which it lies
    "pitchforks, 1 impact in half a period": ("pitchfork", 3.0, 1),
    "Neimark-Sacker points, 1 impact": ("neimark_sacker", 4.0, 1),
    "grazes, 1 impact": ("graze", 4.0, 1),
    "folds, 4 impacts": ("fold", 6.6, 13),
    "grazes, 4 impacts": ("graze", 6.6, 13),
    "onsets of sticking": ("sticking", 0.0666, 1),
}
LAWS = {"rigid": problem.RIGID, "compliant": problem.PAPER | problem.DAMPED}
STEPS = 1 / 10, 1 / 100  # of branches and curves; the points that shorter ones add take what a point takes
SHORT = ", short steps"
MET = 2e-4  # distance of section points after a period, of an orbit that is on its way
NEAR = 1e-4  # relative distance of a guess from its orbit


@cache
def orbit_at(b: float, periods: int, law: str = "rigid"):
    """The stable orbit with this period, which is met from rest or from a random start."""
    system, rng = vs.System(**LAWS[law], b=b), np.random.default_rng(1)
    for scale in [0.0] + [1.0] * 60:
        start = scale * np.array([rng.uniform(-b, b), *(rng.normal(size=3) * (3, 3, 1))])
        section = vs.simulate(system, start, 4000).section
        shifts = [np.abs(section[-1] - section[-1 - n]).max() < MET for n in range(1, periods + 1)]
        if shifts[-1] and not any(shifts[:-1]):
            return vs.periodic_orbit(system, state=section[-1], periods=periods)
    raise ArithmeticError(f"no orbit of period {periods} at b = {b}")


def per_point(follow, short: bool):
    """A sample of microseconds a point of follow(**how): of the whole call, or of the points that short steps add."""
    if not short:
        points = follow().points.sizes["point"]
        return lambda: 1e6 * spent(follow) / points
    few, many = (follow(step=step).points.sizes["point"] for step in STEPS)
    wide, narrow = (lambda step=step: follow(step=step) for step in STEPS)
    return lambda: 1e6 * (spent(narrow) - spent(wide)) / (many - few)


def branch_row(impacts: int, law: str = "rigid", name: str = "b", short: bool = False):
    """A maker: a point of a branch."""

    def make():
        orbit = orbit_at(*ORBITS[impacts], law)
        value = getattr(orbit.system, name)
        return per_point(partial(vs.continue_orbit, orbit, name, (0.9 * value, 1.1 * value)), short)

    return make


def curve_row(kind: str, b: float, periods: int, short: bool = False):
    """A maker: a point of a curve in b and omega."""

    def make():
        low, high = (0.06, 0.067) if kind == "sticking" else (b - 1.5, b + 1.5)
        branch = vs.continue_orbit(orbit_at(b, periods), "b", (low, high))
        special = next(one for one in branch.special if one.type == kind)
        bounds = [(0.95 * x, 1.05 * x) for x in (special.parameters["b"], 0.63)]
        return per_point(partial(vs.bifurcation_curve, special, ("b", "omega"), bounds), short)

    return make


def orbit_row(b: float, periods: int):
    """A maker: milliseconds for an orbit from a state near it, with certificate and multipliers."""

    def make():
        orbit = orbit_at(b, periods)
        start = orbit.state * (1 + NEAR)
        job = lambda: vs.periodic_orbit(orbit.system, state=start, periods=periods).multipliers  # noqa: E731
        job()
        return lambda: 1e3 * spent(job)

    return make


def windows_row():
    """A maker: milliseconds a window of a sweep."""
    axes = {"b": {"start": 4.2, "stop": 7.0, "step": 0.02}}
    data = vs.sweep(problem.paper(6.0), axes, observe=["section"], transient=1000, record=200)
    count = len(vs.windows(data))
    return lambda: 1e3 * spent(lambda: vs.windows(data)) / count


def rows() -> dict:
    found = {f"orbit from a state, impacts {n}: ms": orbit_row(*ORBITS[n]) for n in (1, 4, 12)}
    for n in ORBITS:
        found[f"branch in b, impacts {n}: us a point"] = branch_row(n)
        found[f"branch in b, impacts {n}{SHORT}: us a point"] = branch_row(n, short=True)
    for name in ("omega", "zeta"):
        found[f"branch in {name}, impacts 1{SHORT}: us a point"] = branch_row(1, "rigid", name, short=True)
    for n in TOUCHES:
        found[f"branch in b, contacts {n}: us a point"] = branch_row(n, "compliant")
        found[f"branch in b, contacts {n}{SHORT}: us a point"] = branch_row(n, "compliant", short=True)
    for what, where in CURVES.items():
        found[f"curve of {what}: us a point"] = curve_row(*where)
        found[f"curve of {what}{SHORT}: us a point"] = curve_row(*where, short=True)
    return found | {"windows: ms a window": windows_row}


ROWS = rows()


def shooting(period_map, state) -> np.ndarray:
    """A fixed point of a map by Newton's method with differences, from a state near it."""
    h = 1e-6
    for _ in range(8):
        image = period_map(state)
        J = np.array([(period_map(state + h * axis) - image) / h for axis in np.eye(len(state))]).T
        step = np.linalg.solve(J - np.eye(len(state)), image - state)
        state = state - step
        if np.abs(step).max() < 1e-10:
            break
    return state


def beside() -> list[dict]:
    """An orbit with one impact from a state near it, here and by shooting."""
    orbit, found = orbit_at(*ORBITS[1]), []
    start, states = orbit.state * (1 + NEAR), np.tile(orbit.state, (8, 1))
    jobs = {"vibro_sweep": lambda: vs.periodic_orbit(orbit.system, state=start).state}
    for name, package, make in (
        ("shooting with heyoka", "heyoka", lambda: peers.heyoka(orbit.system, states, lanes=1)),
        ("shooting with SciPy DOP853", "scipy", lambda: peers.dop853(orbit.system, states)),
    ):
        if find_spec(package):
            fly = make().fly
            jobs[name] = lambda fly=fly: shooting(lambda state: fly(state, orbit.system.period)[2], start)
    errors = {name: float(np.abs(job() - orbit.state).max()) for name, job in jobs.items()}  # against the branch
    costs = in_turns({name: lambda job=job: 1e3 * least(job, 3) for name, job in jobs.items()}, 3)
    for name, ms in costs.items():
        found.append({"what": name, "ms": ms, "error": errors[name]})
    return found


def measure(quick: bool) -> dict:
    chosen = dict(list(ROWS.items())[:: 8 if quick else 1])
    return {"rows": measured(chosen, 1 if quick else 5), "beside": beside()}


def text(data: dict) -> str:
    beside = [(row["what"], digits(row["ms"]), f"{row['error']:.0e}") for row in data["beside"]]
    names = dict.fromkeys(
        name.partition(": us")[0].removesuffix(SHORT) for name in data["rows"] if "us a point" in name
    )
    cells = [[data["rows"].get(f"{name}{short}: us a point") for short in ("", SHORT)] for name in names]
    lines = [(name, *(digits(us) if us else "" for us in pair)) for name, pair in zip(names, cells, strict=True)]
    rest = {name: value for name, value in data["rows"].items() if "us a point" not in name}
    header = ("microseconds a point", "of a call", "short steps")
    orbit = ("an orbit with one impact", "ms", "difference")
    return "\n".join([table(header, lines), figures(rest), table(orbit, beside)])


if __name__ == "__main__":
    main(ROWS, measure, text)
