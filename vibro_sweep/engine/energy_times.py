"""The times at which the motion of a period is sampled for its energies (energy.py): between them it is analytic."""

import math

from vibro_sweep.engine.compliant.law import lane_of
from vibro_sweep.engine.quadrature import NODES, PLACES
from vibro_sweep.engine.simd.jit import inline, jit


@jit
def parts_of(q):
    """The number of parts of a cell in each of which every rate is resolved."""
    return int(math.ceil(q.width / q.step - 1e-3))  # noqa: RUF046  # compiled it is a float


@jit
def cuts_of(hits, rests, q, cuts):
    """Times within a period, in cells, between which free motion is analytic. Returns how many."""
    parts, count = parts_of(q), 0
    for k in range(q.cells):
        for i in range(parts):
            cuts[count] = k + i / parts
            count += 1
    cuts[count] = q.cells
    count += 1
    for rows in (hits, rests):
        for n in range(len(rows)):
            cuts[count] = rows[n, 1] + rows[n, 2] / q.width
            count += 1
    return count


@inline
def cut_contacts(law, touched, q, cuts, count):
    """Add the touches, releases and steps of the contacts that have been logged. Returns how many times there are;
    more than there is room for where it does not suffice."""
    if law is not None:
        contact = law.orbits[0]
        for i in range(touched):
            line = law.log[0, i]
            begin, end = line[1] + line[2] / q.width, float(q.cells)
            if line[3] == line[3]:
                end = min(end, line[4] + line[5] / q.width)
            steps = int(math.ceil((end - begin) * q.width / contact.step[lane_of(line[6])])) + 1  # noqa: RUF046
            if count + steps > len(cuts):
                return len(cuts) + 1
            for m in range(steps):
                cuts[count + m] = begin + (end - begin) * m / max(steps - 1, 1)
            count += steps
    return count


@jit
def sort(times):
    """Sort a few runs of rising numbers."""
    for n in range(1, len(times)):
        time, i = times[n], n
        while i > 0 and times[i - 1] > time:
            times[i] = times[i - 1]
            i -= 1
        times[i] = time


@jit
def set_times(cuts, q, times):
    """The nodes between neighbouring cuts, as cell and offset. Returns how many."""
    count = 0
    for i in range(len(cuts) - 1):
        low, high = cuts[i], cuts[i + 1]
        if high - low > 1e-12:
            cell = min(math.floor(0.5 * (low + high)), q.cells - 1)
            for n in range(NODES):
                times[count, 0], times[count, 1] = cell, (low + (high - low) * PLACES[n] - cell) * q.width
                count += 1
    return count
