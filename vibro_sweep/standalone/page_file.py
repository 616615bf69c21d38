"""`vs.page` and `vibro-sweep page`: a diagram as one HTML file, which computes where it is opened."""

import os
import secrets
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vibro_sweep.checks.arguments import check_type, names_its_arguments
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.file_names import ExistingFileError, FileError, file_to_write
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.engine.points.any_points import kind_of
from vibro_sweep.files.disk import obstacle, publish
from vibro_sweep.live import requests
from vibro_sweep.live.model_words import model_words
from vibro_sweep.live.shown_scene import shown_scene
from vibro_sweep.live.views import PEAKS, view_of
from vibro_sweep.oscillator.checked_numbers import range_of
from vibro_sweep.oscillator.linear import stacked
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.scene import Scene
from vibro_sweep.standalone.formulas import formulas_of, is_variable
from vibro_sweep.standalone.kernel_module import module_of
from vibro_sweep.standalone.single_file import html_of

if TYPE_CHECKING:
    import xarray

MOST = {
    "columns": requests.MOST_COLUMNS,
    "transient": requests.MOST_TRANSIENT,
    "record": requests.MOST_RECORD,
    "dots": requests.MOST_DOTS,
    "periods": requests.MOST_PERIODS,
}
NOT_SET_UP = 100  # status of a point that a page cannot set up (parts/block.js)
UNLIKE = "such an oscillator cannot be set up by this page; vibro-sweep computes it"


@names_its_arguments
def page(
    system: "Oscillator | Scene | str | Path | xarray.Dataset",
    output: str | Path,
    parameter: str | None = None,
    bounds: Sequence[float] | None = None,
    overwrite: bool = False,
) -> Path:
    """Write a page as that of `vs.explore` into one HTML file, which computes by itself in any browser.

    It needs no program and no server where it is opened: from a disk, an e-mail or a web site. The kernels of this
    program are in it, as WebAssembly: no impact is missed there either. Sliders, zoom, exponents and the orbit at a
    click are those of the live page; why a window ends is not computed there. Where the installation has no code for
    its kind of machine, that takes half a minute to make and the extra `page`: `pip install 'vibro_sweep[page]'`.

    Parameters
    ----------
    system : a System or an Oscillator; or a sweep, whose view is the first one: a scene, its YAML file, the HDF5 file
        of its results, or what `vs.sweep` returned
    output : the HTML file
    parameter : of a system, the number along which it is swept; by default the clearance b
    bounds : of a system, (lo, hi) around the value of this number; by default half to three halves of it
    overwrite : replace an `output` that exists

    Returns the path. Raises ValueError for what has no number to sweep and for what pages do not compute, SceneError
    and StoreError for files, FileExistsError for an output that is there, ImportError without the extra.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6)
    >>> vs.page(system, "diagram.html", bounds=(4.2, 7))  # doctest: +SKIP
    PosixPath('diagram.html')
    """
    path = file_to_write("output", output)
    check_type("overwrite", overwrite, bool, "True or False")
    check_output(path, overwrite)
    write_page(shown_scene(system, parameter, bounds, path.stem), path, overwrite)
    return path


def check_output(path: Path, overwrite: bool) -> None:
    """Raise FileError where a page cannot be written."""
    if path.suffix.lower() not in (".html", ".htm"):
        raise ArgumentError(not_allowed("output", str(path), "the name of an HTML file: it ends with .html"))
    if reason := obstacle(path):
        raise FileError(path, f"it {reason}")
    if os.path.lexists(path) and not overwrite:
        raise ExistingFileError(path)


def write_page(scene: Scene, path: Path, overwrite: bool) -> None:
    """Write the page of a scene. Raises as `page`."""
    text, new = page_text(scene), path.with_name(f".{path.name}.{secrets.token_hex(4)}")
    try:
        new.write_text(text, encoding="utf-8")
        publish(new, path, replaces=overwrite)
    except FileExistsError:
        raise ExistingFileError(path) from None
    except OSError as error:
        raise FileError(path, error.strerror or str(error)) from None
    finally:
        new.unlink(missing_ok=True)


def page_text(scene: Scene) -> str:
    """The HTML file of a scene. Raises ArgumentError for what no page computes, and MissingPackageError."""
    system, formulas = scene.system, formulas_of(scene.system)
    if scene.dynamics != "flow":
        raise ArgumentError("page shows the oscillator itself, and not its discontinuity mapping; explore shows both")
    if formulas is None:
        raise ArgumentError(f"page needs a model whose numbers follow from formulas; {system.model.name} has others")
    kind = kind_of(stacked([system.linear]))._replace(constant=True)  # it has room for that force, which may be zero
    return html_of(formulas, kind, module_of(kind), _known(scene), scene.name)


def _known(scene: Scene) -> dict[str, Any]:
    """All that a page knows of its oscillator, for JSON."""
    system, view, numbers = scene.system, view_of(scene), scene.system.family.numbers
    variable = [name for name in numbers if is_variable(system, name)]
    words = model_words(scene, view)
    words |= {"view": view.model_dump(), "name": "", "presets": [], "mapping": False}
    words["heights"] = [height for height in words["heights"] if height[0] not in PEAKS]
    words["statuses"] |= {str(NOT_SET_UP): UNLIKE}
    return {
        "model": words,
        "numbers": {name: numbers[name] for name in variable if numbers[name] is not None},
        "leaders": {name: system.described[name].follows for name in variable if numbers[name] is None},
        "ranges": {name: _range(system, name) for name in variable},
        "release": int(system.linear.contact.by_force),
        "most": MOST,
    }


def _range(system: Oscillator, name: str) -> list:
    """What a number may be: in words, from, to, and whether the least one is excluded; null where there is no bound."""
    allowed = range_of(system.described[name], system.options.get("stops", "both"))
    bounds, excluded = allowed.bounds, "exclusiveMinimum" in allowed.bounds
    return [allowed.text, bounds.get("exclusiveMinimum" if excluded else "minimum"), bounds.get("maximum"), excluded]
