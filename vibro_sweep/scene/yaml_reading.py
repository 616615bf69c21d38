"""The text of a scene, from a file."""

import os
from pathlib import Path

from vibro_sweep.checks.file_names import checked_path, read_bytes

from .problems import SceneError
from .yaml_text import MAX_BYTES

HDF5 = b"\x89HDF\r\n\x1a\n"  # how such files begin


def text_of(path: str | Path) -> tuple[str, str]:
    """The text of a YAML file, and its name. Raises SceneError for what is not a text, and as `read_bytes` does."""
    path = checked_path("path", path)
    name = os.fsencode(path.name).decode(errors="replace")  # the name of a file need not be text
    data = read_bytes(path, MAX_BYTES + 1, pipes=True)
    if data.startswith(HDF5):
        raise SceneError(name, ["is a data file, not a scene: `vibro-sweep info` and `plot` read it"])
    if len(data) > MAX_BYTES:
        raise SceneError(name, [f"longer than {MAX_BYTES} bytes"])
    try:
        return data.decode("utf-8-sig"), name
    except UnicodeDecodeError as error:
        raise SceneError(name, [f"byte {error.start} is not UTF-8 text"]) from None
