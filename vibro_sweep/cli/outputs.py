"""Whether the results of a run can be written in the end, asked before anything is computed."""

import tempfile
from collections.abc import Collection
from pathlib import Path

from .console import InputError, input_errors


def check_output(output: Path, inputs: Collection[Path], picture: Path | None, mode: str) -> None:
    """Raise InputError or StoreError, before anything is computed, where results could not be written in the end."""
    from vibro_sweep.checks.file_names import file_to_write
    from vibro_sweep.files.file_errors import StoreError
    from vibro_sweep.files.subject import check_outputs

    try:
        file_to_write("--output", str(output))
    except ValueError as error:
        raise InputError(str(error)) from None
    try:
        check_outputs(output, mode, inputs)
    except StoreError as error:
        from vibro_sweep.plotting.picture_files import SUFFIXES

        if output.suffix.lower() in SUFFIXES:
            raise InputError(f"{error}; --plot draws a picture beside it") from None
        raise
    if picture:
        from vibro_sweep.plotting import picture_files

        with input_errors(picture_files.PlotError):
            picture_files.check_output(picture, mode == "overwrite", inputs)
    try:
        with tempfile.TemporaryFile(dir=output.parent):
            pass
    except OSError as error:
        raise InputError(f"--output {output}: cannot write into {output.parent}: {error.strerror}") from None
