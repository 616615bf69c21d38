"""What functions take and return, for annotations and `isinstance`: `from vibro_sweep.types import Branch`.

Oscillators are in `vibro_sweep` itself: each is an `Oscillator`, of which `System` is one.
"""

from vibro_sweep.analysis.branches.branch import Branch
from vibro_sweep.analysis.branches.generations import FollowedBranch
from vibro_sweep.analysis.branches.special import SpecialPoint
from vibro_sweep.analysis.curves.bifurcation_curve import BifurcationCurve
from vibro_sweep.analysis.curves.curve_record import CurvePoint
from vibro_sweep.analysis.periodic.lcp import Born
from vibro_sweep.analysis.periodic.periodic_orbit import PeriodicOrbit
from vibro_sweep.analysis.single.discontinuity_map import DiscontinuityMap
from vibro_sweep.analysis.single.exponent_array import Exponents
from vibro_sweep.analysis.single.orbit import Orbit, Status
from vibro_sweep.analysis.windows.unvisited import Unvisited
from vibro_sweep.analysis.windows.window import Window, Windows
from vibro_sweep.driver.cost import Estimate
from vibro_sweep.driver.sweep import RunReport
from vibro_sweep.live.served_page import LivePage
from vibro_sweep.oscillator.contact_laws.compliant import StopLaw
from vibro_sweep.oscillator.family import Family
from vibro_sweep.oscillator.grazing import Grazing
from vibro_sweep.oscillator.linear import Linear, LinearContact
from vibro_sweep.oscillator.modes import Modes
from vibro_sweep.oscillator.quiet import Quiet
from vibro_sweep.oscillator.window_families import WindowFamily
from vibro_sweep.scene import Continuation, Scene, Section, Start, Trajectory
from vibro_sweep.tables.picture_kinds import Plottable
from vibro_sweep.tables.units import Units

__all__ = [
    "BifurcationCurve",
    "Born",
    "Branch",
    "Continuation",
    "CurvePoint",
    "DiscontinuityMap",
    "Estimate",
    "Exponents",
    "Family",
    "FollowedBranch",
    "Grazing",
    "Linear",
    "LinearContact",
    "LivePage",
    "Modes",
    "Orbit",
    "PeriodicOrbit",
    "Plottable",
    "Quiet",
    "RunReport",
    "Scene",
    "Section",
    "SpecialPoint",
    "Start",
    "Status",
    "StopLaw",
    "Trajectory",
    "Units",
    "Unvisited",
    "Window",
    "WindowFamily",
    "Windows",
]
