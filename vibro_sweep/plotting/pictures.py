"""Pictures as files: a figure or a film is encoded in the format that its suffix names."""

import contextlib
import io
import logging
from collections.abc import Collection, Iterator
from pathlib import Path

import matplotlib
from matplotlib.figure import Figure

from vibro_sweep.plotting.film import Film
from vibro_sweep.plotting.picture_files import FILMS, PlotError, check_output, write
from vibro_sweep.plotting.style import STYLE


def save(fig: Figure, output: Path, overwrite: bool, inputs: Collection[Path]) -> Path:
    """Write a picture. Raises PlotError for an output that exists and is not to be replaced, or cannot be written.

    inputs : files from which it was drawn
    """
    exists = check_output(output, overwrite, inputs)
    with matplotlib.rc_context(STYLE):  # some settings are looked up only when the picture is written
        picture = _encoded(fig, output.suffix.lower())
    return write(picture, output, exists)


def _encoded(fig: Figure, suffix: str) -> bytes:
    if isinstance(fig, Film) and suffix in FILMS:
        return fig.encoded(suffix)
    picture = io.BytesIO()
    try:
        with _quiet_logger("matplotlib.backends.backend_ps"):  # it says that EPS has no transparency
            fig.savefig(picture, format=suffix[1:], dpi=fig.dpi)
    except RuntimeError as error:
        if not matplotlib.rcParams["text.usetex"]:
            raise
        raise PlotError(f"matplotlib is set up to write with LaTeX (text.usetex), which fails: {error}") from None
    return picture.getvalue()


@contextlib.contextmanager
def _quiet_logger(name: str) -> Iterator[None]:
    logger = logging.getLogger(name)
    before = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(before)
