"""A block of points: for each its tables, for each of its starts an orbit and what the scene observes of it."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.kernels import status
from vibro_sweep.kernels.flight import Flight, new_flight
from vibro_sweep.kernels.jit import jit
from vibro_sweep.kernels.observe import observe
from vibro_sweep.kernels.orbits import ORBIT, Records, Stops, new_records, place
from vibro_sweep.kernels.tables import build
from vibro_sweep.kernels.tangent import TANGENT

POINT = np.dtype(
    [(name, float) for name in ("mu_m", "mu_k", "zeta", "f2", "omega", "R", "b", "tau")]
    + [("psi", float, (2, 2)), ("omega_squared", float, 2), ("cells", np.int64)]
    + [("graze", float, 4)]  # the point at which the discontinuity mapping is expanded
)

RESULT = np.dtype(
    [
        ("status", np.int8),
        ("lyapunov", float, 4),
        ("lyapunov_error", float, 4),
        ("lyapunov_residual", float),
        ("impacts_right", np.int64),
        ("impacts_left", np.int64),
        ("min_impact_speed", float),
        ("contact_error", float),
        ("sticking_time", float),
        ("period", np.int64),
        ("end", float, 4),  # the state at the last section, and
        ("resting", float),  # the side of the stop that M1 rests on there, or 0
    ]
)

WARM_UP = 200  # periods for the tangent vectors to find their directions


def new_results(shape: tuple[int, ...]) -> np.ndarray:
    """Results of points that are not computed yet."""
    results = np.zeros(shape, RESULT)
    results["status"] = status.NOT_COMPUTED
    for name in ("impacts_right", "impacts_left", "period"):
        results[name] = -1
    for name in (
        "lyapunov",
        "lyapunov_error",
        "lyapunov_residual",
        "min_impact_speed",
        "contact_error",
        "sticking_time",
        "end",
    ):
        results[name] = np.nan
    return results


class Plan(NamedTuple):
    """What is asked of every orbit of a sweep."""

    transient: int
    record: int
    warm_up: int  # periods of the transient with tangent vectors
    lyapunov: bool
    impacts: bool
    section_side: float  # 0: the section is t = 0 mod T; else the stop of an impact section
    right: bool
    left: bool
    follow: bool
    periods: int  # of the trajectory
    parts: int  # of the record, at which the growth of tangent vectors is read
    order: int  # of the discontinuity mapping; 0: the flow itself


class Workspace(NamedTuple):
    """What one thread needs besides its points; allocated once for many blocks."""

    flight: Flight
    orbit: np.ndarray
    tangent: np.ndarray
    records: Records
    section: np.ndarray  # (record, 4)
    scratch: np.ndarray  # (7, 6)
    axes: np.ndarray  # (4, 4)
    growth: np.ndarray  # (parts, 4)


def new_workspace(plan: Plan, cells: int, samples: int) -> Workspace:
    impacts = plan.record if plan.section_side else 0
    return Workspace(
        new_flight(cells),
        np.zeros(1, ORBIT),
        np.zeros(1, TANGENT),
        new_records(impacts=impacts, samples=samples),
        np.empty((plan.record, 4)),
        np.empty((7, 6)),
        np.empty((4, 4)),
        np.empty((plan.parts, 4)),
    )


@jit
def same_oscillator(a, b):
    """Whether two points share their tables: they may differ in b and R."""
    same = a.mu_m == b.mu_m and a.mu_k == b.mu_k and a.zeta == b.zeta
    return same and a.f2 == b.f2 and a.omega == b.omega and a.tau == b.tau


@jit
def prepare(points, p, w, plan):
    """The tables of point p, unless they are still those of the point before; its stops."""
    f, point = w.flight, points[p]
    if p == 0 or not same_oscillator(point, points[p - 1]) or points[p - 1].cells == 0:
        build(
            f, w.scratch, point.cells, point.psi, point.omega_squared,
            point.mu_m, point.mu_k, point.zeta, point.f2, point.omega, point.tau,
        )  # fmt: skip
        q = f.oscillator[0]
        q.order = plan.order
        for i in range(4):
            q.graze[i] = point.graze[i]
    return Stops(-point.b if plan.left else -np.inf, point.b if plan.right else np.inf, point.R)


@jit
def run_points(points, starts, results, sections, phases, running, w, plan, mapped):
    """Compute a block. p = points, s = starts; observations that nobody wants have no samples.

    starts: (p, s, 4), or with `follow` (1, s, 4): then a point starts where the one before it ended. results: (p, s)
    RESULT. sections: (p, s, record, 4). phases: (p, s, record), for an impact section. running: (p, s, parts, 4), the
    exponents as they converge. mapped: None for the flow, 1 for the discontinuity mapping.
    """
    f, o = w.flight, w.orbit[0]
    for p in range(len(points)):
        point = points[p]
        if point.cells == 0:
            for s in range(results.shape[1]):
                results[p, s].status = status.TOO_STIFF
            continue
        stops = prepare(points, p, w, plan)
        for s in range(results.shape[1]):
            x = starts[0 if plan.follow else p, s]
            x1, v1, x2, v2 = x[0], x[1], x[2], x[3]
            if plan.follow and p > 0 and results[p - 1, s].status == status.OK:
                end = results[p - 1, s].end
                x1, v1, x2, v2 = end[0], end[1], end[2], end[3]
            if plan.order == 0:  # points of the map may lie beyond the stops
                x1 = min(max(x1, stops.left), stops.right)
            place(o, x1, v1, x2, v2)
            results[p, s].status = observe(
                f, stops, w, plan, mapped, point, results[p, s], sections[p, s], phases[p, s], running[p, s]
            )
