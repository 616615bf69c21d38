"""`load_scene`: from a YAML file to a scene of either kind."""

import os
from pathlib import Path

from vibro_sweep.checks.arguments import names_its_arguments
from vibro_sweep.checks.file_names import checked_path, read_bytes

from .continuation import Continuation, is_continuation, parse_continuation
from .problems import SceneError
from .scene import Scene, parse_scene
from .yaml_text import MAX_BYTES, YAMLTextError, read_yaml

HDF5 = b"\x89HDF\r\n\x1a\n"  # how such files begin


@names_its_arguments
def load_scene(path: str | Path) -> Scene | Continuation:
    """Read a scene from a YAML file: a `Scene` of orbits, or with `continue` a `Continuation`, of branches or curves.

    Raises SceneError for what is wrong with it, and an OSError that is a ValueError too where the file cannot be read;
    of a missing file it is a FileNotFoundError.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> text = "{system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8}, "
    >>> text += "sweep: {b: {start: 6.4, stop: 6.6, num: 3}}, orbit: {transient: 100, record: 50}}"
    >>> with open("three.yaml", "w") as file:
    ...     _ = file.write(text)
    >>> scene = vs.load_scene("three.yaml")
    >>> scene.sweep["b"].tolist(), scene.n_points
    ([6.4, 6.5, 6.6], 3)
    """
    path = checked_path("path", path)
    name = os.fsencode(path.name).decode(errors="replace")  # the name of a file need not be text
    text = _text_of(path, name)
    try:
        follows = is_continuation(read_yaml(text))
    except YAMLTextError:  # what is wrong is said below, with its line
        follows = False
    return (parse_continuation if follows else parse_scene)(text, name, path.absolute())


def _text_of(path: Path, name: str) -> str:
    data = read_bytes(path, MAX_BYTES + 1, pipes=True)
    if data.startswith(HDF5):
        raise SceneError(name, ["is a data file, not a scene: `vibro-sweep info` and `plot` read it"])
    if len(data) > MAX_BYTES:
        raise SceneError(name, [f"longer than {MAX_BYTES} bytes"])
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SceneError(name, [f"byte {error.start} is not UTF-8 text"]) from None
