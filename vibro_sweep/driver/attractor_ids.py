"""`attractor_id`: the same number for the same attractor all over a file, once all of its points are there.

It follows from what the file holds alone: neither blocks nor workers nor interruptions matter.
Orbits with the same numbers of the system, which differ in where they start, are grouped; along the swept numbers of
the system attractors are followed. Two of these make a curve through the plane that turns round at the end of each row.
"""

import math
from collections.abc import Callable, Iterator

import numpy as np

from vibro_sweep.analysis.attractors.following import Follower, known
from vibro_sweep.analysis.attractors.grouping import BAD, NOT_SETTLED, group, share
from vibro_sweep.oscillator.grid import grid
from vibro_sweep.results.boxes import Box, boxes
from vibro_sweep.scene import Scene

Arrays = dict[str, np.ndarray]

NOWHERE = np.iinfo(np.int64).max  # first orbit of an attractor that a point does not have


ROOM = 300_000  # orbits that are held at once, or those of one system
USED = ("attractor", "attractor_id", "share", "period", "average", "average_error")


def following(scene: Scene) -> tuple[str, ...]:
    """The variables of a scene that are known when all of its points are computed."""
    if "attractors" not in scene.observe:
        return ()
    return ("attractor_id", "attractor", "share") if scene.start.kind == "follow" else ("attractor_id",)


def number_attractors(scene: Scene, read: Callable[[str], np.ndarray], room: int = ROOM) -> Arrays:
    """The variables `following` of a scene whose points are all computed; about `room` orbits are held at once.

    read : gives its variables by name
    """
    file = {name: read(name) for name in USED}
    file |= {name: np.array(file[name]) for name in following(scene)}
    names = [*scene.sweep, *(["start"] if scene.n_starts > 1 else [])]
    keys = [axis for axis, name in enumerate(names) if not name.startswith("start")]
    orbits = math.prod(extent for axis, extent in enumerate(scene.shape) if axis not in keys)
    follower = Follower(scene.system.masses)
    for part, order in _curve(tuple(scene.shape[axis] for axis in keys), max(1, room // orbits)):
        box = [slice(0, extent) for extent in scene.shape]
        for axis, interval in zip(keys, part, strict=True):
            box[axis] = interval
        axes = {names[axis]: scene.sweep[names[axis]][interval] for axis, interval in zip(keys, part, strict=True)}
        numbers = grid(scene.system, axes)
        system = [numbers[name].reshape(-1)[order] for name in ("omega", "b")]
        _number_points(file, tuple(box), keys, order, system, follower, scene.start.kind == "follow")
    return {name: file[name] for name in following(scene)}


def _curve(shape: tuple[int, ...], size: int) -> Iterator[tuple[Box, np.ndarray]]:
    """Parts of at most `size` points of a sweep, and the order of each part's points, so that neighbours follow.

    Every second row of a plane is run backwards. A part is some whole rows, or some of a row.
    """
    if len(shape) == 2 and size < shape[1]:
        for row in range(shape[0]):
            parts = [(slice(row, row + 1), *part) for part in boxes(shape[1:], lambda: size)]
            for part in reversed(parts) if row % 2 else parts:
                yield part, _order(part)
    else:
        for part in boxes(shape, lambda: size):
            yield part, _order(part)


def _order(part: Box) -> np.ndarray:
    """The places in a part of the curve of its points."""
    order = np.arange(math.prod(interval.stop - interval.start for interval in part))
    if len(part) == 2:
        order = order.reshape(-1, part[1].stop - part[1].start)
        backwards = np.arange(part[0].start, part[0].stop) % 2 == 1
        order[backwards] = order[backwards, ::-1].copy()
    return order.ravel()


def _number_points(
    file: Arrays, box: Box, keys: list[int], curve: np.ndarray, system: list, follower: Follower, follow: bool
) -> None:
    """Number the attractors of some points, of which all orbits are held at once.

    The branches of a `follow` are computed apart: what they share at a point is known only here.
    """
    lead = [part.stop - part.start for part in box]
    moved = [lead[axis] for axis in keys] + [extent for axis, extent in enumerate(lead) if axis not in keys]
    points, back = len(curve), np.argsort(curve)

    def rows(values):
        """The values of a box as (points, orbits, ...), in the order of the curve."""
        values = np.moveaxis(values, keys, range(len(keys)))
        return values.reshape(points, -1, *values.shape[len(box) :])[curve]

    def put(name, values):
        file[name][box] = np.moveaxis(values[back].reshape(moved), range(len(keys)), keys)

    rank = rows(np.asarray(file["attractor"][box]))
    orbits = _read(file, box, rows)
    label = group(*orbits)
    first = np.full((points, label.max(initial=0)), NOWHERE)
    for n in range(first.shape[1]):
        members = label == n + 1
        first[:, n] = np.where(members.any(axis=1), members.argmax(axis=1), NOWHERE)
    order = np.argsort(first, axis=1)  # as starts meet them, however they were found
    first = np.take_along_axis(first, order, axis=1)
    numbered = follower.number(known(np.where(first == NOWHERE, -1, first), *orbits, *system))
    number = np.pad(np.take_along_axis(numbered, np.argsort(order, axis=1), axis=1), [(0, 0), (1, 0)])
    put("attractor_id", np.where(rank == BAD, BAD, np.take_along_axis(number, label, axis=1)))
    if follow:
        rank = np.where(rank == BAD, BAD, label)
        put("attractor", rank)
        put("share", share(rank))


def _read(file: Arrays, box: Box, shaped) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The data in the file of the orbits of a box; averages are NaN where an orbit is on no attractor."""
    rank, period, average, error = (
        shaped(np.asarray(file[name][box])) for name in ("attractor", "period", "average", "average_error")
    )
    average = average.copy()
    average[rank <= NOT_SETTLED] = np.nan
    return period, average, error
