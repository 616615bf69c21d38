"""The kinds of pictures by name, in order of preference, for scenes and the command line; plotting/ draws them.

`Plottable` is what they are drawn of besides files and Datasets.
"""

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import xarray


class Plottable(Protocol):
    """A result that `vibro_sweep.plot` draws: an orbit, a branch, a curve or windows."""

    def to_xarray(self) -> "xarray.Dataset":
        """All its numbers."""


PICTURES = (
    "basins",
    "coexistence",
    "plane",
    "bifurcation",
    "lyapunov",
    "impacts",
    "energy",
    "phase-portrait",
    "configuration",
    "history",
    "iteration",
    "poincare",
    "convergence",
)
