"""One checksum for each point of a variable: which numbers are not those that were written.

The words w_i of a point (8, 4, 2 or 1 bytes each) give c = sum_i m_i w_i mod 2^64, m_i = (2 i + 1) 0x9E3779B97F4A7C15,
of which the upper 32 bits are kept. All points are summed at once, so that a box of any shape can be written and read.
One flipped bit changes c by +-2^k m_i, in the upper bits too; of other damage one case in four thousand million is
missed.
"""

import functools
import math

import numpy as np

ODD = 0x9E3779B97F4A7C15
BEGIN = np.uint64(0x243F6A8885A308D3)  # so that zeros that were never written have another one than 0


@functools.lru_cache(64)
def _factors(count: int) -> np.ndarray:
    return (2 * np.arange(count, dtype=np.uint64) + 1) * np.uint64(ODD)


def checksums(values: np.ndarray, lead: int) -> np.ndarray:
    """Checksums (uint32) over the first `lead` axes of an array of numbers."""
    values = np.asarray(values)
    points = values.shape[:lead]
    flat = np.ascontiguousarray(values).reshape(math.prod(points), -1)
    words = flat.view(f"u{flat.itemsize}").astype(np.uint64, copy=False)
    sums = np.einsum("ij,j->i", words, _factors(words.shape[1])) + BEGIN
    return (sums >> np.uint64(32)).astype(np.uint32).reshape(points)
