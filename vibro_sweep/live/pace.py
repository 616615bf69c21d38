"""How long columns take, measured on those that are computed: from this follows how many are computed at once."""

import math

from vibro_sweep.driver.blocks import Block
from vibro_sweep.engine.simd.lanes import LANES

FIXED = 0.001  # seconds that a frame takes beside its columns
FEWEST = 2 * LANES  # columns in a piece, so that lanes are filled
COARSEST = 64  # columns in a preview, also where they take longer than they should
UNKNOWN = 16  # pieces where nothing is known
MOST_PIECES = 64
KEPT = 64  # rates


class Pace:
    """Seconds that a column takes, by the kind of sweep that it belongs to: the last measured ones."""

    def __init__(self) -> None:
        self._seconds: dict[tuple, float] = {}

    def measured(self, block: Block, columns: int, seconds: float) -> None:
        """Remember how long so many columns of a block took."""
        key = _kind(block)
        self._seconds.pop(key, None)
        self._seconds[key] = max(seconds - FIXED, seconds / 4) / columns
        if len(self._seconds) > KEPT:
            del self._seconds[next(iter(self._seconds))]

    def step(self, block: Block, columns: int, seconds: float) -> int:
        """Every how many-th of a block's columns is computed, so that there are at most `columns`, in these seconds."""
        rate = self._seconds.get(_kind(block))
        if rate:
            columns = min(columns, max(COARSEST, int((seconds - FIXED) / rate)))
        return max(1, math.ceil(_columns(block) / columns))

    def pieces(self, block: Block, seconds: float) -> int:
        """Into how many pieces a block is cut, so that each takes such a time: a power of two."""
        rate, columns = self._seconds.get(_kind(block)), _columns(block)
        wanted = UNKNOWN if rate is None else max(1.0, rate * columns / seconds)
        most = max(1, min(MOST_PIECES, columns // FEWEST))
        return 2 ** min(round(math.log2(wanted)), math.floor(math.log2(most)))


def _columns(block: Block) -> int:
    return len(next(iter(block.axes.values())))


def _kind(block: Block) -> tuple:
    """What blocks have in common whose columns take a like time."""
    each = block.part.stop - block.part.start
    return (block.system.model.name, block.system.masses, *block.axes, block.plan, block.wanted, each, block.follow)
