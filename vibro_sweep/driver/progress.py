"""The progress bar: orbits done, their rate and the time left, whatever computes them."""

import contextlib
import logging
import sys
import time
from collections.abc import Callable, Iterator

from vibro_sweep.driver.notebook_bar import notebook_bar
from vibro_sweep.model import notices

_log = logging.getLogger("vibro_sweep")

BETWEEN_LINES = 60.0  # seconds between lines in the output of a batch job


@contextlib.contextmanager
def progress_bar(total: int, quiet: bool):
    """A callable (done, total) that draws on a terminal or in a notebook, or says it in a line a minute where neither
    is there; None if quiet."""
    if not quiet and _in_notebook():
        with notebook_bar() as show:
            yield show
        return
    if quiet:
        yield None
        return
    if not sys.stderr.isatty():
        yield lines()
        return
    from rich.console import Console  # slow to import
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = [
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("points  {task.fields[rate]}"),
        TimeRemainingColumn(),
    ]
    window = 600  # seconds over which the rate is taken: a block may take minutes
    with Progress(*columns, console=Console(stderr=True), transient=True, speed_estimate_period=window) as bar:
        task = bar.add_task("", total=total, rate="compiling")

        def show(done: int, total: int):
            bar.update(task, completed=done, total=total)
            speed = bar.tasks[task].speed
            if speed:  # known from the second block on
                bar.update(task, rate=f"{speed:,.0f}/s " if speed >= 10 else f"{speed:.2g}/s ")

        yield show


def lines() -> Callable[[int, int], None]:
    """A callable (done, total) that logs it once a minute."""
    said = time.monotonic()

    def show(done: int, total: int):
        nonlocal said
        if time.monotonic() - said >= BETWEEN_LINES and done < total:
            said = time.monotonic()
            _log.info("%s of %s", f"{done:,}", f"{total:,}")

    return show


def _in_notebook() -> bool:
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return type(shell).__name__ == "ZMQInteractiveShell"


@contextlib.contextmanager
def given_or_bar(
    progress: Callable[[int, int], None] | None, total: int
) -> Iterator[Callable[[int, int], None] | None]:
    """The caller's progress; where there is none, the bar, unless notices are silenced."""
    if progress is not None:
        yield progress
        return
    with progress_bar(total, not notices.shown()) as bar:
        yield bar
