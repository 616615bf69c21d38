"""A view to keep: as a program in Python, a picture, a file of its data. As a scene it is `scene.to_yaml()`."""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.driver.sweep import run_sweep
from vibro_sweep.plotting import figure
from vibro_sweep.plotting.pictures import save
from vibro_sweep.results.layout import size
from vibro_sweep.scene import Scene

LARGEST = 64 * 10**6  # bytes of a file that goes to the page


def python_of(scene: Scene) -> str:
    """A program that computes and draws the same sweep."""
    if scene.dynamics == "map":
        return _program_of_mapping(scene)
    data = scene.data()
    numbers = dict(data["system"])
    kind = numbers.pop("type", None)
    made = f"vs.Oscillator.named({kind!r}, " if kind else "vs.System("
    ((name, axis),) = data["sweep"].items()
    numbers[name] = scene.system.numbers[name]
    system = made + ", ".join(f"{key}={value!r}" for key, value in numbers.items()) + ")"
    lines = [
        "import vibro_sweep as vs",
        "",
        f"system = {system}",
        "data = vs.sweep(",
        "    system,",
        f"    {{{name!r}: {axis!r}}},",
        *(f"    {key}={value!r}," for key, value in _options(data).items()),
        ")",
        'vs.plot(data).savefig("explored.png")',
    ]
    return "\n".join(lines) + "\n"


def _program_of_mapping(scene: Scene) -> str:
    """The same of a discontinuity mapping, which is swept by its scene."""
    lines = [
        "from pathlib import Path",
        "",
        "import vibro_sweep as vs",
        "",
        f'Path("explored.yaml").write_text("""{scene.to_yaml()}""")',
        'vs.run(vs.load_scene("explored.yaml"), "explored.h5")',
        'data = vs.open("explored.h5")',
        'vs.plot(data).savefig("explored.png")',
    ]
    return "\n".join(lines) + "\n"


def _options(data: dict[str, Any]) -> dict[str, Any]:
    """The arguments of `vibro_sweep.sweep` beside system and axis."""
    more = {key: data[key] for key in ("start", "section") if key in data}
    return {"observe": data["observe"], **data["orbit"], **more}


def hdf5_of(scene: Scene) -> bytes:
    """The file of the sweep. Raises ArgumentError where it is too large for a page."""
    with _computed(scene) as path:
        return path.read_bytes()


def svg_of(scene: Scene) -> bytes:
    """The picture of the sweep, as `vibro-sweep plot` draws it. Raises ArgumentError as `hdf5_of`."""
    with _computed(scene) as path:
        picture = path.with_suffix(".svg")
        save(figure(path), picture, overwrite=False, inputs=())
        return picture.read_bytes()


@contextmanager
def _computed(scene: Scene) -> Iterator[Path]:
    if size(scene) > LARGEST:
        raise ArgumentError(f"the file would have {size(scene) / 1e6:.0f} MB; save the scene, and run it")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "explored.h5")
        run_sweep(scene, path, workers=1, progress=lambda done, total: None)
        yield path
