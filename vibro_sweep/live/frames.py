"""The frames of a sweep: an early picture of it, then its numbers in pieces, each as soon as it is computed."""

import time
from collections.abc import Collection, Iterator
from typing import Literal, NamedTuple

import numpy as np

from vibro_sweep.checks.arguments import check_type
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.driver.block_columns import columns_of, draft_of, whole_block
from vibro_sweep.driver.blocks import Block, blocks, next_part
from vibro_sweep.driver.compute import CHAIN_ENDS, compute
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.live.pace import Pace
from vibro_sweep.results.layout import quantities
from vibro_sweep.scene import Scene

PIECE = 0.01  # seconds


class Preview(NamedTuple):
    """An early picture of a sweep: at most so many columns of so many forcing periods, in about so many seconds."""

    columns: int = 250
    transient: int = 300
    record: int = 50
    seconds: float = 0.02


class Frame(NamedTuple):
    """A part of a sweep.

    kind : "preview": every n-th value of the sweep, with shorter orbits and without exponents; "piece": its numbers
    box : where the arrays belong in those of the sweep, `dataset[name][frame.box]`; of a preview along the swept number
    arrays : by name of the variable, `status` among them
    seconds : that it took
    exact : whether these are the numbers of the sweep. In a preview of a `follow` each point starts by itself
    last : whether the sweep is complete with it
    """

    kind: Literal["preview", "piece"]
    box: tuple[slice, ...]
    arrays: dict[str, np.ndarray]
    seconds: float
    exact: bool
    last: bool


def frames(
    scene: Scene,
    *,
    variables: Collection[str] | None = None,
    preview: Preview | None = Preview(),  # noqa: B008
    seconds: float = PIECE,
    pace: Pace | None = None,
) -> Iterator[Frame]:
    """The frames of a sweep of one number, computed one by one in the thread that asks for them.

    Parameters
    ----------
    variables : those of the sweep's Dataset that are wanted, or `end`, the states (2 N) in which orbits end; left out:
        all of the Dataset. A preview has those of the section, or where there are none, those of contacts
    preview : None: without one
    seconds : that a piece takes, more or less
    pace : measured on the sweeps before, where they are of the same kind; it is brought up to date

    Pieces have the bits of `vibro_sweep.run`. They come interlaced: each makes the picture finer everywhere. Those of a
    `follow` come in its order. Whoever has seen enough closes the iterator.

    Raises ValueError for a scene that does not sweep one number, for one that numbers attractors, which takes all
    points, and for a variable that the scene does not have.
    """
    check_type("scene", scene, Scene, "a scene of a sweep")
    if len(scene.sweep) != 1:
        raise ArgumentError(not_allowed("scene.sweep", [*scene.sweep], "one number"))
    if "attractors" in scene.observe:
        raise ArgumentError(not_allowed("scene.observe", "attractors", "of other words: these take the whole sweep"))
    known = {*quantities(scene)}
    for name in variables or ():
        if name not in known | {"end"}:
            raise ArgumentError(not_allowed("variables", name, f"of {', '.join(sorted(known))}"))
    wanted = frozenset(known if variables is None else {*variables, "status"})
    return _frames(scene, wanted, preview, seconds, pace or Pace())


def _frames(
    scene: Scene, wanted: frozenset[str], preview: Preview | None, seconds: float, pace: Pace
) -> Iterator[Frame]:
    follow = scene.start.kind == "follow"
    whole = next(blocks(scene, lambda: scene.n_points)) if follow else whole_block(scene, wanted)
    if preview is not None:
        yield _preview(scene, whole, wanted, preview, pace)
    yield from _chain(scene, whole, wanted, seconds, pace) if follow else _interlaced(whole, seconds, pace)


def _preview(scene: Scene, whole: Block, wanted: frozenset[str], preview: Preview, pace: Pace) -> Frame:
    known = quantities(scene)
    section = {name for name in wanted & known.keys() if known[name].dimensions == ("sample",)}
    contacts = {name for name in wanted & known.keys() if "contacts" in known[name].asked_by}
    draft = draft_of(whole, preview.transient, preview.record, (section or contacts) | {"status"})
    part = columns_of(draft, slice(None, None, pace.step(draft, preview.columns, preview.seconds)))
    return _computed("preview", part, draft, pace, last=False)[0]


def _interlaced(whole: Block, seconds: float, pace: Pace) -> Iterator[Frame]:
    count = pace.pieces(whole, seconds)
    for n, first in enumerate(_bit_reversed(count)):
        part = columns_of(whole, slice(first, None, count))
        yield _computed("piece", part, whole, pace, last=n == count - 1)[0]


def _chain(scene: Scene, whole: Block, wanted: frozenset[str], seconds: float, pace: Pace) -> Iterator[Frame]:
    """The parts of one chain, or of two."""
    columns = len(next(iter(scene.sweep.values())))
    length = -(-columns // pace.pieces(whole._replace(wanted=wanted), seconds))
    chains = [*blocks(scene, lambda: scene.n_points, most_orbits=LANES * length)]
    for n, chain in enumerate(chains):
        block = chain._replace(wanted=wanted)
        while True:
            frame, ends = _computed("piece", block, block, pace, last=block.last and n == len(chains) - 1)
            yield frame
            if block.last:
                break
            block = next_part(scene, block, ends)


def _computed(
    kind: Literal["preview", "piece"], block: Block, whole: Block, pace: Pace, *, last: bool
) -> tuple[Frame, np.ndarray | None]:
    """A frame, and where its chain ends."""
    began = time.perf_counter()
    box, arrays = compute(block)
    ends = arrays.pop(CHAIN_ENDS, None)
    elapsed = time.perf_counter() - began
    pace.measured(whole, len(next(iter(block.axes.values()))), elapsed)
    return Frame(kind, box, arrays, elapsed, kind == "piece", last), ends


def _bit_reversed(count: int) -> list[int]:
    """0 .. count - 1, a power of two, so that those that have come are spread evenly: 0 4 2 6 1 5 3 7."""
    order = [0]
    while len(order) < count:
        order = [2 * n for n in order] + [2 * n + 1 for n in order]
    return order
