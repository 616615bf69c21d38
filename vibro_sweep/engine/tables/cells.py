"""How many cells the forcing period is cut into."""

import math

import numpy as np

from vibro_sweep.engine.tables.flight import WIDTH

LEAST_CELLS = 24
MOST_CELLS = 16384
STIFF_CELLS = 2048
LONGEST = 1e7  # the fastest rate times the period beyond which a system is refused: two seconds of work at worst


@np.errstate(all="ignore")
def cells_for(rate: np.ndarray, omega: np.ndarray) -> np.ndarray:
    """Cells for which the fastest rate of a system times the cell width is at most `WIDTH`; rate and omega: (...).

    `STIFF_CELLS` where that would be too many, 0 where the rates are too far apart altogether.
    """
    turns = 2 * math.pi * np.maximum(rate / omega, 1.0)
    turns = np.where(turns <= LONGEST, turns, np.inf)  # also where they are not a number
    cells = np.maximum(LEAST_CELLS, 8 * np.ceil(np.minimum(turns, LONGEST) / WIDTH / 8)).astype(np.int64)
    return np.where(turns > LONGEST, 0, np.where(cells > MOST_CELLS, STIFF_CELLS, cells))
