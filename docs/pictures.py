"""Make every picture that the documentation shows: python docs/pictures.py [NAME ...] [--folder FOLDER]

Without names all of them, in some ten minutes on two cores. Result files stay in FOLDER (by default a temporary one);
those that are there already are not computed again. Pictures of benchmarks/report.md are made by benchmarks/report.py.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

DOCS = Path(__file__).resolve().parent
ROOT = DOCS.parent

# Result file -> the words of the command that makes it, and the files that it needs.
FILES = {
    "quickstart.h5": ("run configs/quickstart.yaml", ()),
    "quickstart.windows.h5": ("windows quickstart.h5", ("quickstart.h5",)),
    "coexistence.h5": ("run configs/coexistence.yaml", ()),
    "basins.h5": ("run configs/basins.yaml", ()),
    "figure_06.h5": ("run configs/paper/figure_06.yaml", ()),
    "symmetric.h5": ("run configs/branches/symmetric.yaml", ()),
    "curves.h5": ("run configs/branches/curves.yaml", ()),
    "largest_windows.h5": ("run configs/branches/largest_windows.yaml", ("quickstart.h5",)),
    "plane_clearance_frequency.h5": ("run configs/plane_clearance_frequency.yaml", ()),
    "edges.h5": ("run configs/branches/plane_clearance_frequency.yaml", ("plane_clearance_frequency.h5",)),
}

# Picture -> the words of the command `plot`; files that are named in them are made before.
PLOTS = {
    "quickstart.png": "quickstart.h5",
    "windows.png": "quickstart.h5 --windows quickstart.windows.h5",
    "coexistence.png": "coexistence.h5",
    "basins.png": "basins.h5",
    "figure_06.png": "figure_06.h5",
    "branches.png": "symmetric.h5 --over quickstart.h5",
    "curves_relative.png": "curves.h5 --relative",
    "curves_largest.png": "largest_windows.h5",
    "plane_curves.png": "edges.h5 --over plane_clearance_frequency.h5",
}

# Picture -> the script that draws it, with its arguments.
SCRIPTS = {
    "curves.png": ("docs/curves.py",),
    "oscillator.svg": ("docs/oscillator.py",),
    "map_accuracy.png": ("benchmarks/map_accuracy.py", "--output", "docs/map_accuracy.png"),
}

# Picture -> the page whose first block of Python draws it, and what that calls it.
PAGES = {"physical_units.png": ("physical_units.md", "diagram.png")}

PICTURES = (*PLOTS, *SCRIPTS, *PAGES)


def make(name: str, folder: Path) -> None:
    """Draw a picture of this name into docs/."""
    if name in PLOTS:
        words = PLOTS[name].split()
        for word in words:
            if word in FILES:
                compute(word, folder)
        command("plot", *words, "-o", str(DOCS / name), "--overwrite", folder=folder)
    elif name in SCRIPTS:
        subprocess.run([sys.executable, *SCRIPTS[name]], cwd=ROOT, check=True)
    else:
        page, drawn = PAGES[name]
        code = re.search(r"```python\n(.*?)```", (DOCS / page).read_text(), re.DOTALL).group(1)
        subprocess.run([sys.executable, "-c", code], cwd=folder, check=True)
        (DOCS / name).write_bytes((folder / drawn).read_bytes())


def compute(file: str, folder: Path) -> None:
    """Make a result file, and before it those that it needs, where they are missing."""
    (verb, what), needs = FILES[file][0].split(), FILES[file][1]
    for need in needs:
        compute(need, folder)
    if not (folder / file).exists():
        command(verb, str(ROOT / what) if verb == "run" else what, "-o", file, folder=folder)


def command(*words: str, folder: Path) -> None:
    """vibro-sweep with these words; 1, a remark on some points, is not a failure."""
    done = subprocess.run([sys.executable, "-m", "vibro_sweep", *words], cwd=folder, check=False)
    if done.returncode not in (0, 1):
        sys.exit(done.returncode)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(PICTURES)}; by default all")
    parser.add_argument("--folder", type=Path, help="folder of the result files; by default a temporary one")
    options = parser.parse_args()
    if unknown := set(options.names) - set(PICTURES):
        parser.error(f"{', '.join(sorted(unknown))} is not allowed; there are {', '.join(PICTURES)}")
    with tempfile.TemporaryDirectory() as temporary:
        folder = (options.folder or Path(temporary)).resolve()
        os.makedirs(folder, exist_ok=True)
        for name in options.names or PICTURES:
            print(f"docs/{name}", flush=True)
            make(name, folder)


if __name__ == "__main__":
    main()
