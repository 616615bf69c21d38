"""A small phase portrait of a periodic orbit, for tables in notebooks."""

import numpy as np

from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.oscillator.family import family_of
from vibro_sweep.oscillator.linear import forcing_period

WIDTH, HEIGHT, EDGE = 240, 160, 8  # of the drawing, in its own units
PIXELS = 84, 56
SAMPLES, MOST = 48, 600  # in a forcing period, and in all: a long orbit fills its picture anyway


def portrait(orbit: PeriodicOrbit) -> str:
    """The gap's velocity over the gap, between the stops, as SVG of a few kB; "" of an orbit without a motion."""
    if not orbit.period:
        return ""
    q = family_of(orbit.system).linear
    gap, rate = _closed_path(orbit, q)
    stops = [stop for stop in (q.contact.low, q.contact.high) if np.isfinite(stop)]
    x, y = _scaled(gap, [*gap, *stops], WIDTH), HEIGHT - _scaled(rate, rate, HEIGHT)
    walls = "".join(f"M{place} 0v{HEIGHT}" for place in _scaled(np.array(stops), [*gap, *stops], WIDTH))
    steps = zip(np.diff(x), np.diff(y), strict=True)
    pen = 3 if orbit.period <= 4 else 1.5
    path = f"M{x[0]} {y[0]}l" + " ".join(f"{dx} {dy}" for dx, dy in steps if dx or dy)
    return (
        f'<svg width="{PIXELS[0]}" height="{PIXELS[1]}" viewBox="0 0 {WIDTH} {HEIGHT}" fill="none" role="img" '
        f'aria-label="phase portrait"><path d="{walls}" stroke="currentColor" stroke-width="3" opacity="0.5"/>'
        f'<path d="{path}" stroke="#2f8fd8" stroke-width="{pen}"/></svg>'
    )


def _closed_path(orbit: PeriodicOrbit, q) -> tuple[np.ndarray, np.ndarray]:
    """Gap and velocity over a period, with both ends of the jump at each impact."""
    length = orbit.period * forcing_period(q)
    t, v = orbit.impacts["t"] % length, orbit.impacts["v1"]
    order = np.argsort(t)
    t, after = t[order], (-q.contact.restitution(orbit.impacts["side"]) * v)[order]
    times = np.unique(np.concatenate([np.linspace(0, length, min(SAMPLES * orbit.period, MOST) + 1), t]))
    states = orbit.sample(times)
    gap, rate = states[:, ::2] @ q.contact.normal, states[:, 1::2] @ q.contact.normal
    where = np.searchsorted(times, t) + 1
    return np.insert(gap, where, gap[where - 1]), np.insert(rate, where, after)


def _scaled(values: np.ndarray, within, size: int) -> np.ndarray:
    """Whole numbers from EDGE to size - EDGE; the middle where all are the same."""
    low, high = np.min(within), np.max(within)
    share = (values - low) / (high - low) if high > low else np.full(len(values), 0.5)
    return np.rint(EDGE + share * (size - 2 * EDGE)).astype(int)
