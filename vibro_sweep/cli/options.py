"""Values of the command line's options: what their texts mean, and what is wrong with them."""

import contextlib
import os
from pathlib import Path

import typer
from typer.models import OptionInfo

from vibro_sweep.tables.units import Display, display_of, why_no_display

from .console import InputError


def positive(text: str) -> int:
    from vibro_sweep.driver import MOST_WORKERS

    if not text.isdecimal() or len(text) > 9 or not 1 <= int(text) <= MOST_WORKERS:
        raise typer.BadParameter(f"{text!r} is not a whole number >= 1 and <= {MOST_WORKERS}")
    return int(text)


def output_file(text: str) -> Path:
    if text.endswith(("/", os.sep)):
        raise typer.BadParameter(f"{text!r} names a folder; it must name a file")
    return Path(text).expanduser()  # --output=~/FILE: a shell replaces ~ at the beginning of a word alone


def scene_file(text: str) -> Path:
    """The path of a scene; - is what comes from the standard input."""
    path = Path("/dev/stdin" if text == "-" else text)
    if not path.exists():
        raise typer.BadParameter(f"file {text!r} does not exist")
    if path.is_dir():
        raise typer.BadParameter(f"file {text!r} is a directory")
    return path


def output(metavar: str, default: str) -> OptionInfo:
    """The option that names the file to be written."""
    return typer.Option("-o", "--output", parser=output_file, metavar=metavar, help=f"By default {default}.")


def executor_of(scheduler: str | None) -> contextlib.AbstractContextManager:
    """The executor of a Dask scheduler, or None for threads."""
    if scheduler is None:
        return contextlib.nullcontext()
    try:
        from vibro_sweep.driver.cluster import ClusterError, cluster
    except ImportError:
        text = f"--scheduler {scheduler} needs the package dask.distributed: pip install distributed"
        raise InputError(text) from None

    @contextlib.contextmanager
    def connected():
        try:
            with cluster(scheduler) as executor:
                yield executor
        except ClusterError as error:
            raise InputError(f"--scheduler {scheduler}: {error}") from None

    return connected()


def display_option(names: str | None, as_json: bool = False) -> Display | None:
    """The units of --units; None: those of the file. Not with JSON, whose numbers are the stored ones."""
    if names is None:
        return None
    if as_json:
        raise InputError(f"--units {names}: leave it out with --json, whose numbers are those of the file")
    if (display := display_of(names)) is None:
        raise InputError(f"--units {names}: {why_no_display(names)}")
    return display


def key_and_value(text: str) -> tuple[str, float]:
    """NAME=VALUE, as --at has it."""
    key, equals, value = text.partition("=")
    if not equals:
        raise InputError(f"--at {text}: write NAME=VALUE, for example b=6.6")
    return key.strip(), number_in(f"--at {key}", value)


def number_in(option: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f"{option}: {text!r} is not a number") from None
