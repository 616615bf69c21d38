"""The plane of a sweep whose edges a scene of curves explains: `from: {sweep: PLANE.h5}`, with its keys as
`parameter`."""

from typing import Any

import numpy as np

from vibro_sweep.analysis.windows.edges import Plane, ends_of
from vibro_sweep.analysis.windows.explained import Explained
from vibro_sweep.analysis.windows.rows import check_data
from vibro_sweep.checks.refusals import cut
from vibro_sweep.driver.source_file import SourceError
from vibro_sweep.files.reading import sweep_in
from vibro_sweep.scene import Continuation, parse_scene
from vibro_sweep.tables.coordinates import state


def plane_of(scene: Continuation) -> tuple[Plane, np.ndarray, Any] | None:
    """The plane of the scene's sweep, last recorded states (n, m, 2N), an oscillator; None for a sweep of one number.

    Raises ValueError for a plane that cannot be taken, StoreError for a file that cannot be read.
    """
    if scene.origin != "sweep":
        return None
    names = list(scene.parameter)
    with sweep_in(scene.begin, computes=True) as data:
        keys = data.keys
        if len(keys) != 2:
            return None
        check_data(data)
        if sorted(keys) != sorted(names):
            raise SourceError(
                f"continue.parameter: {', '.join(names)} is not allowed; "
                f"{scene.begin} is a plane of {cut(', '.join(keys))}"
            )
        if scene.largest is not None:
            raise SourceError(
                f"continue.from.largest: belongs to windows along one number; {scene.begin} is a plane whose edges are "
                "explained; leave it out"
            )
        if "start" in data.dims("period"):
            raise SourceError(f"continue.from.sweep: {scene.begin} has several starts; it must be a plane of one")
        system = parse_scene(data.attrs["scene"]).system
        values = [data.values(name).astype(float) for name in names]
        rising = np.ix_(*(np.argsort(axis, kind="stable") for axis in values))
        period = data.values("period", names)[rising].astype(int)
        states = np.stack([data.values(name, names)[..., -1][rising] for name in state(system.masses)], axis=-1)
    return Plane(tuple(np.sort(axis) for axis in values), period), states, system


def edges_in_file(plane: Plane, explanation: Explained) -> dict[str, np.ndarray]:
    """The columns of `OF_EDGES`."""
    first, second = np.moveaxis(ends_of(plane, explanation.edges), 1, 0)
    return {"edge_from": first, "edge_to": second, "edge_reason": explanation.reason, "edge_curve": explanation.curve}
