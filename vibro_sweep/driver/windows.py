"""From the file of a sweep to its windows: `vibro_sweep.windows`, and the file of windows."""

from collections.abc import Callable
from concurrent.futures import Executor
from functools import partial
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from vibro_sweep.analysis.branches.branch_arrays import SHAPES, Arrays
from vibro_sweep.analysis.single.orbit import simulate
from vibro_sweep.analysis.windows.job import window_of
from vibro_sweep.analysis.windows.rows import REASON_CODES, Row, check_data, chosen_key, rows_of
from vibro_sweep.analysis.windows.unvisited import unvisited_in
from vibro_sweep.analysis.windows.window import Windows, in_file_order, windows_of
from vibro_sweep.analysis.windows.window_search import WindowSearch
from vibro_sweep.checks.arguments import check_type, names_its_arguments
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.file_names import checked_path, file_to_write
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.driver.executors import kept, workers_of
from vibro_sweep.driver.joining import joined
from vibro_sweep.driver.progress import given_or_bar
from vibro_sweep.driver.provenance import provenance
from vibro_sweep.driver.source_file import SourceError, run_id_of, swept
from vibro_sweep.driver.sweep import check_how
from vibro_sweep.files.pieces import Pieces, pieces_run
from vibro_sweep.files.subject import Complete
from vibro_sweep.results import ragged_dataset
from vibro_sweep.results.sweep_dataset import Sweep
from vibro_sweep.scene import parse_scene
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.file_columns import UNVISITED, WINDOWS

if TYPE_CHECKING:
    import xarray

FAR = 1e-2  # of the size of a state: by so much no periodic orbit of a sweep misses where it began


@names_its_arguments
def windows(
    data: "str | Path | xarray.Dataset",
    parameter: str | None = None,
    output: str | Path | None = None,
    workers: int | None = None,
    progress: Callable[[int, int], None] | bool | None = None,
    mode: Literal["new", "resume", "overwrite"] = "new",
) -> Windows:
    """The windows of a sweep: where each of its periodic orbits is stable, and what ends it there.

    Parameters
    ----------
    data : the HDF5 file of a sweep that observes `section`, or a Dataset of `open` or `sweep`
    parameter : the swept number along which windows are followed, by default the first that is one of the system's; of
        a plane each row by itself
    output : the HDF5 file of the windows, if there is to be one; it does not depend on workers or interruptions
    workers : processes, by default one
    progress : as of `run`, in orbits of the sweep
    mode : of `output`, as of `run`

    Returns a list of windows with .lo, .hi, .lower, .upper (special points), .period, .itinerary, .symmetric and
    .orbit. Mirror images are one window, and so is an orbit that several points of the sweep found. Ends may lie
    beyond the sweep, by its length at most. `.reason` of the list says of orbits in no window why; `.unvisited` lists
    the stretches of windows on which the sweep shows other attractors only, each with a start.

    Raises StoreError for a file that cannot be read or is in the way, ValueError for a sweep that has no windows to
    look for, and what `run` raises.

    Examples
    --------
    >>> import numpy as np
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> data = vs.sweep(system, {"b": np.linspace(3, 4.4, 8)}, transient=500, record=100)
    >>> [(one.itinerary, round(one.hi, 6), one.upper.type) for one in vs.windows(data)]
    [('LR', 3.892819, 'pitchfork'), ('R', 4.347418, 'neimark_sacker')]
    """
    check_type("parameter", parameter, (str, NoneType), "the name of a swept number, or None")
    check_how(workers, None, progress, mode)
    if output is None and mode != "new":
        raise ArgumentError(not_allowed("mode", mode, "'new' without a file, `output`"))
    search = None
    with given_or_bar(progress) as tell:
        if output is not None:
            search = run_windows(data, output, parameter, workers, None, tell, mode)
        with swept(data) as sweep:
            rows = rows_in(sweep, parameter)
            if search is None:
                with workers_of(workers, None) as pool:
                    search = search_of(rows, NothingKept(), pool, tell)
            result = windows_of(search)
            result._dataset = partial(_dataset, _about(sweep, rows[0].parameter), search)
            return result


def run_windows(
    data: "str | Path | xarray.Dataset",
    output: str | Path,
    parameter: str | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | bool | None = None,
    mode: str = "new",
) -> WindowSearch | None:
    """Write the file of a sweep's windows; arguments and errors as of `windows` and `run`. None: it is complete
    already."""
    output = file_to_write("output", output)
    inputs = [checked_path("data", data)] if isinstance(data, (str, Path)) else []
    with swept(data) as sweep:
        rows = rows_in(sweep, parameter)
        header = _about(sweep, rows[0].parameter)
        with pieces_run(header, output, mode, provenance(), inputs) as file:
            if isinstance(file, Complete):
                return None
            with workers_of(workers, executor) as pool:
                search = search_of(rows, file, pool, progress)
            if progress:
                progress(search.total, search.total)
            file.finish(_dataset(header, search))
            return search


class NothingKept:
    """The pieces of a run without a file."""

    def get(self, _key: str) -> None:
        """Nothing is known already."""

    def write(self, _key: str, _arrays: Arrays) -> None:
        """Nothing is kept."""


def search_of(
    rows: list[Row],
    file: Pieces | NothingKept,
    pool: Executor | None,
    progress: Callable[[int, int], None] | bool | None = None,
) -> WindowSearch:
    """The windows of rows; those that `file` has pieces of are not followed again."""
    search, most = WindowSearch(rows), 0

    def tell(done: int, jobs: int) -> None:  # each orbit that is followed has the window of some of those left, soon
        nonlocal most
        soon = search.done + (search.total - search.done) * done // jobs
        most = max(most, min(soon, search.total - 1))
        if progress:
            progress(most, search.total)

    search.search(kept(window_of, pool, file, tell))
    return search


def rows_in(data: Sweep, parameter: str | None) -> list[Row]:
    """The rows of a sweep along a swept number. Raises ValueError where there can be no windows."""
    check_data(data)
    system = parse_scene(data.attrs["scene"]).system
    system = system.replace(**{name: value for name, value in data.held.items() if name in system.described})
    rows = list(rows_of(data, system, chosen_key(data, system, parameter)))
    if all((row.reason == REASON_CODES["not_computed"]).all() for row in rows):
        raise ArgumentError("status: no orbit is computed yet; windows start from the section states of a sweep")
    for row in rows if data.in_memory else ():
        _check_orbit(row)
    return rows


def _check_orbit(row: Row) -> None:
    """Raise ValueError where a periodic orbit of a row does not come back to where it is.

    Attributes of one sweep beside numbers of another, as `xarray.concat` leaves them, would give windows of neither.
    """
    places = np.argwhere(row.reason == 0)
    if not len(places) or row.system.options.get("release") == "force":  # where a state leaves out how stops relax
        return
    i, j = places[len(places) // 2]
    system, begin = row.system_at(row.values[i]), row.states[i, j]
    end = simulate(system, begin, int(row.period[i, j])).section[-1]
    size = max(np.abs(row.states[row.reason == 0]).max(), system.numbers.get("b") or 0.0)
    if np.abs(end - begin).max() > FAR * size:
        raise SourceError(
            f"the orbit at {row.parameter} = {row.values[i]:.10g} is not one of the oscillator that the attributes and "
            "the scene describe; they belong to another sweep"
        )


def _about(data: Sweep, parameter: str) -> dict[str, Any]:
    """The attributes of the windows of a sweep."""
    title = str(data.attrs["title"]).removeprefix("vibro_sweep: ")
    names = [parameter, *(name for name in data.keys if name != parameter)]
    attributes = {"sweep": run_id_of(data), "parameter": parameter, "parameters": names}
    attributes["sweep_shape"] = np.array([*(data.sizes[name] for name in data.keys), data.sizes.get("start", 1)])
    attributes |= {key: data.attrs[key] for key in ("picture_units",) if key in data.attrs}
    attributes |= data.held  # of a part of a Dataset: the values of numbers that were swept
    return ragged_dataset.attributes_of(WINDOWS, f"windows of {title}", data.attrs["scene"], attributes)


def _dataset(header: dict[str, Any], search: WindowSearch) -> "xarray.Dataset":
    return ragged_dataset.dataset(header, *_contents(search))


def _contents(search: WindowSearch) -> tuple:
    """Columns and arrays of the file."""
    first, windows_found = search.rows[0], search.found
    names = [first.parameter, *first.held]
    masses = first.system.masses
    all_arrays = [window.arrays for window in windows_found]
    held = [tuple(search.rows[window.row].held.values()) for window in windows_found]
    arrays = joined(all_arrays, SHAPES, names, masses, held)
    none = np.full(len(windows_found), -1, np.int32)
    arrays |= {"branch_parent": none, "branch_parent_special": none, "branch_generation": 0 * none}
    ends = np.array([window.ends for window in windows_found]).reshape(len(windows_found), 2)
    window, reason = in_file_order(search)
    arrays |= {
        "window_lo": ends[:, 0],
        "window_hi": ends[:, 1],
        "window_lower": arrays["branch_begins"],
        "window_upper": arrays["branch_ends"],
        "window_period": arrays["branch_period"],
        "window_symmetric": arrays["branch_symmetric"],
        "window_branch": np.arange(len(windows_found)),
        "window_row": np.array([window.row for window in windows_found], int),
        "window_orbits": search.counts,
        "window_other_attractor": search.other_attractor,
        "orbit_window": window.ravel(),
        "orbit_reason": reason.ravel(),
    }
    arrays |= _unvisited(search, masses)
    return ragged_dataset.columns_in_file(WINDOWS, names, first.system), arrays


def _unvisited(search: WindowSearch, masses: int) -> dict[str, np.ndarray]:
    """The columns over `unvisited`."""
    starts, names = unvisited_in(search), state(masses)
    states = np.array([start.state for start in starts]).reshape(len(starts), len(names))
    numbers = {f"unvisited_{key}": np.array([getattr(start, key) for start in starts]) for key in UNVISITED}
    return numbers | {f"unvisited_{name}": states[:, i] for i, name in enumerate(names)}
