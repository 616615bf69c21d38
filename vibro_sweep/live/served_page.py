"""`vs.explore`: the page of a sweep, served by a thread of this process and shown in a notebook."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from vibro_sweep.checks.arguments import names_its_arguments
from vibro_sweep.live.extra import needed
from vibro_sweep.live.shown_scene import shown_scene
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.scene import Scene

if TYPE_CHECKING:
    import xarray

HEIGHT = 760  # pixels in a notebook


class LivePage:
    """A page that can be opened at `url` until `close()` or the end of the process; a notebook shows it.

    url : its address on this machine, with the token without which nobody gets it

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
    >>> page = vs.explore(system)  # doctest: +ELLIPSIS
    http://127.0.0.1:...
    >>> page.url.startswith("http://127.0.0.1:")
    True
    >>> page.close()
    """

    def __init__(self, scene: Scene):
        with needed():
            from vibro_sweep.live.server import Serving
        self._serving = Serving({"sweep": scene}, "sweep")
        self.url = self._serving.address

    def close(self) -> None:
        """End the server; a page that is still open says so."""
        self._serving.close()

    def __repr__(self) -> str:
        return f"the live page at {self.url}"

    def _repr_html_(self) -> str:
        frame = f'<iframe src="{self.url}" width="100%" height="{HEIGHT}" style="border: 0"></iframe>'
        return f'{frame}<a href="{self.url}" target="_blank">The page in a window of its own</a>'


@names_its_arguments
def explore(
    system: "Oscillator | Scene | str | Path | xarray.Dataset",
    parameter: str | None = None,
    bounds: Sequence[float] | None = None,
) -> LivePage:
    """A page on which the diagram of a system follows sliders, as that of `vibro-sweep explore`; prints its address.

    The extra `explore` is needed: `pip install 'vibro_sweep[explore]'`.

    Parameters
    ----------
    system : a System or an Oscillator; or a sweep, whose view is the first one: a scene, its YAML file, the HDF5 file
        of its results, or what `vs.sweep` returned
    parameter : of a system, the number along which it is swept; by default the clearance b
    bounds : of a system, (lo, hi) around the value of this number; by default half to three halves of it

    Raises ValueError for what has no number to sweep, SceneError and StoreError for files, ImportError without the
    extra.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
    >>> page = vs.explore(system, "b", bounds=(4.2, 7))  # doctest: +ELLIPSIS
    http://127.0.0.1:...
    >>> page.close()
    """
    page = LivePage(shown_scene(system, parameter, bounds, "explore"))
    print(page.url)
    return page
