"""Beginning to write a file: anew, where a run was interrupted, or to mend what is damaged; one run at a time.

All questions to whom a file or a part belongs are asked here, for files of every kind.
"""

import contextlib
import json
import shutil
from collections.abc import Collection, Iterator
from pathlib import Path

import h5py

from vibro_sweep.model.refusals import cut, not_allowed
from vibro_sweep.scene.differences import differences
from vibro_sweep.store import appending, checks, names, parts
from vibro_sweep.store.appending import LockedPart
from vibro_sweep.store.attributes import is_flat, quantities_of, text
from vibro_sweep.store.creating import Run, skeleton_of
from vibro_sweep.store.image import Index, frame_of
from vibro_sweep.store.names import Stamp
from vibro_sweep.store.opening import StoreError, check_version, opened, skeleton
from vibro_sweep.store.parts import PartError
from vibro_sweep.store.ragged_checks import damage_of
from vibro_sweep.store.writing import Complete, Writer, unfinished
from vibro_sweep.tables.outcomes import NOT_COMPUTED

MODES = ("new", "resume", "overwrite")
NO_DATA = (".png", ".svg", ".pdf", ".yaml", ".yml")  # endings of other files of this program


@contextlib.contextmanager
def writer(run: Run, path: Path, mode: str) -> Iterator[Writer | Complete]:
    """The `Writer` of a run; `Complete` where the file is there, and whole. Raises StoreError.

    mode : "new", "resume" or "overwrite"
    """
    part = check_outputs(path, mode, run.inputs)
    with contextlib.ExitStack() as stack:
        try:
            made = mode != "overwrite" and names.stamp(path) and not names.stamp(part)
            result = _complete(run, path, mode) if made else None
            if result is None:
                locked = appending.lock(part) if names.stamp(part) else appending.make(part)
                stack.enter_context(contextlib.closing(locked))
                if mode == "resume" and parts.is_begun(locked.file):
                    result = _continue(run, locked, path)
                else:
                    _begin(run, locked, path, names.stamp(path) if made or mode == "overwrite" else None)
            result = result or _writer(locked, path, bool(made))
        except BlockingIOError:
            raise StoreError(f"{part} is being written by another run") from None
        except FileExistsError:
            raise StoreError(f"{part} has just been begun by another run") from None
        except PartError as error:
            raise StoreError(f"{part} {error}") from None
        yield result


def _writer(locked: LockedPart, path: Path, mends: bool) -> Writer:
    """The writer that goes on behind what is in a part.

    mends : whether what is whole of the file that stands at the path is taken over
    """
    head = parts.read_head(locked.file)
    with skeleton(locked.file, locked.path) as file:
        frame = frame_of(file)
    index = Index(locked.file, head, frame)
    locked.go_on(head, index.end)
    result = Writer(locked, path, frame, index)
    if index.damaged:
        result.remark(checks.blocks_lost(index.damaged))
    if mends and frame.datasets:
        with opened(path) as (file, _):
            result.take_over(file, checks.damaged(file))
    return result


def check_outputs(path: Path, mode: str, inputs: Collection[Path]) -> Path:
    """Raise StoreError where a run must not write, before anything is touched. Returns the name of the part.

    inputs : files that the run reads; none of them is written, by whatever name or link
    """
    check_mode(mode)
    if path.suffix.lower() in NO_DATA:
        raise StoreError(f"`output` {path}: the name of a data file must not end in {path.suffix}")
    part = part_of(path)
    for place in (path, part):
        for source in inputs:
            if names.same_file(place, source):
                also = "" if place == path else f" (the run is kept in {part} until it is complete)"
                raise StoreError(f"`output` {path}: this run reads {source}{also}; name another file")
        if why := names.obstacle(place):
            raise StoreError(f"{place} {why}")
    if not path.parent.is_dir():
        raise StoreError(f"`output` {path}: there is no folder {path.parent}")
    if names.stamp(part):
        try:
            _check_part(part, path, mode)
        except PartError as error:
            raise StoreError(f"{part} {error}") from None
    if mode == "new" and names.stamp(part):
        if appending.is_locked(part):
            raise StoreError(f"{part} is being written by another run")
        raise StoreError(f"{part} is an interrupted run; `resume` continues it, `overwrite` replaces it")
    return part


def part_of(path: Path) -> Path:
    """The path at which a run is kept until it is complete."""
    return Path(f"{path}.part")


def check_mode(mode: object) -> None:
    """Raise StoreError for a word that is not one of `MODES`."""
    if not (isinstance(mode, str) and mode in MODES):
        raise StoreError(not_allowed("mode", mode, f"one of {', '.join(map(repr, MODES))}"))


def _check_part(part: Path, path: Path, mode: str) -> None:
    """Raise StoreError for one that cannot be continued, and for what no run has made: nobody asked to replace that."""
    with parts.open_regular(part) as raw:
        if parts.is_part(raw) or parts.size(raw) == 0:  # killed before it has written anything
            if mode == "resume" and names.stamp(path) and not parts.is_begun(raw):
                raise StoreError(f"{part} holds nothing yet, and {path} exists; `overwrite` replaces both")
            return
    raise StoreError(f"{part} is in the way: it is not an interrupted run of vibro-sweep; move it away")


def _check(run: Run, file: h5py.File, path: Path) -> None:
    """Raise StoreError where a file, or a part, is of another subject: its points would not belong together."""
    kind, old = text(file, "kind"), text(file, "scene")
    remedy = "name another file, or overwrite it"
    if kind != run.subject.kind:
        raise StoreError(f"{path} holds {cut(kind)}, and no {run.subject.kind}; {remedy}")
    if old != run.subject.scene:
        raise StoreError(
            f"{path} was made from another scene; {remedy}\n"
            f"(- is that scene, + is this one)\n{differences(old, run.subject.scene)}"
        )
    texts = {name: value for name, value in run.subject.attributes.items() if isinstance(value, str)}
    if any(name not in file.attrs or text(file, name) != value for name, value in texts.items()):
        raise StoreError(f"{path} was made from something else; {remedy}")
    if absent := [name for name in run.quantities if name not in quantities_of(file)]:
        raise StoreError(f"{path} is damaged: it has no {', '.join(absent)}; overwrite it")


def _lacking(file: h5py.File, path: Path) -> str:
    """What `resume` computes again of a file, in words; empty where nothing is."""
    if is_flat(file):
        damage = damage_of(file)
        return f"is damaged: {damage}" if damage else ""
    found = checks.damaged(file)
    if not all(piece for _, piece in found):
        raise StoreError(f"{path} is damaged beyond repair: {checks.summary(found)}; overwrite it")
    if found:
        return f"is damaged: {checks.summary(found)}"
    return "has points that are not computed" if NOT_COMPUTED in checks.statuses(file) else ""


def _complete(run: Run, path: Path, mode: str) -> Complete | None:
    """A file that needs no run; None for one that `resume` mends. Raises StoreError for any other."""
    try:
        with opened(path, content=False) as (file, _):
            _check(run, file, path)
            lacking = _lacking(file, path)
            if mode == "new" or lacking:
                check_version(file, path, run.made_by)
            if not lacking:
                return _read(file)
            if mode == "new":
                raise StoreError(f"{path} {lacking}; `resume` computes that again")
    except StoreError as error:
        if mode == "resume":
            raise
        told = f"{path} exists, and holds something else than this run makes"
        raise StoreError(f"{told}; `overwrite` replaces it, or name another file\n{error}") from None
    except (OSError, RuntimeError, ValueError, KeyError, TypeError) as error:
        raise StoreError(f"{path} is damaged ({error})") from None
    return None


def _read(file: h5py.File) -> Complete:
    return Complete(checks.statuses(file), json.loads(text(file, "provenance")).get("wall_time_s", 0.0))


def _begin(run: Run, locked: LockedPart, path: Path, replaces: Stamp | None) -> None:
    """Begin the part with nothing computed yet, in place of what is in it."""
    with contextlib.suppress(PartError):  # overwritten
        unfinished(path, parts.read_head(locked.file).run_id).unlink(missing_ok=True)
    try:
        _check_space(run.size, locked)
        run_id = parts.new_run_id()
        content = skeleton_of(run, run_id)
        locked.begin(parts.new_head(content, replaces, run_id), content)
    except BaseException:
        if parts.size(locked.file) == 0:
            locked.remove()
        raise


def _continue(run: Run, locked: LockedPart, path: Path) -> Complete | None:
    """Check that the part is of this run; `Complete` where it became the file before its run was killed."""
    head = parts.read_head(locked.file)
    with skeleton(locked.file, locked.path) as file:
        _check(run, file, locked.path)
        check_version(file, locked.path, run.made_by)
    if finished := _published(path, locked, head.run_id):
        return finished
    if (found := names.stamp(path)) and found != head.replaces:
        raise StoreError(
            f"{path} stands beside the interrupted run {locked.path}, which is not to replace it; move one of them "
            "away, or `overwrite` both"
        )
    return None


def _published(path: Path, locked: LockedPart, run_id: bytes) -> Complete | None:
    """The file, if it is what was made of this part before its run was killed; the part then goes."""
    if names.stamp(path) is None:
        return None
    with contextlib.suppress(StoreError, KeyError), opened(path) as (file, _):
        if text(file, "identity") == run_id.hex():
            unfinished(path, run_id).unlink(missing_ok=True)
            locked.remove()
            return _read(file)
    return None


def _check_space(size: int, locked: LockedPart) -> None:
    """A run that will not fit is not begun; other programs may still fill the disk later on.

    At its end its part and its file are both there.
    """
    folder = locked.path.parent
    need, free = 2 * size, shutil.disk_usage(folder).free + parts.size(locked.file)
    if need > free:
        unit, name = (1e6, "MB") if need > 1e6 else (1e3, "kB")
        enough = f"{need / unit:,.0f} {name}, and only {free / unit:,.0f} {name}"
        raise StoreError(f"{locked.path} needs {enough} are free in {folder}")
