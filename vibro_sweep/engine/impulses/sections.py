"""Section states of many periodic orbits of one oscillator whose stops and restitutions differ."""

import math

from vibro_sweep.engine.impulses.flights import advance, set_phase, start_of_orbit
from vibro_sweep.engine.simd.jit import entry


@entry
def sections(f, close, unknowns, gaps, K, sigma, P, T, out, z, room):
    """States at the multiples of T/2, T the forcing period, in contact coordinates.

    unknowns : (m, 2K) times and impulses of m orbits with z(t + P) = sigma z(t)
    gaps : (m,) gap before the first impact
    out : (m, 2n, 2N) for orbits of n forcing periods: at (2i) T/2 and (2i + 1) T/2 modulo the period; before an impact
    z : (2, 2N + 3)
    """
    repeats, count, states = 1 if sigma > 0.0 else 2, out.shape[1], out.shape[2]
    N, step = states // 2, 0.5 * T
    for i in range(len(unknowns)):
        u, flying, there = unknowns[i], z[0], z[1]
        start_of_orbit(f, close, u, K, P, gaps[i], flying, room)
        sign, moment = 1.0, math.floor((u[0] if K > 0 else 0.0) / step) + 1
        final = moment + count
        for turn in range(repeats):
            for k in range(max(K, 1)):
                begin = turn * P + (u[k] if K > 0 else 0.0)
                end = turn * P + (u[k + 1] if k + 1 < K else (u[0] if K > 0 else 0.0) + P)
                if K > 0:
                    flying[N] += sign * u[K + k]
                set_phase(f, flying, begin)
                last = turn == repeats - 1 and k + 1 >= K
                while moment < final and (last or moment * step <= end):  # none is left out by rounding
                    for j in range(len(flying)):
                        there[j] = flying[j]
                    advance(f, there, max(moment * step - begin, 0.0), room)
                    for j in range(states):
                        out[i, moment % count, j] = there[j]
                    moment += 1
                advance(f, flying, end - begin, room)
            sign *= sigma
