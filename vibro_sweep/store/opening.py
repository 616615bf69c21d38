"""Opening a file: is it one of ours, whole, and the scene's?"""

import difflib
import json
from pathlib import Path

import h5py

from vibro_sweep import __version__, journal
from vibro_sweep.kernels.jit import source_hash
from vibro_sweep.scene import Scene


class StoreError(ValueError):
    """A file that is in the way, is none of ours, is damaged or does not fit the scene; or a disk that fails."""


def opened(path: Path) -> h5py.File:
    """A file for reading, put right first if its run was killed. Raises StoreError."""
    journal.recover(path)
    return checked(path, path)


def checked(file: Path | journal.Journal, path: Path) -> h5py.File:
    """A file, or what a journal makes of it for writing, if it is one of ours. Raises StoreError."""
    try:
        result = h5py.File(file, "r" if file is path else "r+")
    except FileNotFoundError:
        raise StoreError(f"{path}: there is no such file") from None
    except OSError as error:
        raise StoreError(f"{path} is not an HDF5 file, or it is damaged ({error})") from None
    try:
        headers = {name: dict(result[name].attrs) for name in result}  # each has a checksum of its own
        if "status" in headers and "scene" in result.attrs:
            json.loads(result.attrs["provenance"])
            return result
        problem = "is an HDF5 file, but none that vibro-sweep wrote"
    except (OSError, RuntimeError, ValueError, KeyError) as error:
        problem = f"is damaged ({error})"
    result.close()
    raise StoreError(f"{path} {problem}")


def check_scene(file: h5py.File, path: Path, scene: Scene) -> None:
    """A run is continued by the scene that began it, or its points would not belong together."""
    if file.attrs["scene"] != scene.text:
        raise StoreError(
            f"{path} was made from another scene; name another file, or overwrite it\n"
            f"(- is that scene, + is this one)\n{_differences(file.attrs['scene'], scene.text)}"
        )


def check_kernels(file: h5py.File, path: Path) -> None:
    """And by the kernels that began it."""
    old = json.loads(file.attrs["provenance"])
    if old["kernels"] != source_hash():
        raise StoreError(
            f"{path} was begun by vibro_sweep {old['vibro_sweep']} with the kernels {old['kernels']}, and this is "
            f"vibro_sweep {__version__} with other kernels, {source_hash()}; overwrite it"
        )


def _differences(old: str, new: str, most: int = 8) -> str:
    lines = difflib.ndiff(old.splitlines(), new.splitlines())
    changed = [f"  {line}" for line in lines if line[0] in "+-"]
    return "\n".join(changed[:most] + (["  ..."] if len(changed) > most else []))


def made_by() -> dict:
    """What must be the same for a run to be continued."""
    return {"vibro_sweep": __version__, "kernels": source_hash()}
