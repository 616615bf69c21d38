"""Bifurcation sweeps of linear oscillators that strike stops, with certified impacts and Lyapunov exponents.

At a prompt
    System, Oscillator, Contact, grazing, quiet, simulate, lyapunov, discontinuity_map
Sweeps
    sweep (from Python), load_scene, estimate and run (from YAML to an HDF5 file), open (that file as an
    xarray.Dataset), plot, explore (a page on which the diagram follows sliders), page (the same as one HTML file)
Periodic orbits
    periodic_orbit, continue_orbit, switch, follow_branches, bifurcation_curve, born_at_grazing, sticking_onset
    windows (of a sweep), load (what the results' `.save` wrote)
Errors
    VibroSweepError, the base of all; ParameterError, SceneError, StoreError, PlotError (each is a ValueError), RunError
For annotations
    vibro_sweep.types: Branch, PeriodicOrbit, SpecialPoint, Windows, Scene, ..., what functions take and return
"""

from importlib import import_module
from typing import TYPE_CHECKING

from vibro_sweep.checks import notices

__version__ = "0.3.0.dev0"

__all__ = [
    "Contact",
    "Oscillator",
    "ParameterError",
    "PlotError",
    "RunError",
    "SceneError",
    "StoreError",
    "System",
    "VibroSweepError",
    "bifurcation_curve",
    "born_at_grazing",
    "continue_orbit",
    "discontinuity_map",
    "estimate",
    "explore",
    "follow_branches",
    "grazing",
    "load",
    "load_scene",
    "lyapunov",
    "open",
    "page",
    "periodic_orbit",
    "plot",
    "quiet",
    "run",
    "simulate",
    "sticking_onset",
    "sweep",
    "switch",
    "windows",
]

if TYPE_CHECKING:
    from vibro_sweep.analysis.branches.branch import continue_orbit
    from vibro_sweep.analysis.branches.generations import follow_branches
    from vibro_sweep.analysis.branches.sticking import sticking_onset
    from vibro_sweep.analysis.curves.bifurcation_curve import bifurcation_curve
    from vibro_sweep.analysis.curves.curve_switching import switch
    from vibro_sweep.analysis.periodic.finding import periodic_orbit
    from vibro_sweep.analysis.periodic.lcp import born_at_grazing
    from vibro_sweep.analysis.single.discontinuity_map import discontinuity_map
    from vibro_sweep.analysis.single.orbit import lyapunov, simulate
    from vibro_sweep.checks.errors import VibroSweepError
    from vibro_sweep.checks.refusals import ParameterError
    from vibro_sweep.driver.any_file import open
    from vibro_sweep.driver.compute import RunError
    from vibro_sweep.driver.cost import estimate
    from vibro_sweep.driver.from_python import sweep
    from vibro_sweep.driver.loaded_results import load
    from vibro_sweep.driver.run import run
    from vibro_sweep.driver.windows import windows
    from vibro_sweep.files.file_errors import StoreError
    from vibro_sweep.live.served_page import explore
    from vibro_sweep.oscillator.contact_element import Contact
    from vibro_sweep.oscillator.grazing import grazing
    from vibro_sweep.oscillator.oscillator import Oscillator, System
    from vibro_sweep.oscillator.quiet import quiet
    from vibro_sweep.plotting.picture_files import PlotError
    from vibro_sweep.plotting.plot import plot
    from vibro_sweep.scene import SceneError, load_scene
    from vibro_sweep.standalone.page_file import page
else:
    _HOME = {
        "Contact": "oscillator.contact_element",
        "Oscillator": "oscillator.oscillator",
        "ParameterError": "checks.refusals",
        "PlotError": "plotting.picture_files",
        "RunError": "driver.compute",
        "SceneError": "scene",
        "StoreError": "files.file_errors",
        "System": "oscillator.oscillator",
        "VibroSweepError": "checks.errors",
        "bifurcation_curve": "analysis.curves.bifurcation_curve",
        "born_at_grazing": "analysis.periodic.lcp",
        "continue_orbit": "analysis.branches.branch",
        "discontinuity_map": "analysis.single.discontinuity_map",
        "estimate": "driver.cost",
        "explore": "live.served_page",
        "follow_branches": "analysis.branches.generations",
        "grazing": "oscillator.grazing",
        "load": "driver.loaded_results",
        "load_scene": "scene",
        "lyapunov": "analysis.single.orbit",
        "open": "driver.any_file",
        "page": "standalone.page_file",
        "periodic_orbit": "analysis.periodic.finding",
        "plot": "plotting.plot",
        "quiet": "oscillator.quiet",
        "run": "driver.run",
        "simulate": "analysis.single.orbit",
        "sticking_onset": "analysis.branches.sticking",
        "sweep": "driver.from_python",
        "switch": "analysis.curves.curve_switching",
        "windows": "driver.windows",
    }

    def __getattr__(name: str):
        """Import what is asked for when it is asked for: `--help` must not wait for numba."""
        if name == "types":
            return import_module(f"{__name__}.types")
        if name not in _HOME:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


notices.begin()


def __dir__() -> list[str]:
    """What users type; not what this module imports, nor the rooms of the package."""
    return [*__all__, *(name for name in globals() if name.startswith("__"))]
