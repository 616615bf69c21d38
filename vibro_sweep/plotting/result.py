"""What a picture needs from a result file: the sweep, what is computed, the scene's numbers."""

import math
from typing import NamedTuple

import h5py
import numpy as np
import yaml

from vibro_sweep import journal
from vibro_sweep.plotting.style import SYMBOLS
from vibro_sweep.system import steady_response


class PlotError(ValueError):
    """What was asked for cannot be drawn; the message says what can."""


class Point(NamedTuple):
    """One orbit of the file: its place in the arrays, its place in the sweep, and what to call it."""

    index: tuple[int, ...]
    place: tuple[int, ...]
    label: str


class Result:
    """A result file, open for reading; a context manager.

    `sweep`: key -> its values, in order; `starts`: names of the starts (one empty name if there is only one);
    `follow`: they are an upward and a downward branch; `done`: bool, shape (*sweep, starts), which points are
    computed; `failed`: none of them well; `scene`: the scene as a mapping, {} where it is illegible.
    Raises `PlotError` where the file is missing or not a result.
    """

    def __init__(self, path):
        self.path = path
        try:
            journal.recover(path)
            # A .part file is locked by the process that writes it; a picture of it is wanted all the same. A whole one
            # may be open in this process as `vibro_sweep.open` opens it, and HDF5 wants it opened alike.
            self._file = h5py.File(path, "r", locking=False if str(path).endswith(".part") else None)
        except FileNotFoundError as error:
            raise PlotError(f"{path}: no such file") from error
        except OSError as error:
            raise PlotError(f"{path}: not an HDF5 file, or not a whole one") from error
        try:
            self._read_frame()
        except BaseException:
            self._file.close()
            raise

    def _read_frame(self):
        if "status" not in self._file:
            raise PlotError(f"{self.path}: not a result of vibro-sweep (no dataset `status`)")
        status = self._file["status"]
        try:
            names = [dim[0].name.rpartition("/")[2] for dim in status.dims]
        except (IndexError, RuntimeError) as error:
            raise PlotError(f"{self.path}: not a result of vibro-sweep (no dimension scales)") from error
        self.sweep = {name: self.coordinate(name).astype(float) for name in names if name != "start"}
        self._one_start = "start" not in names
        starts = [""] if self._one_start else self.coordinate("start")
        self.starts = [start.decode() if isinstance(start, bytes) else str(start) for start in starts]
        self.follow = self.starts == ["up", "down"]
        codes = self._with_start(self._read("status"))
        self.done = codes != -1
        self.failed = self.done.any() and not (codes == 0).any()
        self.scene = _mapping(self._file.attrs.get("scene", ""))
        self._system = _system(self.scene)

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        self._file.close()

    def _read(self, name, index=()):
        try:
            return self._file[name][index]
        except OSError as error:  # h5py's word for what it cannot read back
            raise PlotError(f"{self.path}: `{name}` cannot be read, it is damaged or being written") from error

    def __contains__(self, name) -> bool:
        return name in self._file

    def contents(self) -> str:
        """The names of the stored quantities, for a message."""
        return ", ".join(name for name in sorted(self._file) if not self._file[name].is_scale)

    def coordinate(self, name) -> np.ndarray:
        """Values of a dimension."""
        return self._read(name)

    def array(self, name) -> np.ndarray:
        """A quantity as floats, shape (*sweep, starts, its own dimensions); NaN where not computed or failed."""
        stored = self._with_start(self._read(name))
        values = stored.astype(float)
        values[~self.done] = np.nan
        if stored.dtype.kind == "i":
            values[stored == -1] = np.nan
        return values

    def one(self, name, point: Point) -> np.ndarray:
        """A quantity at one point, shape (its own dimensions); reads no other point."""
        return self._read(name, point.index[:-1] if self._one_start else point.index)

    def _with_start(self, values) -> np.ndarray:
        return np.expand_dims(values, len(self.sweep)) if self._one_start else values

    def number(self, name, place=()) -> float | None:
        """A number of the system at a place in the sweep; None where the scene does not tell."""
        if name in self.sweep:
            return float(self.sweep[name][place[list(self.sweep).index(name)]])
        return self._system.get(name)

    def stops(self, place) -> dict[int, float]:
        """Where the stops are: side (+1 right, -1 left) -> x1."""
        b = self.number("b", place)
        sides = {"right": (1,), "left": (-1,)}.get(self._system.get("stops"), (1, -1))
        return {} if b is None else {side: side * b for side in sides}

    def grazing(self, **swept) -> np.ndarray | None:
        """b* of Theorem 1 for swept values (n,) of some of the system's numbers; None where the scene does not tell."""
        numbers = [swept.get(name, self._system.get(name)) for name in ("mu_m", "mu_k", "zeta", "f2", "omega")]
        if None in [value if np.ndim(value) == 0 else 0 for value in numbers]:
            return None
        d, e = steady_response(*np.broadcast_arrays(*numbers))
        return np.hypot(d[..., 0], e[..., 0])

    def is_chaotic(self) -> np.ndarray:
        """Where lambda_1 > 0 beyond two standard errors, if they are stored; bool, shape (*sweep, starts)."""
        largest = self.array("lyapunov")[..., 0]
        error = self.array("lyapunov_error")[..., 0] if "lyapunov_error" in self else 0.0
        return largest - 2 * error > 0

    def model(self) -> str:
        """What was iterated, for a title: nothing where it is the oscillator itself."""
        if self.scene.get("model") != "map":
            return ""
        at = self.scene.get("expand_at")
        where = "" if at is None else f", expanded at $b = {at:.8g}$"
        return f"discontinuity mapping of order {self.scene.get('order', 1)}{where}"

    def setting(self, group, name):
        """An entry such as `orbit: transient` of the scene, None where it is absent."""
        entries = self.scene.get(group)
        return entries.get(name) if isinstance(entries, dict) else None

    def points(self, most=4) -> list[Point]:
        """Up to `most` computed orbits, evenly spread over the sweep, two starts at a place if there are."""
        starts = _spread(range(len(self.starts)), 2 if self.sweep else most)
        places = [tuple(map(int, place)) for place in np.argwhere(self.done[..., starts].any(axis=-1))]
        return [
            Point((*place, start), place, self._label(place, start))
            for place in _spread(places, most // len(starts))
            for start in starts
            if self.done[(*place, start)]
        ]

    def _label(self, place, start) -> str:
        values = [f"${SYMBOLS.get(key, key)} = {self.number(key, place):.6g}$" for key in self.sweep]
        name = self.starts[start]
        return ", ".join([*values, *([name if self.follow else f"start {name}"] if name else [])])

    def title(self, what="") -> str:
        """What is shown, the numbers that are the same at every point, and how much is there if not all."""
        same = [(key, self._system[key]) for key in SYMBOLS if key in self._system and key not in self.sweep]
        numbers = ", ".join(f"${SYMBOLS[key]} = {value:.6g}$" for key, value in same)
        stops = self.setting("system", "stops")
        if stops in ("right", "left"):
            numbers += f", {stops} stop only"
        missing = "" if self.done.all() else f"{self.done.sum()} of {self.done.size} points computed"
        return "\n".join(filter(None, ["; ".join(filter(None, [what, self.model(), missing])), numbers]))


def _spread(items, most) -> list:
    items = list(items)
    at = np.linspace(0, len(items) - 1, min(most, len(items))).round().astype(int)
    return [items[i] for i in at]


def _mapping(text) -> dict:
    try:
        scene = yaml.safe_load(text)
    except (yaml.YAMLError, AttributeError):
        return {}
    return scene if isinstance(scene, dict) else {}


def _numbers(entries) -> dict:
    """The entries that are numbers, also those that YAML 1.1 takes for text (1e-9)."""
    numbers = {}
    for key, value in entries.items():
        try:
            numbers[key] = float(value)
        except (TypeError, ValueError):
            continue
    return numbers


def _system(scene) -> dict:
    """Nondimensional numbers of the scene's system, and `stops`; physical ones by physics.md (eqs. 3, 4)."""
    system = scene.get("system")
    if not isinstance(system, dict):
        return {}
    numbers = _numbers(system)
    if isinstance(system.get("physical"), dict):
        p = _numbers(system["physical"])
        try:
            force = p["P1"] + p["P2"]
            numbers |= {
                "mu_m": p["M2"] / p["M1"],
                "mu_k": p["K2"] / p["K1"],
                "zeta": p["C1"] / (2 * math.sqrt(p["K1"] * p["M1"])),
                "f2": p["P2"] / force,
                "omega": p["Omega"] * math.sqrt(p["M1"] / p["K1"]),
                "R": p["R"],
                "b": p["B"] * p["K1"] / force,
            }
        except (KeyError, ZeroDivisionError, ValueError):
            pass
    return numbers | {"stops": system.get("stops")}
