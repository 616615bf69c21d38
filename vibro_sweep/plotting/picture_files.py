"""Pictures as files: each carries a seal, a checksum of itself, by which an unchanged one is recognised.

Such a picture is drawn anew without a question. Everything else that exists is replaced only when asked for.
"""

import contextlib
import hashlib
import os
import re
import secrets
import zlib
from collections.abc import Collection
from pathlib import Path

from vibro_sweep.checks.errors import VibroSweepError
from vibro_sweep.files import disk

SUFFIXES = (".png", ".jpg", ".svg", ".pdf", ".eps")  # those of films: FILMS
FILMS = (".gif", ".mp4")
MOST = 2**28  # bytes of a picture that is looked at

_DIGEST = re.compile(rb"sha256:([0-9a-f]{64})")
_END = 12  # bytes of the last chunk of a PNG file, which the seal comes before
_BEGIN = 4  # bytes of a JPEG file before the length of its first segment, which the seal comes behind


class PlotError(VibroSweepError, ValueError):
    """A picture cannot be drawn; the message says what can.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> data = vs.sweep(system, {"b": [6.4, 6.5]}, transient=100, record=50, observe=["lyapunov"])
    >>> try:
    ...     vs.plot(data, "history")
    ... except vs.PlotError as error:
    ...     print(error)
    kind 'history': this dataset can show lyapunov (or all); history needs a trajectory
    """


def default_name(path: Path) -> str:
    """The default name of the picture of a file, FILE.png."""
    return path.name.removesuffix(".part").removesuffix(".h5") + ".png"


def check_output(output: Path, overwrite: bool, inputs: Collection[Path]) -> bool:
    """Whether something stands there, which may be replaced. Raises PlotError where that may not be.

    inputs : files from which it is drawn; none of them is replaced, by whatever name or link
    """
    for source in inputs:
        if disk.same_file(output, source):
            raise PlotError(f"output {output}: that is {source}, which is read for it; name another file")
    if why := disk.obstacle(output):
        raise PlotError(f"output {output} {why}")
    exists = os.path.lexists(output)
    if exists and not overwrite and not unchanged(output):
        raise PlotError(f"output {output} exists, and is not a picture that vibro-sweep drew; --overwrite replaces it")
    return exists


def write(picture: bytes, output: Path, replaces: bool) -> Path:
    """Write a picture where `check_output` has said that there is one to be replaced, or none. Raises PlotError."""
    suffix = output.suffix.lower()
    new = output.with_name(f".vibro_sweep-{secrets.token_hex(16)}{suffix}")
    try:
        with open(new, "xb") as file:
            file.write(_sealed(picture, suffix))
        disk.publish(new, output, replaces)
    except FileExistsError:
        raise PlotError(f"output {output}: it has just appeared; --overwrite replaces it") from None
    except OSError as error:
        raise PlotError(f"output {output}: cannot be written ({error.strerror or error})") from error
    finally:
        with contextlib.suppress(OSError):
            new.unlink()
    return output


def unchanged(path: Path) -> bool:
    """Whether this is a picture by `write`, byte for byte."""
    with disk.open_raw(path) as file:
        content = file.read(MOST)
    suffix = path.suffix.lower()
    for digest in _DIGEST.findall(content)[-1:]:
        before, seal, after = content.partition(_seal(digest, suffix))
        return bool(seal) and _sealed(before + after, suffix) == content
    return False


def _sealed(picture: bytes, suffix: str) -> bytes:
    """A picture with its seal, which is a comment in its format."""
    end = len(picture) - _END if suffix == ".png" else len(picture)
    if suffix == ".jpg":
        end = _BEGIN + int.from_bytes(picture[_BEGIN : _BEGIN + 2])
    seal = _seal(hashlib.sha256(picture).hexdigest().encode(), suffix)
    return picture[:end] + seal + picture[end:]


def _seal(digest: bytes, suffix: str) -> bytes:
    if suffix == ".png":
        chunk = b"tEXtvibro_sweep\0sha256:" + digest
        return (len(chunk) - 4).to_bytes(4) + chunk + zlib.crc32(chunk).to_bytes(4)
    if suffix == ".jpg":  # a segment with a comment
        text = b"vibro_sweep sha256:" + digest
        return b"\xff\xfe" + (len(text) + 2).to_bytes(2) + text
    if suffix == ".mp4":  # a box that players skip
        box = b"free vibro_sweep sha256:" + digest
        return (len(box) + 4).to_bytes(4) + box
    first, last = (b"<!--", b"-->") if suffix == ".svg" else (b"%", b"")
    return first + b" vibro_sweep sha256:" + digest + b" " + last + b"\n"
