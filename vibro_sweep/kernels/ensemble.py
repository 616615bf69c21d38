"""The loop: orbits from section to section over the phase grid."""

import numpy as np

from vibro_sweep.kernels import status, tangent
from vibro_sweep.kernels.discontinuity import map_period
from vibro_sweep.kernels.flight import CHUNK
from vibro_sweep.kernels.impacts import FREE, STRUCK, UNCLEAR, cross_cell, strike
from vibro_sweep.kernels.jit import jit


@jit
def control_point(scan, p, q, y0, y1, y2, y3):
    """Control point p of a flight that starts at (y0, ..., y3); q: as counted from there."""
    return scan[4, p] + scan[0, q] * y0 + scan[1, q] * y1 + scan[2, q] * y2 + scan[3, q] * y3


@jit
def first_suspect(f, stops, first, base, y0, y1, y2, y3):
    """The first cell from `first` on in which contact cannot be excluded; `cells` if there is none.

    (y0, ..., y3) = X - r at node `base`. The control points of all cells (tables.py) are looked at with multiply-adds
    alone, in a loop that the compiler turns into vector instructions.
    """
    scan, cells, bound = f.scan, f.oscillator[0].cells, f.oscillator[0].remainder
    margin = bound[0] * abs(y0) + bound[1] * abs(y1) + bound[2] * abs(y2) + bound[3] * abs(y3) + bound[4]
    low, high = stops.left + margin, stops.right - margin
    shift = np.uint64(2 * base)  # unsigned: else numba looks for negative indices, and the loop stays scalar
    for begin in range(2 * first, 2 * cells, CHUNK):
        outside = 0
        for p in range(np.uint64(begin), np.uint64(begin + CHUNK)):
            outside += not (low <= control_point(scan, p, p - shift, y0, y1, y2, y3) <= high)
        if outside == 0:
            continue
        for p in range(begin, min(begin + CHUNK, 2 * cells)):
            if not (low <= control_point(scan, p, p - 2 * base, y0, y1, y2, y3) <= high):
                cell = p // 2
                if p % 2 == 0 and cell > first and ends_outside(scan, cell - 1, base, low, high, y0, y1, y2, y3):
                    return cell - 1
                return cell
    if first < cells and ends_outside(scan, cells - 1, base, low, high, y0, y1, y2, y3):
        return cells - 1
    return cells


@jit
def ends_outside(scan, k, base, low, high, y0, y1, y2, y3):
    """Whether cell k ends outside, by the mean of the control points beside its end."""
    p, q = 2 * k + 1, 2 * (k - base) + 1
    end = 0.5 * (control_point(scan, p, q, y0, y1, y2, y3) + control_point(scan, p + 1, q + 1, y0, y1, y2, y3))
    return not (low <= end <= high)


@jit
def cross_period(f, stops, o, records, t, k, s):
    """Carry the orbit from offset s of cell k to the end of the forcing period. Returns a status."""
    q, nodes, X = f.oscillator[0], f.nodes, o.X
    o.events = o.samples_taken = 0
    base, r = k, nodes[k].r
    y0, y1, y2, y3 = X[0] - r[0], X[1] - r[1], X[2] - r[2], X[3] - r[3]
    while True:
        if s == 0.0 and o.resting == 0.0 and len(records.times) == 0:
            k = first_suspect(f, stops, k, base, y0, y1, y2, y3)
        if k > base:
            E, r = nodes[k - base].E, nodes[k].r
            for i in range(4):
                X[i] = (E[i, 0] * y0 + E[i, 1] * y1) + (E[i, 2] * y2 + E[i, 3] * y3) + r[i]
        if k == q.cells:
            break
        seen = UNCLEAR
        if s == 0.0 and o.resting == 0.0 and stops.left < X[0] < stops.right and not q.stiff:
            seen = strike(f, stops, o, records, t, k)
        if seen == UNCLEAR:
            events, rested = o.events, o.resting != 0.0
            outcome = cross_cell(f, stops, o, records, t, k, s)
            if outcome != status.OK:
                return outcome
            seen = STRUCK if s > 0.0 or rested or o.events > events else FREE
        k += 1
        if q.stiff and seen == FREE:  # go on from here: the less of a fast mode is left, the tighter the scan
            E, r = nodes[k - base].E, nodes[k].r
            for i in range(4):
                X[i] = (E[i, 0] * y0 + E[i, 1] * y1) + (E[i, 2] * y2 + E[i, 3] * y3) + r[i]
            seen = STRUCK
        if seen == STRUCK:  # else it was free flight, which goes on from `base`
            s, base, r = 0.0, k, nodes[k].r
            y0, y1, y2, y3 = X[0] - r[0], X[1] - r[1], X[2] - r[2], X[3] - r[3]
    if t.wanted:
        tangent.end_period(t, q, nodes)
    o.period += 1
    return status.OK


@jit
def carry(f, stops, o, records, t, mapped, periods, section, growth):
    """Carry the orbit over so many forcing periods, or iterations of the discontinuity mapping. Returns a status.

    mapped: None for the flow, for which the mapping then need not be compiled. section: (periods, 4) the state at the
    end of each, or (0, 4). growth: (m, 4) logarithms of the growth of the tangent vectors after each m-th part of the
    periods, or (0, 4).
    """
    read = 0
    for n in range(periods):
        if mapped is None:
            outcome = cross_period(f, stops, o, records, t, 0, 0.0)
        else:
            outcome = map_period(f, stops, o, records, t)
        if outcome != status.OK:
            return outcome
        if len(section) > 0:
            for i in range(4):
                section[n, i] = o.X[i]
        if (n + 1) * len(growth) >= (read + 1) * periods and len(growth) > 0:
            tangent.read_growth(t, f.oscillator[0], growth[read])
            read += 1
    return status.OK
