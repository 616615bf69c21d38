"""A sweep from Python, without YAML: from a system and axes to an `xarray.Dataset`."""

import itertools
import secrets
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from vibro_sweep.checks.arguments import accepts, check_type, names_its_arguments
from vibro_sweep.checks.errors import ArgumentError, ArgumentTypeError
from vibro_sweep.checks.file_names import file_to_write
from vibro_sweep.checks.real import number_of
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.driver.any_file import open
from vibro_sweep.driver.provenance import provenance
from vibro_sweep.driver.sweep import check_how, fill, run_sweep
from vibro_sweep.files.subject import about_run
from vibro_sweep.oscillator.function_model import FunctionModel
from vibro_sweep.oscillator.oscillator import Oscillator, checked_system
from vibro_sweep.results import layout
from vibro_sweep.results.in_memory import InMemory
from vibro_sweep.scene import Section, Start, Trajectory, scene_of
from vibro_sweep.scene.written import axis_data, changed
from vibro_sweep.tables.coordinates import START, checked_state

if TYPE_CHECKING:
    import numpy as np
    import xarray

MOST = 10**9  # bytes of results without a file of the caller's


def _first(name: str, values: object) -> float:
    """The first value of an axis, as it is written. Raises ValueError."""
    data = axis_data(values)
    if not name.isidentifier() or name.startswith("_"):
        raise ArgumentError(not_allowed("axes", name, "of names that begin with a letter"))
    first = number_of(data.get("start", next(iter(data.get("values") or ()), None))) if isinstance(data, dict) else None
    if first is None:
        raise ArgumentError(not_allowed(f"axes.{name}", values, "numbers, or an axis as in YAML"))
    return first


@names_its_arguments
def sweep(
    system: Oscillator | Callable[..., Oscillator],
    axes: "Mapping[str, np.ndarray | Sequence[float] | Mapping[str, Any]]",
    *,
    observe: Iterable[str] = ("section", "lyapunov"),
    start: "Start | Mapping[str, Any] | Sequence[float] | None" = None,
    transient: int = 1300,
    settle: int | None = None,
    record: int = 200,
    section: "Section | Mapping[str, Any] | None" = None,
    trajectory: "Trajectory | Mapping[str, Any] | None" = None,
    workers: int | None = None,
    output: str | Path | None = None,
    progress: Callable[[int, int], None] | bool | None = None,
    mode: Literal["new", "resume", "overwrite"] = "new",
) -> "xarray.Dataset":
    """Sweep one number or two of a system, or of the initial state; the results as an `xarray.Dataset`.

    Parameters
    ----------
    system : a System or an Oscillator; or a function from the swept numbers, by whatever names, to one of these. The
        file then says so (`type`: build) and holds the matrices of every point. It is continued, or found complete, by
        a function of the same name that makes the same matrices (compared at 4096 points at most).
    axes : name -> values (n,), rising or falling, as {"b": np.linspace(6.5, 6.9, 2001)}; or an axis as in YAML, as
        {"b": {"start": 6.5, "stop": 6.9, "step": 0.0002}}, whose values are the decimal numbers
    observe, start, section, trajectory : as the keys of a scene in YAML; `start` may be a state (x1, v1, x2, v2) too
    transient, record : forcing periods
    settle : forcing periods up to which orbits go on that are still under way after their transient; None: none does
    workers, progress : as of `run`
    output : a file, which is kept and read when numbers are used; needed where the results take more than 1 GB
    mode : as of `run`: "resume" continues an interrupted `output`, "overwrite" replaces it

    Outcomes of points are in `status`. Raises TypeError where `system` is not a System, `SceneError` for what is no
    scene, ValueError for more results than go without a file, and what `run` raises.

    Examples
    --------
    >>> import numpy as np
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> data = vs.sweep(system, {"b": np.linspace(3, 4.4, 8)}, transient=500, record=100)
    >>> data.period.values
    array([1, 1, 1, 1, 1, 1, 1, 0])
    >>> bool(data.lyapunov.sel(b=4.2, exponent=1, method="nearest") < 0)
    True
    """
    first: dict[str, float] = {}
    check_type("axes", axes, Mapping, "a mapping from names to values")
    for name in axes:
        check_type("axes", name, str, "of names")
    check_how(workers, None, progress, mode)
    if output is not None:
        output = file_to_write("output", output)
    if callable(system) and not isinstance(system, Oscillator):
        first = {name: _first(name, values) for name, values in axes.items() if name not in START}
        if not accepts(system, **first):
            raise ArgumentTypeError(
                not_allowed("system", system, f"a System, an Oscillator, or a function of {', '.join(first)}")
            )
        system = FunctionModel(system, first)
    checked_system(system)
    if start is not None and not isinstance(start, (str, Mapping, Start)):
        checked_state(start, system.masses, "start")
    arguments = {"sweep": axes, "start": start, "transient": transient, "settle": settle, "record": record}
    arguments |= {"section": section, "observe": observe, "trajectory": trajectory}
    scene = scene_of({"system": system} | changed({}, arguments), "sweep")
    if isinstance(system, FunctionModel):
        for corner in itertools.product(
            *(values[[0, -1]].tolist() for name, values in scene.sweep.items() if name in first)
        ):
            system.compare_units(first | dict(zip(first, corner, strict=True)))
    quantities = layout.quantities(scene)
    reserved = {*quantities, *(dimension for quantity in quantities.values() for dimension in quantity.dimensions)}
    reserved |= {"gap", "gap_velocity"}  # pictures form these of positions and velocities
    reserved |= {"start"} if scene.n_starts > 1 else set()
    for name in reserved.intersection(scene.sweep):
        raise ArgumentError(not_allowed("axes", name, f"of other names than {', '.join(sorted(reserved))}"))
    if output is None and mode != "new":
        raise ArgumentError(not_allowed("mode", mode, "'new' without a file, `output`"))
    if output is not None:
        run_sweep(scene, output, workers, progress=progress, mode=mode)
        return open(output)
    if layout.size(scene) > MOST:
        size, most = layout.size(scene) / 1e9, MOST / 1e9
        raise ArgumentError(
            f"output: None is not allowed; it must be a file, the results take {size:.3g} GB > {most:g} GB"
        )
    empty = layout.dataset(scene)
    result = InMemory(empty.assign_attrs(about_run(empty.attrs, provenance(), secrets.token_hex(16))))
    fill(scene, result, workers, progress=progress)
    return result.data
