"""Whether the results of a run can be written in the end, asked before anything is computed."""

import tempfile
from pathlib import Path

from .console import InputError, input_errors

NO_DATA = (".png", ".svg", ".pdf", ".yaml", ".yml")


def check_output(output: Path, scene_file: Path, picture: Path | None, mode: str):
    """Raise InputError or StoreError, before anything is computed, where results could not be written in the end."""
    from .store.beginning import check_places

    part = Path(f"{output}.part")
    if output.suffix.lower() in NO_DATA and output != scene_file:
        also = "; --plot draws a picture beside it" if output.suffix.lower() not in (".yaml", ".yml") else ""
        raise InputError(
            f"--output {output}: is the name of the data file, which must not end in {output.suffix}{also}"
        )
    for place, what in ((output, ""), (part, f"{part}, where the run is kept until it is complete, ")):
        if place.exists() and place.samefile(scene_file):
            raise InputError(f"--output {output}: {what}is the scene itself")
    check_places(output, mode)
    if not output.parent.is_dir():
        raise InputError(f"--output {output}: there is no folder {output.parent}")
    if picture:
        from .plotting import PlotError
        from .plotting import check_output as check_picture

        with input_errors(PlotError):
            check_picture(picture, mode == "overwrite")
    try:
        with tempfile.TemporaryFile(dir=output.parent):
            pass
    except OSError as error:
        raise InputError(f"--output {output}: cannot write into {output.parent}: {error.strerror}") from None
