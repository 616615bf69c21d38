"""vibro_sweep: bifurcation sweeps of the impact oscillator, with certified impacts and Lyapunov exponents."""

from importlib import import_module
from typing import TYPE_CHECKING

__version__ = "0.1.0"

_HOME = {
    "System": "system",
    "grazing": "system",
    "simulate": "orbit",
    "lyapunov": "orbit",
    "discontinuity_map": "discontinuity",
    "load_scene": "scene",
    "run": "sweep",
    "open": "store",
}

__all__ = ["System", "discontinuity_map", "grazing", "load_scene", "lyapunov", "open", "run", "simulate"]

if TYPE_CHECKING:
    from vibro_sweep.discontinuity import discontinuity_map
    from vibro_sweep.orbit import lyapunov, simulate
    from vibro_sweep.scene import load_scene
    from vibro_sweep.store import open
    from vibro_sweep.sweep import run
    from vibro_sweep.system import System, grazing


def __getattr__(name: str):
    """Import what is asked for when it is asked for: `--help` must not wait for numba."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
