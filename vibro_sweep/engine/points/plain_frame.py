"""The frame of tangent vectors of a plain oscillator (plain_points.py), from its modes (frame.py)."""

import math

from vibro_sweep.engine.points.frame import LEAST_SCALE, SLOWEST
from vibro_sweep.engine.points.invariant_planes import UNOBSERVABLE
from vibro_sweep.engine.simd.jit import jit


@jit
def set_frame(q, p, w):
    """The frame of tangent vectors (frame.py): each mode is a plane, those that the contact does not see come first."""
    n, along, first = len(q.M), math.sqrt(w.along[0]), 0
    for seen in range(2):
        for j in range(n):
            share = 0.0
            for i in range(n):
                share += q.normal[i] * w.shape[i, j]
            if (abs(share) / along > UNOBSERVABLE) == (seen == 1):
                w.order[first] = j
                first += 1
    for i in range(2 * n):
        for j in range(2 * n):
            p.to_frame[i, j] = p.from_frame[i, j] = 0.0
    for m in range(n):
        j = int(w.order[m])
        eta = 0.5 * w.damping[j]
        square = w.square[j] - eta * eta
        scale = max(math.sqrt(abs(square)), LEAST_SCALE * math.sqrt(w.square[j]))
        scale = scale if scale > SLOWEST * q.omega else q.omega
        p.frame_eta[m], p.frame_square[m], p.frame_scale[m] = eta, square, scale
        p.rounding = max(p.rounding, moved(eta, square, 0.5 * w.damping_error[j], w.square_error[j]))
        for k in range(n):
            w.row[k] = 0.0  # M psi_j
            for i in range(n):
                w.row[k] += q.M[k, i] * w.shape[i, j]
        for i in range(n):
            shape = dual = 0.0
            for k in range(n):
                shape += p.P[i, k] * w.shape[k, j]
                dual += p.back[k, i] * w.row[k]
            p.to_frame[2 * m, 2 * i], p.to_frame[2 * m + 1, 2 * i] = scale * dual, eta * dual
            p.to_frame[2 * m + 1, 2 * i + 1] = dual
            p.from_frame[2 * i, 2 * m], p.from_frame[2 * i + 1, 2 * m] = shape / scale, -eta * shape / scale
            p.from_frame[2 * i + 1, 2 * m + 1] = shape


@jit
def moved(eta, square, of_eta, of_product):
    """The distance by which rounding of eta and of eta^2 + square moves the roots -eta +- sqrt(-square) along the real
    axis."""
    apart = math.sqrt(max(-square, 0.0))
    more = max(2.0 * eta * of_eta + of_product - max(square, 0.0), 0.0)  # of apart^2
    return of_eta + more / (apart + math.sqrt(apart * apart + more)) if more > 0.0 else of_eta
