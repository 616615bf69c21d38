"""The resolved numbers of a scene, as its file holds them: every reader has them without the scene's text.

A number that is the same at all points is an attribute of the file; one that is swept is a coordinate; and one that
follows from swept ones (b*, and tau where it is `grazing`) is a dataset over the keys that it depends on.
"""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from vibro_sweep.model.grazing import grazing_clearance
from vibro_sweep.model.parameters import FOLLOWING, FREE_MOTION
from vibro_sweep.model.state import START
from vibro_sweep.scene import Scene
from vibro_sweep.scene.scene import grid

SLAB = 100_000  # points whose numbers are computed at once


def attributes(scene: Scene) -> dict[str, Any]:
    """Numbers and words that hold for all points: name -> value.

    The system's numbers, `tau` in radians, `b_star`, `stops`, `model` with its `order` and `expand_at`, the initial
    state (`start_x1`, ...; of a `follow` that of its first point) unless it is random, `transient` and `record` in
    forcing periods, `section`: `phase`, or `impact` with `section_stop`; and `picture` where the scene has it.
    """
    result: dict[str, Any] = scene.system.parameters()
    if not depends_on(scene):
        result["b_star"] = float(grazing_clearance(result))
    result = {name: value for name, value in result.items() if name not in (*scene.sweep, *dimensions(scene))}
    result |= {"stops": scene.system.stops, "model": scene.model}
    if scene.model == "map":
        result |= {"order": scene.order} | ({} if scene.expand_at is None else {"expand_at": scene.expand_at})
    if scene.start.kind != "random":
        state = dict(zip(START.values(), scene.start.state, strict=True))
        result |= {name: value for name, value in state.items() if name not in scene.sweep}
    result |= {"transient": scene.transient, "record": scene.record, "section": scene.section.kind}
    result |= {"section_stop": scene.section.stop} if scene.section.kind == "impact" else {}
    return result | ({"picture": scene.picture} if scene.picture else {})


def depends_on(scene: Scene) -> tuple[str, ...]:
    """The swept keys on which the free motion depends, in order."""
    return tuple(key for key in scene.sweep if key in FREE_MOTION)


def dimensions(scene: Scene) -> dict[str, tuple[str, ...]]:
    """The numbers that follow from swept ones, and the keys over which they are stored."""
    keys = depends_on(scene)
    fixed = "tau" in scene.sweep or scene.system.tau != "grazing"
    return {name: keys for name in FOLLOWING if not (name == "tau" and fixed)} if keys else {}


def following(scene: Scene, box: tuple[slice, ...]) -> dict[str, np.ndarray]:
    """b* and tau over a box of the keys of `depends_on`, each of the box's shape."""
    axes = {key: scene.sweep[key][part] for key, part in zip(depends_on(scene), box, strict=True)}
    numbers = grid(scene.system, axes)
    return {"tau": numbers["tau"], "b_star": grazing_clearance(numbers)}


def slabs(scene: Scene) -> Iterator[tuple[slice, ...]]:
    """Boxes of the keys of `depends_on` that are computed one after the other."""
    shape = [len(scene.sweep[key]) for key in depends_on(scene)]
    rows = max(1, SLAB // math.prod(shape[1:]))
    for first in range(0, shape[0], rows):
        yield slice(first, min(first + rows, shape[0])), *(slice(0, length) for length in shape[1:])
