"""Make docs/quickstart.png and docs/film.gif: python docs/pictures.py

docs/oscillator.svg is written by hand, docs/live_pictures.py makes those of the live page; the build of the site
makes all others.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import vibro_sweep as vs

DOCS = Path(__file__).resolve().parent
SCENE = DOCS.parent / "configs" / "quickstart.yaml"


def quickstart(picture: Path) -> None:
    """Compute the quickstart and draw it."""
    with tempfile.TemporaryDirectory() as folder:
        program = [sys.executable, "-m", "vibro_sweep"]
        subprocess.run([*program, "run", SCENE], cwd=folder, check=True)
        subprocess.run([*program, "plot", "quickstart.h5", "-o", picture, "--overwrite"], cwd=folder, check=True)


def film(picture: Path) -> None:
    """The motion of period 8 at b = 5.5, as a film."""
    system = vs.load_scene(SCENE).system.replace(b=5.5)
    trajectory = {"periods": 8, "samples": 1600}
    data = vs.sweep(system, {"b": [5.5]}, observe=["section"], transient=1000, record=50, trajectory=trajectory)
    vs.plot(data, "film", output=picture, overwrite=True)


if __name__ == "__main__":
    quickstart(DOCS / "quickstart.png")
    film(DOCS / "film.gif")
