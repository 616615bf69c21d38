"""The progress bar: orbits done, their rate and the time left, whoever computes them."""

import contextlib
import sys

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn


@contextlib.contextmanager
def progress_bar(total: int, quiet: bool):
    """A callable (done, total) that draws on a terminal; None where nobody looks."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
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
