"""The continuous motion of orbits that have been computed, over some periods more.

Sampled uniformly, with the exact states at the sections and the impacts, between which the samples are smooth.
"""

import math
from typing import NamedTuple

import numpy as np

from vibro_sweep.engine.compliant.law import lane_of, relax_from
from vibro_sweep.engine.motion.ensemble import carry
from vibro_sweep.engine.motion.orbits import Records, set_state
from vibro_sweep.engine.motion.together import Ensemble, Readings
from vibro_sweep.engine.orbit_block import prepare
from vibro_sweep.engine.simd.jit import exported, inline, jit
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.tables import outcomes as status


class Trajectories(NamedTuple):
    """The samples of p points with s starts each. Times are in forcing periods since the last recorded section."""

    samples: np.ndarray  # (p, s, samples, 2 N)
    sections: np.ndarray  # (p, s, periods + 1, 2 N), the last recorded section first
    impacts: np.ndarray  # (p, s, m, 2 + 2 N): time, side, v1 before, v1 after, x2, ..; in order, the m fastest of them
    counts: np.ndarray  # (p, s): impacts, also where there are more than m; -1: not computed


def new_trajectories(shape: tuple[int, int], samples: int, periods: int, impacts: int, masses: int = 2) -> Trajectories:
    """Room for so much, with nothing computed yet."""
    return Trajectories(
        np.full((*shape, samples, 2 * masses), np.nan),
        np.full((*shape, periods + 1, 2 * masses), np.nan),
        np.full((*shape, impacts, 2 + 2 * masses), np.nan),
        np.full(shape, -1, np.int64),
    )


@jit
def follow(w, periods, hits, samples, sections, impacts):
    """The motion of the first orbit over the next `periods`; how many impacts. hits: scratch, (1, m, 3 + 2 N)."""
    e = w.ensemble
    o, records, last = e.orbits[0], e.records, len(samples) - 1
    q = e.flights.oscillator[o.table, 0]
    o.periods, o.log_side = 1, 0.0
    for j in range(samples.shape[1]):
        sections[0, j] = o.X[j]
    i = 0
    for n in range(periods):
        first = i
        while i < last and i * periods < (n + 1) * last:
            cells = (i * periods - n * last) / last * q.cells
            records.times[i, 0] = math.floor(cells)
            records.times[i, 1] = (cells - math.floor(cells)) * q.width
            i += 1
        part = Records(hits, records.rests, records.times[first:i], records.samples[first:i], None)
        part = Ensemble(e.flights, e.orbits, e.strike, e.tangent, part, e.halt, e.law)
        carry(part, None, Readings(w.section, False, w.growth, 0))
        if o.status != status.OK:
            sections[: n + 1] = np.nan
            return 0
        for j in range(samples.shape[1]):
            sections[n + 1, j] = o.X[j]
    for i in range(last):
        for j in range(samples.shape[1]):
            samples[i, j] = records.samples[i, j]
    for j in range(samples.shape[1]):
        samples[last, j] = o.X[j]
    keep_fastest(hits[0, : min(o.impacts_logged, hits.shape[1])], impacts, q, o.stops)
    return o.impacts_logged


@jit
def count_faster(hits, speed):
    """Logged impacts with more than this speed."""
    n = 0
    for i in range(len(hits)):
        n += abs(hits[i, 4]) > speed
    return n


@jit
def keep_fastest(hits, impacts, q, stops):
    """Keep as many of the logged impacts, (n, 7), as there is room for; those that are left out end chatter
    sequences."""
    slow = -1.0
    if len(hits) > len(impacts):
        below, slow = 0.0, 0.0
        for i in range(len(hits)):
            slow = max(slow, abs(hits[i, 4]))
        for _ in range(60):
            middle = 0.5 * (below + slow)
            if count_faster(hits, middle) > len(impacts):
                below = middle
            else:
                slow = middle
    n = 0
    for i in range(len(hits)):
        if abs(hits[i, 4]) > slow:
            hit = hits[i]
            impacts[n, 0] = hit[0] + (hit[1] + hit[2] / q.width) / q.cells
            impacts[n, 1], impacts[n, 2] = hit[3], hit[4]
            impacts[n, 3] = -(stops[3] if hit[3] > 0.0 else stops[2]) * hit[4]
            for j in range(5, len(hit)):
                impacts[n, j - 1] = hit[j]
            n += 1


@inline
def hold(law, o, relaxed):
    """Where compliant stops are at the section; a mass inside one is in contact, which its state says."""
    if law is not None:
        relax_from(law, 0, relaxed, 0, 0.0)
        if o.resting != 0.0 and law.orbits[0].compliant[lane_of(o.resting)]:
            o.resting = 0.0


@exported
def run_trajectories(points, results, hits, kept, w, plan):
    """Go on from where `run_points` left the orbits of a block. hits: scratch, (1, m, 3 + 2 N)."""
    e = w.ensemble
    e.tangent[0].wanted = e.strike[0].measured = False
    for i in range(1, LANES):
        e.orbits[i].status = status.NOT_COMPUTED
    for p in range(len(points)):
        for s in range(results.shape[1]):
            result, o = results[p, s], e.orbits[0]
            if result.status in status.VALID:
                stops = prepare(points[p], 0, w, plan)
                set_state(o, e.flights.nodes[o.table], stops, 0, 0.0, result.end)
                o.resting = result.resting
                hold(e.law, o, result.relaxed)
                samples, sections, impacts = kept.samples[p, s], kept.sections[p, s], kept.impacts[p, s]
                count = follow(w, plan.periods, hits, samples, sections, impacts)
                if o.status == status.OK:
                    kept.counts[p, s] = count
                else:
                    result.status = o.status
