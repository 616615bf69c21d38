"""The section: what is done at the end of a period."""

import numpy as np

from vibro_sweep.engine.motion.distance import keep_finer
from vibro_sweep.engine.motion.orbits import begin_free_flight
from vibro_sweep.engine.simd.jit import inline, noinline
from vibro_sweep.engine.simd.lanes import select
from vibro_sweep.engine.simd.memory import put, put_state, row
from vibro_sweep.engine.variational import tangent


@inline
def end_period(e, o, q, nodes, X, readings):
    """Take the orbit over the section, where its state is X."""
    parts = readings.parts
    keep_finer(e.law, o, q)
    o.cell = o.events = o.samples_taken = 0
    begin_free_flight(o, nodes, X)
    o.period += 1
    if readings.keep:
        largest = row(o.largest, 0)
        put_state(readings.states[np.uint64(o.lane)], o.done, X, o.c)
        put(o.largest, 0, select(abs(X) > largest, abs(X), largest))
    o.done += 1
    t = e.tangent[0]
    if t.wanted:
        t.cell[o.lane] -= q.cells
        if parts > 0 and o.done * parts >= (o.read + 1) * o.periods:
            tangent.read_growth(t, o.lane, q, nodes, readings.growth[o.lane, o.read])
            o.read += 1


@noinline
def end_period_here(e, o, f, readings):
    """`end_period` of an orbit that has its state there, for those that came a rare way."""
    end_period(e, o, f.oscillator[0], f.nodes, row(o.X, 0), readings)
