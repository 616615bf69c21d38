"""What a run makes, and whether a file, or an interrupted run, is of the same: its points would not belong together
else."""

import contextlib
import datetime
import json
import os
import shutil
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from vibro_sweep import __version__
from vibro_sweep.checks.refusals import cut, not_allowed
from vibro_sweep.files.disk import obstacle, same_file
from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.files.hdf5 import FORMAT
from vibro_sweep.scene import SceneError, parse_continuation, parse_scene
from vibro_sweep.scene.differences import differences
from vibro_sweep.tables.file_columns import BRANCHES, CHART

MODES = ("new", "resume", "overwrite")
NO_DATA = (".png", ".svg", ".pdf", ".yaml", ".yml")  # endings of other files of this program


class Complete(NamedTuple):
    """A file to which nothing is to be added: how many orbits have which status, and how long its run took."""

    statuses: dict[int, int]
    seconds: float


def check_mode(mode: object) -> None:
    """Raise StoreError for a word that is not one of `MODES`."""
    if not (isinstance(mode, str) and mode in MODES):
        raise StoreError(not_allowed("mode", mode, f"one of {', '.join(map(repr, MODES))}"))


def pieces_of(path: Path) -> Path:
    """The folder in which a run of branches, curves or windows keeps what it has computed."""
    return Path(f"{path}.pieces")


def check_outputs(path: Path, mode: str, inputs: Collection[Path]) -> None:
    """Raise StoreError where a run must not write, before anything is touched.

    inputs : files that the run reads; none of them is written, by whatever name or link
    """
    check_mode(mode)
    if path.suffix.lower() in NO_DATA:
        raise StoreError(f"`output` {path}: the name of a data file must not end in {path.suffix}")
    for source in inputs:
        if same_file(path, source):
            raise StoreError(f"`output` {path}: this run reads {source}; name another file")
    for place in (path, Path(f"{path}.new"), Path(f"{path}.lock")):
        if why := obstacle(place):
            raise StoreError(f"{place} {why}")
    folder = pieces_of(path)
    if os.path.lexists(folder) and (folder.is_symlink() or not (folder / "run.json").is_file()):
        raise StoreError(f"{folder} is in the way: it is not an interrupted run of vibro-sweep; move it away")
    if not path.parent.is_dir():
        raise StoreError(f"`output` {path}: there is no folder {path.parent}")


def about_run(attributes: Mapping[str, Any], made_by: Mapping[str, Any], run_id: str) -> dict[str, Any]:
    """The attributes of a file: its subject's, and those of the run that begins now."""
    begun = {"format": FORMAT, "identity": run_id, "Conventions": "CF-1.11"}
    history = {"history": f"{now()} begun by vibro_sweep {__version__}", "provenance": json.dumps(made_by)}
    return begun | history | dict(attributes)


def now() -> str:
    """The time as the history of a file has it."""
    return datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")


def check_same(old: Mapping[str, Any], new: Mapping[str, Any], path: Path) -> None:
    """Raise StoreError where a file, by its attributes, is of another subject than a run."""
    remedy = "name another file, or overwrite it"
    kind, scene = str(old["kind"]), str(old["scene"])
    if kind != new["kind"]:
        raise StoreError(f"{path} holds {cut(kind)}, and no {new['kind']}; {remedy}")
    if not _same_scene(kind, scene, new["scene"]):
        raise StoreError(
            f"{path} was made from another scene; {remedy}\n"
            f"(- is that scene, + is this one)\n{differences(scene, new['scene'])}"
        )
    texts = {name: value for name, value in new.items() if isinstance(value, str)}
    if any(str(old.get(name)) != value for name, value in texts.items() if name not in ("scene", "title")):
        raise StoreError(f"{path} was made from something else; {remedy}")


def _same_scene(kind: str, text: str, other_text: str) -> bool:
    """Whether two scenes say the same, whatever comments they have."""
    parse = parse_continuation if kind in (BRANCHES, CHART) else parse_scene
    try:
        return text == other_text or parse(text).to_yaml() == parse(other_text).to_yaml()
    except SceneError:  # of what a function made there is no scene to parse
        return False


def check_version(old: Mapping[str, Any], made_by: Mapping[str, Any], path: Path) -> None:
    """Raise StoreError where the code that began a file is not that of `made_by`."""
    begun_by, code = json.loads(str(old["provenance"])), made_by["code"]
    if begun_by.get("code") != code:
        raise StoreError(
            f"{path} was begun by vibro_sweep {cut(str(begun_by.get('vibro_sweep')))}, code "
            f"{cut(str(begun_by.get('code')))}, and this is vibro_sweep {__version__} with other code, {code}, another "
            "numpy or numba, or a processor that rounds otherwise (README, Tested); overwrite it"
        )


def touch(path: Path) -> None:
    """A file that fits its scene is as new: `make` compares times."""
    with contextlib.suppress(OSError):  # of somebody else's
        os.utime(path)


def check_space(size: int, path: Path) -> None:
    """A run that will not fit is not begun; other programs may still fill the disk later on."""
    free = shutil.disk_usage(path.parent).free
    if size > free:
        unit, name = (1e6, "MB") if size > 1e6 else (1e3, "kB")
        enough = f"{size / unit:,.0f} {name}, and only {free / unit:,.0f} {name}"
        raise StoreError(f"{path} needs {enough} are free in {path.parent}")
