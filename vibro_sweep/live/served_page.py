"""`vs.explore`: the page of a sweep, served by a thread of this process and shown in a notebook."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from vibro_sweep.checks.arguments import checked_interval, checked_word, names_its_arguments
from vibro_sweep.checks.errors import ArgumentError, ArgumentTypeError
from vibro_sweep.checks.file_names import checked_path
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.live.extra import needed
from vibro_sweep.live.presets import described_sweep, scene_of_results, scene_to_explore
from vibro_sweep.live.views import COLUMNS, span
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.scene import Scene, scene_of
from vibro_sweep.scene.written import changed

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
    if isinstance(system, Oscillator):
        scene = _swept(system, "b" if parameter is None else parameter, bounds)
    else:
        scene = _of_a_sweep(system)
        for name, value in (("parameter", parameter), ("bounds", bounds)):
            if value is not None:
                raise ArgumentError(not_allowed(name, value, "left out: what is given for system is swept already"))
    page = LivePage(scene)
    print(page.url)
    return page


def _swept(system: Oscillator, parameter: str, bounds: Sequence[float] | None) -> Scene:
    checked_word("parameter", parameter, tuple(system.described))
    value = float(getattr(system, parameter))
    lo, hi = span(value) if bounds is None else checked_interval("bounds", bounds, value)
    sweep = {parameter: {"start": lo, "stop": hi, "num": COLUMNS}}
    return scene_of(changed({}, {"system": system, "sweep": sweep, "transient": 1000, "record": 200}), "explore")


def _of_a_sweep(system: object) -> Scene:
    if isinstance(system, Scene):
        return described_sweep(system, "the scene")
    if isinstance(system, (str, Path)):
        return scene_to_explore(checked_path("system", system))
    attributes = getattr(system, "attrs", None)
    if isinstance(attributes, Mapping) and attributes:
        return scene_of_results(attributes, "the Dataset")
    raise ArgumentTypeError(not_allowed("system", system, "a System, an Oscillator, a scene, a sweep or its file"))
