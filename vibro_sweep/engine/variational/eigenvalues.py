"""Eigenvalues of a small real matrix, by the QR algorithm with double shifts (EISPACK's `hqr`)."""

import math

from vibro_sweep.engine.simd.jit import jit, noinline
from vibro_sweep.engine.variational.graded import separate

STEPS = 60  # to one eigenvalue or one pair; some three are usual
ROUNDING = 2.0**-52


@jit
def reduce(a, n):
    """The leading n x n block of a becomes a Hessenberg matrix with the same eigenvalues, by reflections."""
    for k in range(n - 2):
        size = 0.0
        for i in range(k + 1, n):
            size += a[i, k] * a[i, k]
        size = math.sqrt(size)
        if size == 0.0:
            continue
        first = a[k + 1, k]
        a[k + 1, k] = first + math.copysign(size, first)  # column k now holds the reflection's vector
        scale = 1.0 / (size * abs(a[k + 1, k]))
        for j in range(k + 1, n):
            total = 0.0
            for i in range(k + 1, n):
                total += a[i, k] * a[i, j]
            total *= scale
            for i in range(k + 1, n):
                a[i, j] -= total * a[i, k]
        for i in range(n):
            total = 0.0
            for j in range(k + 1, n):
                total += a[i, j] * a[j, k]
            total *= scale
            for j in range(k + 1, n):
                a[i, j] -= total * a[j, k]
        a[k + 1, k] = -math.copysign(size, first)
        for i in range(k + 2, n):
            a[i, k] = 0.0


@jit
def pair(p, q, r, s, re, im, i):
    """Eigenvalues of ((p, q), (r, s)), the larger first, that with a positive imaginary part first."""
    half, middle = 0.5 * (p - s), 0.5 * (p + s)
    square = half * half + q * r
    if square < 0.0:
        re[i] = re[i + 1] = middle
        im[i] = math.sqrt(-square)
        im[i + 1] = -im[i]
        return
    larger = middle + math.copysign(math.sqrt(square), middle)
    re[i], re[i + 1] = larger, (p * s - q * r) / larger if larger != 0.0 else 0.0
    im[i] = im[i + 1] = 0.0


@jit
def is_split(a, k):
    """Whether the entry below the diagonal at (k, k - 1) may be taken for zero (Ahues and Tisseur, 1997)."""
    left, above, below, right = a[k, k - 1], a[k - 1, k], a[k - 1, k - 1], a[k, k]
    if left == 0.0 or abs(left) <= ROUNDING * math.sqrt(abs(below) * abs(right)):
        return True
    if abs(left) > ROUNDING * (abs(below) + abs(right)):
        return False
    larger = max(abs(right), abs(below - right))
    smaller = min(abs(right), abs(below - right))
    most = max(abs(left), abs(above))
    scale = larger + most
    return min(abs(left), abs(above)) * (most / scale) <= ROUNDING * (smaller * (larger / scale))


@noinline
def eigenvalues(a, n, re, im):
    """Eigenvalues re + i im of the leading n x n block of a, which is destroyed. Returns whether all were found.

    A matrix that is graded from large above to small below gives small eigenvalues to their own last digits.
    """
    separate(a, n, re)
    reduce(a, n)
    last, step = n - 1, 0
    while last >= 0:
        low = last
        while low > 0 and not is_split(a, low):
            low -= 1
        if low > 0:
            a[low, low - 1] = 0.0
        if low == last:
            re[last], im[last] = a[last, last], 0.0
            last, step = last - 1, 0
        elif low == last - 1:
            pair(a[low, low], a[low, last], a[last, low], a[last, last], re, im, low)
            last, step = last - 2, 0
        elif step == STEPS:
            return False
        else:
            step += 1
            sweep(a, n, low, last, step % 10 == 0)
    return True


@jit
def sweep(a, n, low, last, exceptional):
    """One double step of the QR algorithm on rows and columns low .. last."""
    x, y = a[last, last], a[last - 1, last - 1]
    product = a[last, last - 1] * a[last - 1, last]
    total, determinant = x + y, x * y - product
    if exceptional:
        size = abs(a[last, last - 1]) + abs(a[last - 1, last - 2])
        total, determinant = 1.5 * size, size * size
    # the first column of (a - s_1)(a - s_2)
    p = a[low, low] * (a[low, low] - total) + determinant + a[low, low + 1] * a[low + 1, low]
    q = a[low + 1, low] * (a[low, low] + a[low + 1, low + 1] - total)
    r = a[low + 1, low] * a[low + 2, low + 1]
    for k in range(low, last):
        three = k < last - 1
        if k > low:
            p, q, r = a[k, k - 1], a[k + 1, k - 1], a[k + 2, k - 1] if three else 0.0
        scale = abs(p) + abs(q) + abs(r)
        if scale == 0.0:
            continue
        p, q, r = p / scale, q / scale, r / scale
        size = math.copysign(math.sqrt(p * p + q * q + r * r), p)
        if k > low:
            a[k, k - 1] = -size * scale
            a[k + 1, k - 1] = 0.0
            if three:
                a[k + 2, k - 1] = 0.0
        v1, v2 = q / (p + size), r / (p + size)
        w0, w1, w2 = (p + size) / size, q / size, r / size
        for j in range(k, n):
            total = a[k, j] + v1 * a[k + 1, j] + (v2 * a[k + 2, j] if three else 0.0)
            a[k, j] -= total * w0
            a[k + 1, j] -= total * w1
            if three:
                a[k + 2, j] -= total * w2
        for i in range(min(last, k + 3) + 1):
            total = w0 * a[i, k] + w1 * a[i, k + 1] + (w2 * a[i, k + 2] if three else 0.0)
            a[i, k] -= total
            a[i, k + 1] -= total * v1
            if three:
                a[i, k + 2] -= total * v2
