"""A block of points: for each its tables, for each of its starts an orbit and what the scene observes of it."""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.kernels import status, tangent
from vibro_sweep.kernels.ensemble import cross_period, record, settle
from vibro_sweep.kernels.flight import Flight, new_flight
from vibro_sweep.kernels.impacts import ORBIT, Records, Stops, new_records, place, start_count
from vibro_sweep.kernels.jit import jit
from vibro_sweep.kernels.tables import MOST_CELLS, build
from vibro_sweep.kernels.tangent import TANGENT

POINT = np.dtype(
    [(name, float) for name in ("mu_m", "mu_k", "zeta", "f2", "omega", "R", "b", "tau")]
    + [("psi", float, (2, 2)), ("omega_squared", float, 2), ("cells", np.int64)]
)

RESULT = np.dtype(
    [
        ("status", np.int8),
        ("lyapunov", float, 4),
        ("lyapunov_residual", float),
        ("impacts_right", np.int64),
        ("impacts_left", np.int64),
        ("min_impact_speed", float),
        ("sticking_time", float),
        ("period", np.int64),
        ("end", float, 4),  # the state at the last section
    ]
)

REPEAT = 1e-6  # section points this near to each other, relative to their size, are the same point


WARM_UP = 200  # periods for the tangent vectors to find their directions


def new_results(shape: tuple[int, ...]) -> np.ndarray:
    """Results of points that are not computed yet."""
    results = np.zeros(shape, RESULT)
    results["status"] = status.NOT_COMPUTED
    for name in ("impacts_right", "impacts_left", "period"):
        results[name] = -1
    for name in ("lyapunov", "lyapunov_residual", "min_impact_speed", "sticking_time", "end"):
        results[name] = np.nan
    return results


class Plan(NamedTuple):
    """What is asked of every orbit of a sweep."""

    transient: int
    record: int
    warm_up: int  # periods of the transient with tangent vectors
    lyapunov: bool
    section_side: float  # 0: the section is t = 0 mod T; else the stop of an impact section
    right: bool
    left: bool
    follow: bool
    periods: int  # of the trajectory


class Workspace(NamedTuple):
    """What one thread needs besides its points; allocated once for many blocks."""

    flight: Flight
    orbit: np.ndarray
    tangent: np.ndarray
    records: Records
    section: np.ndarray  # (record, 4)
    scratch: np.ndarray  # (7, 6)
    axes: np.ndarray  # (4, 4)


def new_workspace(plan: Plan, cells: int, samples: int) -> Workspace:
    impacts = plan.record if plan.section_side else 0
    return Workspace(
        new_flight(min(cells, MOST_CELLS)),
        np.zeros(1, ORBIT),
        np.zeros(1, TANGENT),
        new_records(impacts=impacts, samples=samples),
        np.empty((plan.record, 4)),
        np.empty((7, 6)),
        np.empty((4, 4)),
    )


@jit
def same_oscillator(a, b):
    """Whether two points share their tables: they may differ in b and R."""
    same = a.mu_m == b.mu_m and a.mu_k == b.mu_k and a.zeta == b.zeta
    return same and a.f2 == b.f2 and a.omega == b.omega and a.tau == b.tau


@jit
def find_period(section, tolerance):
    """Least p, up to half of the points, after which all points repeat themselves; 0 if there is none.

    tolerance: (4,) scratch.
    """
    count, largest = len(section), 0.0
    for i in range(4):
        tolerance[i] = 0.0
        for n in range(count):
            tolerance[i] = max(tolerance[i], abs(section[n, i]))
        largest = max(largest, tolerance[i])
    for i in range(4):
        tolerance[i] = REPEAT * max(tolerance[i], 1e-3 * largest)
    for p in range(1, count // 2 + 1):
        n, near = count - 1, True
        while near and n >= p:
            for i in range(4):
                near = near and abs(section[n, i] - section[n - p, i]) <= tolerance[i]
            n -= 1
        if near:
            return p
    return 0


@jit
def follow_trajectory(f, stops, o, records, t, periods, out):
    """The motion over the next `periods`, sampled uniformly from the present section to the last one: out (m, 4)."""
    q, last = f.oscillator[0], len(out) - 1
    i = 0
    for n in range(periods):
        first = i
        while i < last and i * periods < (n + 1) * last:
            cells = (i * periods - n * last) / last * q.cells
            records.times[i, 0] = math.floor(cells)
            records.times[i, 1] = (cells - math.floor(cells)) * q.width
            i += 1
        part = Records(records.impacts, records.rests, records.times[first:i], records.samples[first:i])
        outcome = cross_period(f, stops, o, part, t, 0, 0.0)
        if outcome != status.OK:
            return outcome
    for i in range(last):
        for j in range(4):
            out[i, j] = records.samples[i, j]
        out[i, 0] = min(max(out[i, 0], stops.left), stops.right)  # evaluation may round past a stop
    for j in range(4):
        out[last, j] = o.X[j]
    return status.OK


@jit
def floquet(f, stops, o, records, t, axes, period, spectrum):
    """The exponents of a periodic orbit, over exactly one more period of it: ln|Floquet multiplier|/time.

    The vectors have found the invariant subspaces. A real multiplier brings its vector back to itself, and its growth
    is
    exact; a complex pair turns two vectors in their plane, and the mean of their growths is. Returns a status and the
    sum.
    """
    for i in range(4):
        for j in range(4):
            axes[i, j] = t.Z[i, j]
    start_count(o)
    tangent.start_record(t)
    for _ in range(period):
        outcome = cross_period(f, stops, o, records, t, 0, 0.0)
        if outcome != status.OK:
            return outcome, np.nan
    q = f.oscillator[0]
    tangent.catch_up(t, q)
    growth = tangent.exponents(t, period * (q.width * q.cells), spectrum)
    i = 0
    while i < 3:
        turn = 0.0
        for j in range(4):
            turn += axes[j, i + 1] * t.Z[j, i]
        if abs(turn) > 1e-4:
            mean = 0.5 * (spectrum[i] + spectrum[i + 1])
            spectrum[i] = spectrum[i + 1] = mean
            i += 1
        i += 1
    return status.OK, growth


@jit
def observe(f, stops, w, plan, point, result, section, phase, trajectory):
    """One orbit from where it is placed to the end of all that is wanted of it. Returns a status."""
    o, t, records = w.orbit[0], w.tangent[0], w.records
    points = section if len(section) > 0 and plan.section_side == 0.0 else w.section
    t.wanted = False
    outcome = settle(f, stops, o, records, t, plan.transient, plan.warm_up)
    if outcome != status.OK:
        return outcome
    if plan.lyapunov and not t.wanted:
        tangent.begin(t)
    o.impacts_logged, o.log_side = 0, plan.section_side
    outcome, growth = record(f, stops, o, records, t, points, result.lyapunov)
    if outcome != status.OK:
        return outcome
    result.impacts_right, result.impacts_left = o.impacts_right, o.impacts_left
    result.min_impact_speed = o.slowest if o.slowest < np.inf else np.nan
    result.sticking_time = o.rest_time
    for i in range(4):
        result.end[i] = o.X[i]
    if len(phase) > 0:
        for n in range(min(o.impacts_logged, len(phase))):
            row = records.impacts[n]
            section[n, 0], section[n, 1] = stops.right if row[3] > 0.0 else stops.left, row[4]
            section[n, 2], section[n, 3] = row[5], row[6]
            phase[n] = point.omega * (row[1] * f.oscillator[0].width + row[2])
    resting, period = o.resting, find_period(points, w.axes[0])
    result.period = period
    if plan.lyapunov:
        periods_counted = plan.record
        if period > 0:
            outcome, growth = floquet(f, stops, o, records, t, w.axes, period, result.lyapunov)
            if outcome != status.OK:
                return outcome
            periods_counted = period
        tangent.sort(result.lyapunov)
        nu = (o.impacts_right + o.impacts_left) / (periods_counted * 2.0 * math.pi / point.omega)
        divergence = -2.0 * point.zeta * (1.0 + (1.0 + point.mu_k) / point.mu_m)
        exact = divergence + (2.0 * nu * np.log(stops.R) if nu > 0.0 else 0.0)
        result.lyapunov_residual = growth - exact if growth > -np.inf else np.nan
    if len(trajectory) > 0:
        t.wanted = False
        place(o, result.end[0], result.end[1], result.end[2], result.end[3])
        o.resting = resting
        return follow_trajectory(f, stops, o, records, t, plan.periods, trajectory)
    return status.OK


@jit
def run_points(points, starts, results, sections, phases, trajectories, w, plan):
    """Compute a block. p = points, s = starts; observations that nobody wants have no samples.

    starts: (p, s, 4), or with `follow` (1, s, 4): then a point starts where the one before it ended.
    results: (p, s) RESULT. sections: (p, s, record, 4). phases: (p, s, record), for an impact section.
    trajectories: (p, s, samples, 4).
    """
    f, o = w.flight, w.orbit[0]
    for p in range(len(points)):
        point = points[p]
        if point.cells > MOST_CELLS:
            for s in range(results.shape[1]):
                results[p, s].status = status.TOO_STIFF
            continue
        if p == 0 or not same_oscillator(point, points[p - 1]) or points[p - 1].cells > MOST_CELLS:
            build(
                f, w.scratch, point.cells, point.psi, point.omega_squared,
                point.mu_m, point.mu_k, point.zeta, point.f2, point.omega, point.tau,
            )  # fmt: skip
        stops = Stops(-point.b if plan.left else -np.inf, point.b if plan.right else np.inf, point.R)
        for s in range(results.shape[1]):
            x = starts[0 if plan.follow else p, s]
            x1, v1, x2, v2 = x[0], x[1], x[2], x[3]
            if plan.follow and p > 0 and results[p - 1, s].status == status.OK:
                end = results[p - 1, s].end
                x1, v1, x2, v2 = end[0], end[1], end[2], end[3]
            place(o, min(max(x1, stops.left), stops.right), v1, x2, v2)
            outcome = observe(
                f, stops, w, plan, point, results[p, s], sections[p, s], phases[p, s], trajectories[p, s]
            )  # fmt: skip
            results[p, s].status = outcome
