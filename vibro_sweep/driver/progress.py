"""How far a run is: a bar on a terminal or in a notebook, a line a minute elsewhere."""

import contextlib
import logging
import sys
import time
from collections.abc import Callable, Iterator
from shutil import get_terminal_size

from vibro_sweep.checks import notices

_log = logging.getLogger("vibro_sweep")

DELAY = 2.0  # seconds before a bar is shown in a notebook, which keeps what is short
BETWEEN_LINES = 60.0  # seconds between lines in the output of a batch job

Tell = Callable[[int, int], None]  # (done, total)


@contextlib.contextmanager
def progress_bar(quiet: bool, always: bool = False) -> Iterator[Tell | None]:
    """What shows (done, total); None if quiet. always : a bar, wherever it is printed"""
    if quiet:
        yield None
    elif (notebook := _in_notebook()) or always or getattr(sys.stderr, "isatty", bool)():
        from tqdm import tqdm  # not needed elsewhere

        (columns, rows), delay = get_terminal_size(), DELAY if notebook else 0.0
        room = {"ncols": columns, "nrows": rows}
        with tqdm(unit=" orbits", delay=delay, leave=False, smoothing=0.0, file=sys.stderr, **room) as bar:

            def show(done: int, total: int) -> None:
                if bar.total is None:  # the first ones were there before
                    bar.initial = bar.n = done
                bar.total = total
                bar.update(done - bar.n)
                if done >= total:
                    bar.refresh()

            yield show
    else:
        yield lines()


def lines() -> Tell:
    """What logs (done, total) once a minute."""
    last = time.monotonic()

    def show(done: int, total: int) -> None:
        nonlocal last
        if time.monotonic() - last >= BETWEEN_LINES and done < total:
            last = time.monotonic()
            _log.info("%s of %s", f"{done:,}", f"{total:,}")

    return show


def _in_notebook() -> bool:
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return type(shell).__name__ == "ZMQInteractiveShell"


@contextlib.contextmanager
def given_or_bar(progress: Tell | bool | None) -> Iterator[Tell | None]:
    """The caller's progress; where there is none, the bar, unless notices are silenced. True: a bar; False: none."""
    if progress is not None and not isinstance(progress, bool):
        yield progress
        return
    with progress_bar(progress is False or (progress is None and not notices.shown()), progress is True) as bar:
        yield bar
