"""Example scenes, which come with the package, and copies of them to start from."""

import difflib
import json
import re
from pathlib import Path

from vibro_sweep.checks.errors import VibroSweepError

SCHEMA = "scene.schema.json"
HOME = Path(__file__).parents[1]


class ExampleError(VibroSweepError, ValueError):
    """An example that there is not, or whose copy would replace a file with another content."""


def examples() -> dict[str, Path]:
    """Scenes by name."""
    folder = HOME / "configs"
    folder = folder if folder.is_dir() else HOME.parent / "configs"  # not installed, or installed to be edited
    return {path.stem: path for path in sorted(folder.glob("**/*.yaml"))}


def purpose(scene: Path) -> str:
    """The first sentence of a scene's comments."""
    comments, _, _ = scene.read_text(encoding="utf-8").partition("\n\n")
    paragraph = comments.split("\n#\n")[1]  # behind the line that names the schema
    text = " ".join(line.strip("# ") for line in paragraph.splitlines())
    return re.split(r"(?<=[.?]) (?=[A-Z\d])", text)[0].strip()


def write_example(name: str) -> list[Path]:
    """Copy a scene into the current folder, with that whose system it has, and the schema, if there are none.

    Returns the paths that are written. Raises ExampleError.
    """
    known = examples()
    name = name.removesuffix(".yaml")
    if name not in known:
        close = difflib.get_close_matches(name, known, n=1)
        hint = f"did you mean {close[0]}? " if close else ""
        raise ExampleError(f"NAME {name!r}: there is no such example; {hint}there are {', '.join(known)}")
    scene = Path(f"{name}.yaml")
    text = known[name].read_text(encoding="utf-8")
    text = re.sub(r"configs/(\w+/)?", "", text).replace("../", "./")  # the files are in this folder now
    try:
        with open(scene, "x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        if scene.is_file() and scene.read_text(encoding="utf-8", errors="replace") == text:
            return [scene]  # it is that copy
        raise ExampleError(f"{scene} exists; move it away, or work in another folder") from None
    others = [name for name in re.findall(r"^system: (\w+)\.yaml$", text, re.M) if not Path(f"{name}.yaml").exists()]
    written = [scene, *(path for name in others for path in write_example(name))]
    schema = Path(SCHEMA)
    if schema.exists():
        return written
    schema.write_text(schema_text() + "\n", encoding="utf-8")
    return [*written, schema]


def schema_text() -> str:
    """The JSON Schema of a scene."""
    from vibro_sweep.scene import json_schema

    return json.dumps(json_schema(), indent=2)
