"""The force of a compliant stop along a motion that has been sampled, and where the stop is."""

import numpy as np


def force_of(t, delta, speed, law, by_force: bool) -> tuple[np.ndarray, np.ndarray]:
    """The force of a compliant stop, and its place, of sampled motion (n,); delta: how far the mass is behind it.

    law : `StopLaw`, None of a rigid stop. A stop that was left by force relaxes by
    k s + c s' + p = 0, and is touched where delta >= s.
    """
    force, places = np.zeros(len(t)), np.zeros(len(t))
    if law is None:
        return force, places
    full = law.k * delta + law.c * speed + law.p
    if not (by_force and law.c > 0):
        return np.where(delta > 0, full, 0.0), np.maximum(np.nan_to_num(delta), 0.0)
    s, before, rest = 0.0, t[0], law.p / law.k
    for i in np.flatnonzero(np.isfinite(t)):
        s, before = max((s + rest) * np.exp(-law.k / law.c * (t[i] - before)) - rest, 0.0), t[i]
        if delta[i] > 0 and delta[i] >= s and full[i] > 0:
            s, force[i] = delta[i], full[i]
        places[i] = s
    return force, places
