"""What is in the HDF5 file of a scene: its quantities and coordinates, and how they are cut into chunks.

Every chunk carries a checksum (fletcher32) that any HDF5 library compares when it reads; datasets of one number lie in
their header, which HDF5 checks as well. A chunk takes its place in the file when its first block is written: until then
it reads as not computed, and costs nothing.
"""

import math
from typing import NamedTuple

import h5py
import numpy as np

from vibro_sweep.attractors import AVERAGED
from vibro_sweep.kernels.observe import RUNNING
from vibro_sweep.kernels.spectrum import periods_read
from vibro_sweep.kernels.status import MEANINGS, NOT_COMPUTED
from vibro_sweep.scene import Scene

CHUNK_BYTES = 2**17  # read at once, and written again by every block that has points in it


class Quantity(NamedTuple):
    dtype: str
    fill: float
    extra: tuple[str, ...]  # dimensions after those of the sweep
    units: str
    long_name: str


_SECTION = {
    "x1": ("1", "displacement x_1 of the first mass at the section"),
    "v1": ("1", "velocity v_1 of the first mass at the section"),
    "x2": ("1", "displacement x_2 of the second mass at the section"),
    "v2": ("1", "velocity v_2 of the second mass at the section"),
}

_PERIOD = Quantity("i8", -1, (), "1", "period of the orbit in forcing periods, 0: none up to half of `record`")

_ATTRACTORS = {
    "attractor": Quantity(
        "i8", -1, (), "1", "attractor of the orbit, from 1, the one that most starts reach; 0: not settled"
    ),
    "share": Quantity("f8", np.nan, (), "1", "share of the starts that reach the attractor of this one"),
    "period": _PERIOD,
    "average": Quantity("f8", np.nan, ("averaged",), "1", "averages that orbits of one attractor share"),
    "average_error": Quantity("f8", np.nan, ("averaged",), "1", "how well the averages are known"),
}

_AXES = {
    "mu_m": ("1", "mass ratio mu_m = M_2/M_1"),
    "mu_k": ("1", "stiffness ratio mu_k = K_2/K_1"),
    "zeta": ("1", "damping ratio zeta"),
    "f2": ("1", "share f_2 of the force on the second mass"),
    "omega": ("1", "forcing frequency omega"),
    "R": ("1", "coefficient of restitution R"),
    "b": ("1", "clearance b"),
    "tau": ("rad", "forcing phase tau at t = 0"),
    "start": ("1", "start of the orbit"),
    "start_x1": ("1", "displacement x_1 of the first mass at t = 0"),
    "start_v1": ("1", "velocity v_1 of the first mass at t = 0"),
    "start_x2": ("1", "displacement x_2 of the second mass at t = 0"),
    "start_v2": ("1", "velocity v_2 of the second mass at t = 0"),
    "averaged": ("1", "section points, impacts in a forcing period, lambda_1"),
    "sample": ("1", "section point, counted from the end of the transient"),
    "exponent": ("1", "Lyapunov exponent, counted from the largest"),
    "elapsed": ("1", "forcing periods since the end of the transient"),
    "time": ("1", "forcing periods since the last section point"),
}


def quantities(scene: Scene) -> dict[str, Quantity]:
    """The datasets that a scene asks for; what it does not observe is not there."""
    wanted = {}
    if "section" in scene.observe:
        for name, (units, long_name) in _SECTION.items():
            wanted[name] = Quantity("f8", np.nan, ("sample",), units, long_name)
        if scene.section.kind == "impact":
            wanted["phase"] = Quantity("f8", np.nan, ("sample",), "rad", "forcing phase omega t mod 2 pi at the impact")
        wanted["period"] = _PERIOD
    if "lyapunov" in scene.observe:
        wanted["lyapunov"] = Quantity(
            "f8", np.nan, ("exponent",), "1", "Lyapunov exponents per unit time, natural logarithm"
        )
        text = "standard error of the exponents; of a periodic orbit: what one more period changes"
        wanted["lyapunov_error"] = Quantity("f8", np.nan, ("exponent",), "1", text)
        wanted["lyapunov_residual"] = Quantity("f8", np.nan, (), "1", "sum of the exponents minus its exact value")
    if "attractors" in scene.observe:
        wanted |= _ATTRACTORS
    if "convergence" in scene.observe:
        text = "Lyapunov exponents as they converge, in the order of their vectors"
        wanted["lyapunov_running"] = Quantity("f8", np.nan, ("elapsed", "exponent"), "1", text)
    if "impacts" in scene.observe:
        wanted["impacts_right"] = Quantity("i8", -1, (), "1", "impacts on the right stop in the recorded periods")
        wanted["impacts_left"] = Quantity("i8", -1, (), "1", "impacts on the left stop in the recorded periods")
        wanted["min_impact_speed"] = Quantity(
            "f8", np.nan, (), "1", "smallest |v_1| before an impact in the recorded periods"
        )
        text = "largest distance from the stop at which an impact was computed"
        wanted["contact_error"] = Quantity("f8", np.nan, (), "1", text)
        wanted["sticking_time"] = Quantity("f8", np.nan, (), "1", "time at rest on a stop in the recorded periods")
    if scene.trajectory:
        for name, (units, long_name) in _SECTION.items():
            text = long_name.replace(" at the section", " along the orbit")
            wanted[f"trajectory_{name}"] = Quantity("f8", np.nan, ("time",), units, text)
    wanted["status"] = Quantity("i1", NOT_COMPUTED, (), "1", "outcome of the computation")
    return wanted


def coordinates(scene: Scene) -> dict[str, np.ndarray]:
    """Every dimension of the scene's file, in order, with its coordinate."""
    result = dict(scene.sweep)
    if scene.n_starts > 1:
        both = scene.start.direction == "both"
        result["start"] = np.array(["up", "down"]) if both else np.arange(scene.n_starts)
    extra = {dimension for quantity in quantities(scene).values() for dimension in quantity.extra}
    if "sample" in extra:
        result["sample"] = np.arange(scene.record)
    if "exponent" in extra:
        result["exponent"] = np.arange(1, 5)
    if "averaged" in extra:
        result["averaged"] = np.array(AVERAGED)
    if "elapsed" in extra:
        parts = min(RUNNING, scene.record)
        result["elapsed"] = np.array([periods_read.py_func(m, parts, scene.record) for m in range(parts)])
    if "time" in extra:
        result["time"] = np.linspace(0.0, scene.trajectory.periods, scene.trajectory.samples)
    return result


def size(scene: Scene) -> int:
    """Bytes of the scene's file, but for its structure: some kilobytes, and 20 bytes a chunk."""
    extents = {name: len(values) for name, values in coordinates(scene).items()}
    total = 0
    for quantity in quantities(scene).values():
        shape = tuple(extents[name] for name in dimensions(scene, quantity))
        chunk = chunk_shape(scene, shape, np.dtype(quantity.dtype).itemsize)
        count = math.prod(-(-extent // length) for extent, length in zip(shape, chunk, strict=True))
        total += count * math.prod(chunk) * np.dtype(quantity.dtype).itemsize
    return total + 8 * sum(extents.values())


def dimensions(scene: Scene, quantity: Quantity) -> tuple[str, ...]:
    """Names of a dataset's dimensions, in order."""
    return (*scene.sweep, *(["start"] if scene.n_starts > 1 else []), *quantity.extra)


def chunk_shape(scene: Scene, shape: tuple[int, ...], itemsize: int) -> tuple[int, ...]:
    """Axes are taken whole, from the last one on, while they fit; the first that does not is cut into equal parts.

    Blocks of points are cut in the same way, so that one touches few chunks; of a `follow`, whose blocks hold the whole
    first axis, that one comes first of the sweep's.
    """
    axes = list(reversed(range(len(shape))))
    if scene.start.kind == "follow":
        axes.insert(len(axes) - len(scene.sweep), axes.pop())
    room = CHUNK_BYTES // itemsize
    chunk = [1] * len(shape)
    for axis in axes:
        parts = -(-shape[axis] // max(1, room))
        chunk[axis] = -(-shape[axis] // parts)
        room //= chunk[axis]
    return tuple(chunk)


def create(file: h5py.File, scene: Scene) -> None:
    """The scene's coordinates and datasets, with nothing computed yet."""
    axes = coordinates(scene)
    for name, values in axes.items():
        if values.dtype.kind == "U":
            file.create_dataset(name, data=values.astype(object), dtype=h5py.string_dtype())
        else:
            file.create_dataset(name, data=values, chunks=chunk_shape(scene, values.shape, 8), fletcher32=True)
        file[name].make_scale(name)
        file[name].attrs["units"], file[name].attrs["long_name"] = _AXES[name]
    for name, quantity in quantities(scene).items():
        lead = dimensions(scene, quantity)
        shape = tuple(len(axes[dimension]) for dimension in lead)
        if shape:
            chunk = chunk_shape(scene, shape, np.dtype(quantity.dtype).itemsize)
            file.create_dataset(name, shape, quantity.dtype, chunks=chunk, fletcher32=True, fillvalue=quantity.fill)
        else:
            _create_number(file, name, quantity)
        dataset = file[name]
        dataset.attrs["units"], dataset.attrs["long_name"] = quantity.units, quantity.long_name
        for i, dimension in enumerate(lead):
            dataset.dims[i].attach_scale(file[dimension])
    file["status"].attrs["flag_values"] = np.array(list(MEANINGS), np.int8)
    file["status"].attrs["flag_meanings"] = " ".join(MEANINGS.values())


def _create_number(file: h5py.File, name: str, quantity: Quantity) -> None:
    """A dataset of one number, within its header."""
    how = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    how.set_layout(h5py.h5d.COMPACT)
    how.set_fill_value(np.array(quantity.fill, quantity.dtype))
    kind, space = h5py.h5t.py_create(np.dtype(quantity.dtype)), h5py.h5s.create(h5py.h5s.SCALAR)
    h5py.h5d.create(file.id, name.encode(), kind, space, how)
