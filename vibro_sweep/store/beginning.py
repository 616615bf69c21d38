"""Beginning to write a file: anew, where a run was interrupted, or to mend what is damaged; one run at a time."""

import contextlib
import json
import shutil
from collections.abc import Collection, Iterator
from pathlib import Path

import h5py

from vibro_sweep.model.refusals import not_allowed
from vibro_sweep.scene import Scene
from vibro_sweep.store import appending, checks, layout, names, parts
from vibro_sweep.store.appending import LockedPart
from vibro_sweep.store.attributes import text
from vibro_sweep.store.creating import skeleton_of
from vibro_sweep.store.done import Done, in_order_of_blocks
from vibro_sweep.store.image import Index, frame_of
from vibro_sweep.store.names import Stamp
from vibro_sweep.store.opening import (
    StoreError,
    blocks_lost,
    check_scene,
    check_version,
    opened,
    quantities_of,
    skeleton,
)
from vibro_sweep.store.parts import Head, PartError
from vibro_sweep.store.writing import Complete, Writer, said, unfinished

MODES = ("new", "resume", "overwrite")
NO_DATA = (".png", ".svg", ".pdf", ".yaml", ".yml")  # endings of other files of this program


@contextlib.contextmanager
def writer(scene: Scene, path: Path, mode: str) -> Iterator[Writer | Complete]:
    """The `Writer` of a scene's file; `mode` is "new", "resume" or "overwrite". Raises StoreError."""
    part = check_outputs(path, mode, scene.inputs)
    with contextlib.ExitStack() as stack:
        try:
            if mode == "new" and names.stamp(path):
                result = _finished(scene, path)
            elif mode == "resume" and names.stamp(path) and not names.stamp(part):
                result = _of_complete(scene, path, part, stack)
            else:
                locked = stack.enter_context(contextlib.closing(_locked(part)))
                if mode == "resume" and parts.is_begun(locked.file):
                    result = _continued(scene, locked, path)
                else:
                    result = _begun(scene, locked, path, names.stamp(path) if mode == "overwrite" else None)
        except BlockingIOError:
            raise StoreError(f"{part} is being written by another run") from None
        except FileExistsError:
            raise StoreError(f"{part} has just been begun by another run") from None
        except PartError as error:
            raise StoreError(f"{part} {error}") from None
        yield result


def check_outputs(path: Path, mode: str, inputs: Collection[Path]) -> Path:
    """Raise StoreError where a run must not write, before anything is touched. Returns the name of the part.

    inputs : files that the run reads; none of them is written, by whatever name or link
    """
    check_mode(mode)
    if path.suffix.lower() in NO_DATA:
        raise StoreError(f"`output` {path}: the name of a data file must not end in {path.suffix}")
    part = Path(f"{path}.part")
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


def _finished(scene: Scene, path: Path) -> Complete:
    """A file that needs no run: whole, and made by the same scene and code. Raises StoreError for any other."""
    try:
        with opened(path) as (file, _):
            check_scene(file, path, scene)
            check_version(file, path)
            if found := checks.damaged(file):
                raise StoreError(f"{path} is damaged: {checks.summary(found)}; `resume` computes that again")
            result = _complete(file)
    except StoreError as error:
        text = f"{path} exists, and is not what this scene makes; `overwrite` replaces it, or name another file"
        raise StoreError(f"{text}\n{error}") from None
    if result.missing(()):
        raise StoreError(f"{path} exists, and some of its points are not computed; `resume` computes them")
    return result


def _complete(file: h5py.File) -> Complete:
    return Complete(checks.statuses(file), json.loads(text(file, "provenance")).get("wall_time_s", 0.0))


def _locked(part: Path) -> LockedPart:
    return appending.lock(part) if names.stamp(part) else appending.make(part)


def _of_complete(scene: Scene, path: Path, part: Path, stack: contextlib.ExitStack) -> Writer | Complete:
    """Keep what is computed and not damaged in a file, and compute the rest; mostly there is nothing to do."""
    with opened(path) as (file, _):
        check_scene(file, path, scene)
        lacking = [name for name in layout.quantities(scene) if name not in quantities_of(file)]
        if lacking:
            raise StoreError(f"{path} is damaged: it has no {', '.join(lacking)}; overwrite it")
        found = checks.damaged(file)
        if not all(piece for _, piece in found):
            raise StoreError(f"{path} is damaged beyond repair: {checks.summary(found)}; overwrite it")
        result = _complete(file)
        if not found and not result.missing(()):
            return result
        check_version(file, path)
        locked = stack.enter_context(contextlib.closing(appending.make(part)))
        result = _begun(scene, locked, path, names.stamp(path))
        result.take_over(file, found)
        return result


def _begun(scene: Scene, locked: LockedPart, path: Path, replaces: Stamp | None) -> Writer:
    """Begin the part with nothing computed yet, in place of what is in it."""
    with contextlib.suppress(PartError):  # overwritten
        unfinished(path, parts.read_head(locked.file).run_id).unlink(missing_ok=True)
    try:
        _check_space(scene, locked)
        run_id = parts.new_run_id()
        content = skeleton_of(scene, run_id)
        with said(locked):
            locked.begin(parts.new_head(content, replaces, run_id), content)
    except BaseException:
        if parts.size(locked.file) == 0:
            locked.remove()
        raise
    return _writer(scene, locked, path)[0]


def _continued(scene: Scene, locked: LockedPart, path: Path) -> Writer | Complete:
    """Continue the part with what was computed until its run was interrupted."""
    head = parts.read_head(locked.file)
    with skeleton(locked.file, locked.path) as file:
        check_scene(file, locked.path, scene)
        check_version(file, locked.path)
    if finished := _published(path, locked, head):
        return finished
    if (found := names.stamp(path)) and found != head.replaces:
        raise StoreError(
            f"{path} stands beside the interrupted run {locked.path}, which is not to replace it; move one of them "
            "away, or `overwrite` both"
        )
    result, index = _writer(scene, locked, path)
    locked.go_on(head, index.end)
    if index.damaged:
        result.remark(f"damage found, to be computed again: {blocks_lost(index.damaged)}")
    return result


def _writer(scene: Scene, locked: LockedPart, path: Path) -> tuple[Writer, Index]:
    head = parts.read_head(locked.file)
    with skeleton(locked.file, locked.path) as file:
        frame = frame_of(file, quantities_of(file))
    index = Index(locked.file, head, frame)
    order = in_order_of_blocks(len(frame.shape), len(scene.sweep), scene.start.kind == "follow")
    done = Done(frame.shape, order)
    for box, _ in index:
        done.add(box)
    return Writer(locked, frame, done, path), index


def _published(path: Path, locked: LockedPart, head: Head) -> Complete | None:
    """The file, if it is what was made of this part before its run was killed; the part then goes."""
    if names.stamp(path) is None:
        return None
    with contextlib.suppress(StoreError, KeyError), opened(path) as (file, _):
        if text(file, "identity") == head.run_id.hex():
            unfinished(path, head.run_id).unlink(missing_ok=True)
            locked.remove()
            return _complete(file)
    return None


def _check_space(scene: Scene, locked: LockedPart) -> None:
    """A run that will not fit is not begun; other programs may still fill the disk later on.

    At its end its part and its file are both there.
    """
    folder = locked.path.parent
    need, free = 2 * layout.size(scene), shutil.disk_usage(folder).free + parts.size(locked.file)
    if need > free:
        unit, name = (1e6, "MB") if need > 1e6 else (1e3, "kB")
        enough = f"{need / unit:,.0f} {name}, and only {free / unit:,.0f} {name}"
        raise StoreError(f"{locked.path} needs {enough} are free in {folder}")
