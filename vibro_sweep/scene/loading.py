"""`load_scene`: from a YAML file to a scene of either kind."""

from dataclasses import replace
from pathlib import Path

from vibro_sweep.checks.arguments import names_its_arguments

from .continuation import Continuation, is_continuation, parse_continuation
from .scene import Scene, parse_scene
from .yaml_reading import text_of
from .yaml_text import YAMLTextError, read_yaml


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
    text, name = text_of(path)
    try:
        follows = is_continuation(read_yaml(text))
    except YAMLTextError:  # what is wrong is said below, with its line
        follows = False
    scene = parse_continuation(text, name) if follows else parse_scene(text, name)
    return replace(scene, source=Path(path).absolute())
