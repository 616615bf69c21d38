"""`attractor_id`: the same number for the same attractor all over a file, once all of its points are there.

It follows from what the file holds alone, read a part at a time: neither blocks nor workers nor interruptions matter.
Orbits with the same numbers of the system, which differ in where they start, are grouped; along the swept numbers of
the system attractors are followed. Two of these make a curve through the plane that turns round at the end of each row.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from vibro_sweep.analysis.attractors.following import Follower, known
from vibro_sweep.analysis.attractors.grouping import BAD, NOT_SETTLED, group, share
from vibro_sweep.analysis.attractors.many import ROOM, Orbits, group_pieces
from vibro_sweep.driver.blocks import boxes
from vibro_sweep.model.grid import grid
from vibro_sweep.scene import Scene

Box = tuple[slice, ...]
Arrays = Mapping[str, Any]

NOWHERE = np.iinfo(np.int64).max  # first orbit of an attractor that a point does not have


def number_attractors(scene: Scene, file: Arrays, room: int = ROOM) -> None:
    """Number the attractors of a scene whose points are all computed; about `room` orbits are held at once.

    file : datasets by name, as h5py has them or in memory; `attractor_id` is written
    """
    names = [*scene.sweep, *(["start"] if scene.n_starts > 1 else [])]
    keys = [axis for axis, name in enumerate(names) if not name.startswith("start")]
    orbits = math.prod(extent for axis, extent in enumerate(scene.shape) if axis not in keys)
    follower = Follower(scene.system.masses)
    for part, order in _curve(tuple(scene.shape[axis] for axis in keys), max(1, room // orbits)):
        box = [slice(0, extent) for extent in scene.shape]
        for axis, one in zip(keys, part, strict=True):
            box[axis] = one
        axes = {names[axis]: scene.sweep[names[axis]][one] for axis, one in zip(keys, part, strict=True)}
        numbers = grid(scene.system, axes)
        system = [numbers[name].reshape(-1)[order] for name in ("omega", "b")]
        if orbits > room:
            _number_point(file, tuple(box), system, follower, room)
        else:
            _number_points(file, tuple(box), keys, order, system, follower, scene.start.kind == "follow")


def _curve(shape: tuple[int, ...], size: int) -> Iterator[tuple[Box, np.ndarray]]:
    """Parts of at most `size` points of a sweep, and the order of each part's points, so that neighbours follow.

    Every second row of a plane is run backwards. A part is some whole rows, or some of a row.
    """
    if len(shape) == 2 and size < shape[1]:
        for row in range(shape[0]):
            parts = [(slice(row, row + 1), *part) for part in boxes(shape[1:], size)]
            for part in reversed(parts) if row % 2 else parts:
                yield part, _order(part)
    else:
        for part in boxes(shape, size):
            yield part, _order(part)


def _order(part: Box) -> np.ndarray:
    """The places in a part of the curve of its points."""
    order = np.arange(math.prod(one.stop - one.start for one in part))
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
    found = follower.number(known(np.where(first == NOWHERE, -1, first), *orbits, *system))
    number = np.pad(np.take_along_axis(found, np.argsort(order, axis=1), axis=1), [(0, 0), (1, 0)])
    put("attractor_id", np.where(rank == BAD, BAD, np.take_along_axis(number, label, axis=1)))
    if follow:
        rank = np.where(rank == BAD, BAD, label)
        put("attractor", rank)
        put("share", share(rank))


def _number_point(file: Arrays, box: Box, system: list, follower: Follower, room: int) -> None:
    """Number the attractors of one point whose orbits come in pieces."""
    shape = tuple(part.stop - part.start for part in box)
    pieces = [
        tuple(slice(whole.start + part.start, whole.start + part.stop) for whole, part in zip(box, piece, strict=True))
        for piece in boxes(shape, room)
    ]

    def flat(values):
        return values.reshape(-1, *values.shape[len(box) :])

    ends = np.cumsum([math.prod(part.stop - part.start for part in piece) for piece in pieces]).tolist()
    label = group_pieces(ends, lambda n: _read(file, pieces[n], flat), room)
    present, first = np.unique(label, return_index=True)
    present, first = present[present > NOT_SETTLED], first[present > NOT_SETTLED]
    order = np.argsort(first)
    rows = []
    for place in first[order]:
        n = int(np.searchsorted(ends, place, side="right"))
        start = ends[n - 1] if n else 0
        rows.append([values[place - start] for values in _read(file, pieces[n], flat)])
    number = np.zeros(label.max(initial=0) + 1, np.int32)
    if rows:
        orbits = [np.stack(values)[None] for values in zip(*rows, strict=True)]
        number[present[order]] = follower.number(known(np.arange(len(rows))[None], *orbits, *system))[0]
    for start, end, piece in zip([0, *ends], ends, pieces, strict=False):
        rank = file["attractor"][piece]
        file["attractor_id"][piece] = np.where(rank == BAD, BAD, number[label[start:end]].reshape(rank.shape))


def _read(file: Arrays, box: Box, shaped) -> Orbits:
    """The data in the file of the orbits of a box; averages are NaN where an orbit is on no attractor."""
    rank, period, average, error = (
        shaped(np.asarray(file[name][box])) for name in ("attractor", "period", "average", "average_error")
    )
    average = average.copy()
    average[rank <= NOT_SETTLED] = np.nan
    return Orbits(period, average, error)
