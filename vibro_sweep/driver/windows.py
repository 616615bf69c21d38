"""From the file of a sweep to its windows: `vibro_sweep.windows`, and the file of windows."""

from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from pathlib import Path
from types import NoneType

import numpy as np

from vibro_sweep import store
from vibro_sweep.analysis.branches.flat import SHAPES, Flat
from vibro_sweep.analysis.windows.cover import Cover
from vibro_sweep.analysis.windows.job import window_of
from vibro_sweep.analysis.windows.rows import Row, check_data, chosen_key, rows_of
from vibro_sweep.analysis.windows.unseen import unseen_in
from vibro_sweep.analysis.windows.window import Windows, in_file_order, windows_of
from vibro_sweep.driver.jobs import computed, workers_of
from vibro_sweep.driver.provenance import provenance
from vibro_sweep.driver.source_file import computed_from
from vibro_sweep.driver.usable import is_window
from vibro_sweep.model.arguments import check_type
from vibro_sweep.model.branch_file import WINDOWS, columns_of
from vibro_sweep.model.built import BUILD
from vibro_sweep.model.files import checked_path, file_to_write
from vibro_sweep.model.state import state
from vibro_sweep.model.window_columns import UNSEEN
from vibro_sweep.progress import given_or_bar
from vibro_sweep.scene import parse_scene
from vibro_sweep.store.arrays import Contents
from vibro_sweep.store.flat_files import Subject
from vibro_sweep.store.joining import joined
from vibro_sweep.store.pieces import Pieces, pieces


def windows(path: str | Path, key: str | None = None) -> Windows:
    """The windows of a sweep: where each of its periodic orbits is stable, and what ends it there.

    Parameters
    ----------
    path : the HDF5 file of a sweep that observes `section`
    key : the swept number along which windows are followed, by default the first that is one of the system's; of a
        plane each row by itself

    Returns a list of windows with .lo, .hi, .lower, .upper (special points), .period, .itinerary, .symmetric and
    .orbit. Mirror images are one window, and so is an orbit that several points of the sweep found. Ends may lie
    beyond the sweep, by its length at most. `.reason` of the list says of orbits in no window why; `.unseen` lists the
    stretches of windows on which the sweep shows other attractors only, each with a start.

    Raises StoreError for a file that cannot be read, ValueError for one that has no windows to look for.
    """
    path = checked_path("path", path)
    check_type("key", key, (str, NoneType), "the name of a swept number, or None")
    with computed_from(path):
        with store.contents(path) as data:
            cover = Cover(rows_in(data, key))
        with given_or_bar(None, cover.total) as tell:

            def evaluate(_, jobs) -> Iterator[Flat]:
                for job in jobs:
                    yield window_of(job)
                    if tell:
                        tell(cover.done, cover.total)

            cover.search(evaluate)
        return windows_of(cover)


def run_windows(
    path: str | Path,
    output: str | Path,
    key: str | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | None = None,
    mode: str = "new",
) -> None:
    """Write the file of a sweep's windows; arguments as of `windows` and `run`.

    progress : called as progress(done, total) in orbits of the sweep
    The file does not depend on workers, executor or interruptions. Raises what `windows` and `run` raise.
    """
    path, output = checked_path("path", path), file_to_write("output", output)
    with computed_from(path):
        with store.contents(path) as data:
            rows = rows_in(data, key)
            subject = _subject(data, rows[0].parameter)
        with pieces(subject, output, mode, [path]) as file:
            if file.complete:
                return
            with workers_of(workers, executor) as pool:
                cover = cover_of(rows, file, pool, progress)
            if progress:
                progress(cover.total, cover.total)
            file.finish(provenance(), *_contents(cover))


def cover_of(
    rows: list[Row], file: Pieces, pool: Executor | None, progress: Callable[[int, int], None] | None = None
) -> Cover:
    """The windows of rows; those that `file` has pieces of are not followed again."""
    cover = Cover(rows)
    tell = (lambda *_: progress(cover.done, cover.total)) if progress else None
    cover.search(computed(window_of, is_window, pool, file, tell))
    return cover


def rows_in(data: Contents, key: str | None) -> list[Row]:
    """The rows of a file along a swept number. Raises ValueError where there can be no windows."""
    if data.attrs.get("type") == BUILD:
        raise ValueError("type: 'build' is not allowed; the function that made the oscillators is not in the file")
    check_data(data)
    system = parse_scene(data.attrs["scene"]).system
    return list(rows_of(data, system, chosen_key(data, system, key)))


def _subject(data: Contents, key: str) -> Subject:
    title = str(data.attrs["title"]).removeprefix("vibro_sweep: ")
    names = [key, *(str(name) for name in np.atleast_1d(data.attrs["sweep_dimensions"]) if name != key)]
    attributes = {"sweep": data.attrs.get("identity", ""), "key": key, "parameters": names}
    return Subject(WINDOWS, f"windows of {title}", data.attrs["scene"], attributes)


def _contents(cover: Cover) -> tuple:
    """Columns and arrays of the file."""
    first, found = cover.rows[0], cover.found
    names = [first.parameter, *first.held]
    masses = first.system.masses
    flats = [one.flat for one in found]
    held = [tuple(cover.rows[one.row].held.values()) for one in found]
    arrays = joined(flats, SHAPES, names, masses, held)
    none = np.full(len(found), -1, np.int32)
    arrays |= {"branch_parent": none, "branch_parent_special": none, "branch_generation": 0 * none}
    ends = np.array([one.ends for one in found]).reshape(len(found), 2)
    window, reason = in_file_order(cover)
    arrays |= {
        "window_lo": ends[:, 0],
        "window_hi": ends[:, 1],
        "window_lower": arrays["branch_begins"],
        "window_upper": arrays["branch_ends"],
        "window_period": arrays["branch_period"],
        "window_symmetric": arrays["branch_symmetric"],
        "window_branch": np.arange(len(found)),
        "window_row": np.array([one.row for one in found], int),
        "window_orbits": cover.counts,
        "window_missed": cover.missed,
        "orbit_window": window.ravel(),
        "orbit_reason": reason.ravel(),
    }
    arrays |= _unseen(cover, masses)
    return columns_of(WINDOWS, names, first.system), arrays


def _unseen(cover: Cover, masses: int) -> dict[str, np.ndarray]:
    """The columns over `unseen`."""
    found, names = unseen_in(cover), state(masses)
    states = np.array([one.state for one in found]).reshape(len(found), len(names))
    numbers = {f"unseen_{key}": np.array([getattr(one, key) for one in found]) for key in UNSEEN}
    return numbers | {f"unseen_{name}": states[:, i] for i, name in enumerate(names)}
