"""The continuous motion of orbits that have been computed, sampled uniformly over some periods more."""

import math

from vibro_sweep.kernels import status
from vibro_sweep.kernels.ensemble import cross_period
from vibro_sweep.kernels.jit import jit
from vibro_sweep.kernels.orbits import Records, place
from vibro_sweep.kernels.points import prepare


@jit
def follow(f, stops, o, records, t, periods, out):
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
def run_trajectories(points, results, trajectories, w, plan):
    """Go on from where `run_points` left the orbits of a block. trajectories: (p, s, samples, 4)."""
    o, t = w.orbit[0], w.tangent[0]
    t.wanted = False
    for p in range(len(points)):
        if points[p].cells == 0:
            continue
        stops = prepare(points, p, w, plan)
        for s in range(results.shape[1]):
            result = results[p, s]
            if result.status == status.OK:
                place(o, result.end[0], result.end[1], result.end[2], result.end[3])
                o.resting = result.resting
                result.status = follow(w.flight, stops, o, w.records, t, plan.periods, trajectories[p, s])
