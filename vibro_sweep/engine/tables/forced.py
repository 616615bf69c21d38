"""The motion r under the force, and the force itself, at each node."""

import math

from vibro_sweep.engine.simd.jit import jit


@jit
def fill_phases(q, nodes, cells, tau):
    """sin and cos of omega t at the nodes, and of omega t + tau.

    Most oscillators of a sweep have the cells, and many the phase, of the one whose tables they replace.
    """
    states = 2 * len(q.series)
    if cells != q.cells:
        for k in range(cells + 1):
            angle = 2.0 * math.pi * (k / cells)
            nodes[k].turn[0], nodes[k].turn[1] = math.sin(angle), math.cos(angle)
    if cells != q.cells or tau != q.tau:
        for k in range(cells + 1):
            phase = tau + 2.0 * math.pi * (k / cells)
            nodes[k].z[states], nodes[k].z[states + 1] = math.sin(phase), math.cos(phase)
            if len(q.force) > states + 2:
                nodes[k].z[states + 2] = 1.0
    q.cells, q.tau = cells, tau


@jit
def fill_forced_motion(q, nodes, begin):
    """The motion r: at rest at node 0; where the system is stiff, there in the state `begin`."""
    states, constant = 2 * len(q.series), len(q.force) > 2 * len(q.series) + 2
    sin, cos = nodes[0].z[states], nodes[0].z[states + 1]
    q.largest = 0.0
    for k in range(q.cells + 1):
        z, E = nodes[k].z, nodes[k].E
        for i in range(states):
            z[i] = E[states, i] * sin + E[states + 1, i] * cos
            if constant:
                z[i] += E[states + 2, i]
            if q.stiff:
                for j in range(states):
                    z[i] += E[j, i] * begin[j]
        q.largest = max(q.largest, abs(z[0]))
