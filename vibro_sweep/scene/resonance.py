"""Where the steady motion, which `tau: grazing` is the phase of, does not exist: undamped resonance."""

from typing import TYPE_CHECKING

import numpy as np

from vibro_sweep.model.grazing import grazing_phase
from vibro_sweep.model.modes import modes

from .problems import problem

if TYPE_CHECKING:
    from .scene import Scene

TUNED = ("mu_m", "mu_k", "omega")  # what decides whether an undamped mode is in resonance


def phase_problems(scene: "Scene") -> list[str]:
    """What is wrong with `tau: grazing` somewhere in the sweep; with memory for its axes, not for all of its points."""
    undamped = 0 in scene.sweep.get("zeta", [scene.system.zeta])
    if not undamped or scene.system.tau != "grazing" or "tau" in scene.sweep:
        return []
    numbers = {name: np.atleast_1d(scene.sweep.get(name, getattr(scene.system, name))) for name in TUNED}
    candidates = _candidates(numbers)
    phase = grazing_phase(candidates["mu_m"], candidates["mu_k"], 0.0, scene.system.f2, candidates["omega"])
    if np.isfinite(phase).all():
        return []
    text = "somewhere in the sweep an undamped mode is in resonance and no steady motion exists; give a number"
    return [problem("system.tau", scene.system.tau, text)]


def _candidates(numbers: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The points of the grid, each an entry of arrays of one length, at which a mode could be in resonance.

    Of a plane: for each value of one number the neighbours of those values of the other that solve
    det(K - omega^2 M) = (1 - omega^2)(1 + mu_k - mu_m omega^2) - 1 = 0.
    """
    swept = [name for name in TUNED if len(numbers[name]) > 1]
    if len(swept) < 2:
        return dict(zip(TUNED, np.broadcast_arrays(*numbers.values()), strict=True))
    second = swept[1]
    mu_m, mu_k, omega = numbers.values()
    with np.errstate(all="ignore"):
        if second == "omega":
            roots = np.sqrt(modes(mu_m, mu_k).omega_squared).T
        else:  # mu_k, of (mu_m, mu_k)
            roots = [1 / (1 - omega**2) - 1 + mu_m * omega**2]
    axis = np.sort(numbers[second])
    near = np.stack([np.searchsorted(axis, root) + step for root in roots for step in (-1, 0, 1)])
    numbers[second] = axis[np.clip(near, 0, len(axis) - 1)]
    return {name: values.ravel() for name, values in zip(TUNED, np.broadcast_arrays(*numbers.values()), strict=True)}
