"""The continuous motion of orbits that have been computed, sampled uniformly over some periods more."""

import math

from vibro_sweep.kernels import status
from vibro_sweep.kernels.ensemble import Ensemble, carry
from vibro_sweep.kernels.jit import entry, jit
from vibro_sweep.kernels.lanes import LANES
from vibro_sweep.kernels.orbits import Records, place
from vibro_sweep.kernels.points import prepare


@jit
def follow(w, periods, out):
    """The motion of the first orbit over the next `periods`, sampled uniformly from section to section: out (m, 4)."""
    e = w.ensemble
    o, records, last = e.orbits[0], e.records, len(out) - 1
    q = e.flights.oscillator[o.table, 0]
    o.periods = 1
    i = 0
    for n in range(periods):
        first = i
        while i < last and i * periods < (n + 1) * last:
            cells = (i * periods - n * last) / last * q.cells
            records.times[i, 0] = math.floor(cells)
            records.times[i, 1] = (cells - math.floor(cells)) * q.width
            i += 1
        part = Records(records.impacts, records.rests, records.times[first:i], records.samples[first:i])
        part = Ensemble(e.flights, e.orbits, e.strike, e.tangent, part)
        carry(part, None, w.section, False, w.growth, 0)
    for i in range(last):
        for j in range(4):
            out[i, j] = records.samples[i, j]
        out[i, 0] = min(max(out[i, 0], o.stops[0]), o.stops[1])  # evaluation may round past a stop
    for j in range(4):
        out[last, j] = o.X[j]
    return o.status


@entry
def run_trajectories(points, results, trajectories, w, plan):
    """Go on from where `run_points` left the orbits of a block. trajectories: (p, s, samples, 4)."""
    e = w.ensemble
    e.tangent[0].wanted = e.strike[0].measured = False
    for i in range(1, LANES):
        e.orbits[i].status = status.NOT_COMPUTED
    for p in range(len(points)):
        for s in range(results.shape[1]):
            result, o = results[p, s], e.orbits[0]
            if result.status == status.OK:
                stops = prepare(points[p : p + 1], 0, w, plan)
                end = result.end
                place(o, e.flights.nodes[o.table], stops, 0, 0.0, end[0], end[1], end[2], end[3])
                o.resting = result.resting
                result.status = follow(w, plan.periods, trajectories[p, s])
