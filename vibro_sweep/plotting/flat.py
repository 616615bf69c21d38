"""Files of branches and windows as pictures take them: all arrays, and what the file says of itself."""

from pathlib import Path

import numpy as np

from vibro_sweep.model.bifurcations import KINDS, TYPES
from vibro_sweep.model.branch_file import WINDOWS
from vibro_sweep.plotting.source import PlotError
from vibro_sweep.store.attributes import text, texts
from vibro_sweep.store.opening import StoreError, is_flat, opened, quantities_of


class FlatFile:
    """`arrays`: name -> values; `parameters`: names, that along which branches lead first; `sweep`: identity of the
    sweep whose windows they are. Raises PlotError for any other file."""

    def __init__(self, path: str | Path, kind: str):
        try:
            with opened(Path(path)) as (file, _):
                if not is_flat(file) or text(file, "kind") != kind:
                    raise PlotError(f"{path}: holds no {kind}")
                self.arrays = {name: file[name][()] for name in quantities_of(file)}
                self.parameters = texts(file, "parameters")
                self.title = text(file, "title").removeprefix("vibro_sweep: ")
                self.sweep = text(file, "sweep") if "sweep" in file.attrs else ""
        except StoreError as error:
            raise PlotError(str(error)) from error
        self.name = str(path)

    def __getitem__(self, name: str) -> np.ndarray:
        return self.arrays[name]

    def types(self) -> list[str]:
        """Of all special points; of a graze with its kind: graze or nonsmooth_fold."""
        names = [TYPES[code].name for code in self["special_type"].tolist()]
        kinds = [KINDS[code] for code in self["special_kind"].tolist()]
        return [kind if kind == "nonsmooth_fold" else name for name, kind in zip(names, kinds, strict=True)]


def check_over(path: str | Path) -> None:
    """Raise PlotError for a file of branches, curves or windows, over which nothing can be drawn."""
    try:
        with opened(Path(path), (), content=False) as (file, _):
            kind = text(file, "kind") if is_flat(file) else None
    except StoreError as error:
        raise PlotError(str(error)) from error
    if kind is not None:
        raise PlotError(f"over: {path} holds {kind}, and no sweep")


def flat_kind(data) -> str | None:
    """Of a file of branches or curves its kind, else None; PlotError for one of windows says what shows them."""
    if not isinstance(data, (str, Path)):
        return None
    try:
        with opened(Path(data), (), content=False) as (file, _):
            kind = text(file, "kind") if is_flat(file) else None
    except StoreError:  # whoever draws it as a sweep says what is wrong
        return None
    if kind == WINDOWS:
        raise PlotError(f"{data} holds the windows of a sweep; `plot SWEEP.h5 --windows {data}` shows them")
    return kind
