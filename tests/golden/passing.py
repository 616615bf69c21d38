"""Whether a branch or curve passes points of an earlier one, in their order."""

import numpy as np

SAG = 0.15  # of the length of a step: a point between two others is no farther from their chord
ROUNDED = 1e-8


def passed_in_order(values, stored, others, path) -> list[str]:
    """stored, path : motions of the points of a record and of all points now, at parameters `values` and `others`."""
    if not stored or not path:
        return [] if not stored else ["no points"]
    if not len(stored[0].t):
        size = max(np.abs([one.state for one in stored]).max(), 1e-300)
        a, b = (np.array([one.state for one in motions]) / size for motions in (stored, path))
    else:
        size = np.abs([one.v for one in stored]).max()
        a, b = (np.array([_place(one, size) for one in motions]) for motions in (stored, path))
        if a.shape[1] != b.shape[1]:
            return [f"{a.shape[1] // 2} impacts, now {b.shape[1] // 2}"]
        return min((_in_order(values, a, others, turned) for turned in _turned(stored[0], b, a)), key=len)
    return _in_order(values, a, others, b)


def _place(motion, size: float) -> np.ndarray:
    return np.concatenate([motion.t * motion.omega / (2 * np.pi), motion.v / size])


def _turned(first, b: np.ndarray, a: np.ndarray):
    """The path with its impacts counted from each one of them that may be the first of the record."""
    K = b.shape[1] // 2
    for k in range(K):
        if not np.array_equal(first.side, np.roll(first.side, -k)) and k:
            continue
        t = np.hstack([b[:, k:K], b[:, :k] + first.periods])
        j = int(np.argmin(np.abs(np.roll(b[:, K:], -k, axis=1) - a[0, K:]).max(axis=1)))
        shift = np.round(t[j, 0] - a[0, 0])
        yield np.hstack([t - shift, np.roll(b[:, K:], -k, axis=1)])


def _in_order(values, a, others, b) -> list[str]:
    a, b = np.column_stack([values, a]), np.column_stack([others, b])
    return in_order(a, b)


def in_order(a: np.ndarray, b: np.ndarray) -> list[str]:
    """Points a (m, d) that lie aside of the path b (n, d), or that it passes in another order."""
    return passed(a, b)[0]


def passed(a: np.ndarray, b: np.ndarray) -> tuple[list[str], list[int]]:
    """What `in_order` says, and for each point of a the step of b which passes it, -1 where none does."""
    if len(b) < 2:
        return (["one point only"] if len(a) else []), [-1] * len(a)
    begin, step = b[:-1], np.diff(b, axis=0)
    length = np.maximum(np.linalg.norm(step, axis=1), 1e-150)
    lines, last, steps = [], 0.0, [-1] * len(a)
    for k, point in enumerate(a):
        share = np.clip(np.sum((point - begin) * step, axis=1) / length**2, 0, 1)
        away = np.linalg.norm(begin + share[:, None] * step - point, axis=1)
        near = np.flatnonzero(away <= SAG * length + ROUNDED)
        if not len(near):
            lines.append(f"point {k} of the record lies {away.min():.1e} aside")
            continue
        later = near[near + share[near] >= last - 1e-6]
        if not len(later):
            lines.append(f"point {k} of the record is passed earlier than the one before")
            continue
        best = later[np.argmax(away[later] <= away[later].min() + ROUNDED)]  # where it is passed twice, the first time
        last, steps[k] = float(best + share[best]), int(best)
    return lines, steps
