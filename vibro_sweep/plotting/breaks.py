"""Where a sampled orbit met a stop: its velocity jumps there, and no line must be drawn across the jump."""

from typing import NamedTuple

import numpy as np


class Path(NamedTuple):
    """A sampled orbit with its impacts put in: t, x, v of shape (n,), with NaN in the middle of each jump.

    `jumps`: rows (x, v before, v after), one an impact.
    """

    t: np.ndarray
    x: np.ndarray
    v: np.ndarray
    jumps: np.ndarray


def break_at_impacts(t, x, v, stops) -> Path:
    """Put the impacts between samples t, x, v (n,) into the path; `stops`: side (+1 | -1) -> x.

    An impact is a velocity that turns back from a stop by more than the acceleration beside it explains. Both
    sides of the jump are extrapolated from the samples next to it: good to the eye, and no more is meant.
    """
    if len(t) < 4:
        return Path(t, x, v, np.empty((0, 3)))
    change = np.diff(v)
    before, after = np.roll(change, 1), np.roll(change, -1)
    before[0], after[-1] = after[0], before[-1]
    smooth = np.where(np.abs(before) < np.abs(after), before, after)  # the other may hold an impact itself
    at, rows, jumps = [], [], []
    for side, stop in stops.items():
        turns = (side * v[:-1] > 0) & (side * v[1:] <= 0)
        jumps_back = np.abs(change - smooth) > 0.5 * np.abs(v[:-1])
        near = np.abs(stop - x) < 2 * np.abs(v) * np.gradient(t)
        hits = turns & jumps_back & (near[:-1] | near[1:])
        for k in np.flatnonzero(hits):
            step = t[k + 1] - t[k]
            part = np.clip((stop - x[k]) / v[k] / step, 0, 1)
            v_in = v[k] + part * smooth[k]
            v_out = v[k + 1] - (1 - part) * smooth[k]
            v_out = 0.0 if side * v_out > 0 else v_out
            when = t[k] + part * step
            at += [k + 1] * 3
            rows += [(when, stop, v_in), (when, np.nan, np.nan), (when, stop, v_out)]
            jumps.append((stop, v_in, v_out))
    if not rows:
        return Path(t, x, v, np.empty((0, 3)))
    return Path(*np.insert([t, x, v], at, np.transpose(rows), axis=1), np.array(jumps))
