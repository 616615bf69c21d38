"""The kinds of pictures by name, in order of preference, for scenes and the command line; plotting/ draws them.

`Plottable` is what they are drawn of besides files and Datasets.
"""

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import xarray


class Plottable(Protocol):
    """A result that `vibro_sweep.plot` draws: an orbit, a branch, a curve or windows.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> orbit = vs.periodic_orbit(system, itinerary="R")  # is Plottable
    >>> len(vs.plot(orbit).axes)
    2
    """

    def to_xarray(self) -> "xarray.Dataset":
        """All its numbers."""


PICTURES = {  # name -> the function of plotting/, as MODULE.FUNCTION
    "basins": "basins.basins",
    "coexistence": "coexistence.coexistence",
    "plane": "planes.plane",
    "bifurcation": "sweeps.bifurcation",
    "lyapunov": "sweeps.lyapunov",
    "impacts": "sweeps.impacts",
    "contacts": "sizes_of_motion.contacts",
    "energy": "sizes_of_motion.energy",
    "phase-portrait": "orbit_pictures.phase_portrait",
    "configuration": "orbit_pictures.configuration",
    "history": "orbit_pictures.history",
    "contact-force": "contact_force.contact_force",
    "film": "film.film",
    "iteration": "orbit_pictures.iteration",
    "poincare": "orbit_pictures.poincare",
    "convergence": "convergence.convergence",
}
