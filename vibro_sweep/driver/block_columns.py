"""A sweep of one number in any order: some of its values, with the numbers that the whole sweep has there."""

from collections.abc import Collection

from vibro_sweep.driver.blocks import Block, blocks
from vibro_sweep.scene import Scene


def whole_block(scene: Scene, wanted: Collection[str]) -> Block:
    """All points and starts of a sweep that does not follow, as one block. wanted: datasets to be computed."""
    (block,) = blocks(scene, lambda: scene.n_points)
    return block._replace(wanted=frozenset(wanted))


def columns_of(block: Block, part: slice) -> Block:
    """The block of a part of the values along the first swept number; the part may have a step.

    What it computes has the bits that the whole block has there, random starts too: they are drawn by a point's place
    in the sweep.
    """
    key, values = next(iter(block.axes.items()))
    begin, end, step = block.box[0].indices(block.shape[0])
    chosen = range(begin, end, step)[part]
    along = slice(chosen.start, chosen.stop, chosen.step)
    return block._replace(box=(along, *block.box[1:]), axes=block.axes | {key: values[part]})


def draft_of(block: Block, transient: int, record: int, wanted: Collection[str]) -> Block:
    """The block with shorter orbits, and without exponents: an early picture of what it will be.

    Where points follow each other, each starts from the first one's state instead.
    """
    plan = block.plan._replace(
        transient=min(transient, block.plan.transient),
        record=min(record, block.plan.record),
        warm_up=0,
        settle=0,
        lyapunov=False,
        impacts=False,
        energy=False,
        attractors=False,
        parts=0,
        periods=0,
    )
    return block._replace(
        plan=plan, wanted=frozenset(wanted), samples=0, follow=False, reverse=False, begun=None, box=block.box[:1]
    )
