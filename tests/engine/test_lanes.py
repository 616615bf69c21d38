"""Numbers side by side, held against numpy: every operation, on numbers of all sizes, infinities and NaN."""

import math

import numpy as np
import pytest

from vibro_sweep.engine.simd.columns import put_transposed, sizes, transposed, weigh
from vibro_sweep.engine.simd.jit import exported
from vibro_sweep.engine.simd.lanes import LANES, SINGLES, alike, bits, lanes_of, lowest, number, select, state_and_rest
from vibro_sweep.engine.simd.memory import LINE, eight, head, new_lines, put, put_state, record, row, sixteen, widened

SPECIAL = np.array([0.0, -0.0, 1.0, np.inf, -np.inf, np.nan, 1e-310, -1e300])


@exported
def arithmetic(a, out):
    x, y = row(a, 0), row(a, 1)
    put(out, 0, x + y)
    put(out, 1, x - 2.0)
    put(out, 2, 3 * y)
    put(out, 3, x / y)
    put(out, 4, -x)
    put(out, 5, abs(y))
    put(out, 6, math.sqrt(x))
    total = x
    total += 1.0
    put(out, 7, total)


@exported
def comparisons(a, masks, out):
    x, y = row(a, 0), row(a, 1)
    masks[0], masks[1], masks[2], masks[3] = bits(x < y), bits(x <= y), bits(x > 1.0), bits(0.0 >= y)
    masks[4], masks[5] = bits((x < y) & (x > 1.0)), bits((x < y) | ~(x > 1.0))
    masks[6] = lowest(bits(lanes_of(0b11101000)))
    put(out, 0, select(x < y, x, y))
    put(out, 1, select(x < y, 1.0, alike(2.0)))


def block(width, like):
    """Fields as the kernels have them: one row for each orbit, or one column; `like` tells how many rows count."""
    return record(
        [
            ("wide", float, (LANES, width)),
            ("columns", float, (like, LANES)),
            ("like", float, (like, LANES)),
            ("back", float, (LANES, width)),
            ("sums", float, (2, LANES)),
            ("state", float, width),
            ("joined", float, width),
            ("short", float, width),
        ]
    )


@exported
def moved(r, a, out):
    put(out, 0, eight(a, 3))
    x = transposed(r.wide, r.like)
    put(r.columns, 0, x[0])
    put(r.columns, len(r.like) - 1, x[len(r.like) - 1])
    put_transposed(r.back, r.like)
    put(r.sums, 0, weigh(a, 1, 2, (row(a, 0), row(a, 1), row(a, 2), row(a, 3))))
    put(r.sums, 1, sizes((row(a, 0), row(a, 1)))[1])
    put(r.joined, 0, state_and_rest(row(r.state, 0), row(r.wide, 1), r.sums))
    put(r.short, 0, widened(head(r.wide, 2, r.sums), r.wide) - row(r.wide, 1))


def numbers(shape, seed):
    rng = np.random.default_rng(seed)
    return rng.normal(size=shape) * 10.0 ** rng.integers(-200, 200, shape)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("shift", range(LANES))
def test_arithmetic(shift):
    for a in (numbers((2, LANES), shift), np.stack([SPECIAL, np.roll(SPECIAL, shift)])):
        out = np.empty((8, LANES))
        arithmetic(a, out)
        x, y = a
        expected = np.stack([x + y, x - 2.0, 3 * y, x / y, -x, abs(y), np.sqrt(x), x + 1.0])
        np.testing.assert_array_equal(out, expected)


@pytest.mark.parametrize("shift", range(LANES))
def test_comparisons(shift):
    a = np.stack([SPECIAL, np.roll(SPECIAL, shift)])
    masks, out = np.empty(7, np.int64), np.empty((2, LANES))
    comparisons(a, masks, out)
    x, y = a
    tests = (x < y, x <= y, x > 1.0, 0.0 >= y, (x < y) & (x > 1.0), (x < y) | ~(x > 1.0))
    assert masks[:6].tolist() == [int(np.packbits(test, bitorder="little")[0]) for test in tests]
    assert masks[6] == 3
    np.testing.assert_array_equal(out, [np.where(x < y, x, y), np.where(x < y, 1.0, 2.0)])


@pytest.mark.parametrize("width, like", [(LANES, 4), (LANES, 6), (2 * LANES, 12)])
def test_rows_and_columns(width, like):
    r = new_lines(1, block(width, like))
    for seed, name in enumerate(r.dtype.names[:-1]):
        r[name] = numbers(r[name].shape, seed)
    a, out = np.random.default_rng(9).normal(size=(LANES, LANES)), np.empty((1, LANES))
    moved(r[0], a, out)
    np.testing.assert_array_equal(out[0], a.ravel()[3:11])
    np.testing.assert_array_equal(r["columns"][0, [0, -1]], r["wide"][0].T[[0, like - 1]])
    np.testing.assert_array_equal(r["back"][0, :, :like], r["like"][0].T)
    assert not r["back"][0, :, like:].any()
    np.testing.assert_allclose(r["sums"][0, 0], (a[1::2] * a[:4]).sum(0), rtol=0, atol=1e-14)
    np.testing.assert_array_equal(r["sums"][0, 1], abs(a[1]))
    np.testing.assert_array_equal(r["joined"][0], [*r["state"][0, :4], *r["wide"][0, 1, 4:]])
    np.testing.assert_array_equal(r["short"][0], [*(r["wide"][0, 2, :4] - r["wide"][0, 1, :4]), *-r["wide"][0, 1, 4:]])


@exported
def single(a, y, masks):
    x, z = sixteen(a, 3), sixteen(a, 3 + a.shape[1])
    masks[0], masks[1] = bits(x * y + z > 1.0), bits((x <= z) & ~(x >= y))
    masks[2], masks[3] = bits(abs(x) < 0.5), bits(select(x < z, x, y) + z > 0.0)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_single_precision():
    rng = np.random.default_rng(2)
    for special in (False, True):
        a, y = rng.normal(size=(2, SINGLES + 4)).astype(np.float32), rng.normal()
        if special:
            a[0, 3:11] = SPECIAL
        masks = np.empty(4, np.int64)
        single(a, y, masks)
        (x, z), y = a[:, 3 : 3 + SINGLES], np.float32(y)
        product = x.astype(float) * y + z.astype(float)  # fused: rounded once, and not near to 1
        tests = (product > 1, (x <= z) & ~(x >= y), abs(x) < 0.5, np.where(x < z, x, y) + z > 0)
        assert masks.tolist() == [int(np.packbits(test, bitorder="little").view(np.uint16)[0]) for test in tests]


def test_records_begin_with_a_cache_line():
    kind = record([("x", float, LANES), ("flag", np.bool_)])
    for _ in range(20):
        lines = new_lines((3,), kind)
        assert kind.itemsize % LINE == 0 and lines.ctypes.data % LINE == 0
        assert not lines["x"].any() and not lines["flag"].any()


@exported
def parts(r, a, out):
    for n in range(len(a)):
        put_state(out, n, row(a, n), r.sums)
        out[n, 3] = number(row(a, n), 1)


def test_the_first_of_eight():
    """Four of them, as many as two masses have states, are stored and nothing behind; one of them is a float."""
    a, out = numbers((5, LANES), 0), np.zeros((6, 4))
    parts(new_lines(1, block(LANES, 4))[0], a, out)
    np.testing.assert_array_equal(out[:5], a[:, [0, 1, 2, 1]])
    assert not out[5].any()
