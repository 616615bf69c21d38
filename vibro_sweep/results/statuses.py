"""Which orbits of a sweep are computed."""

import numpy as np

from vibro_sweep.results.boxes import Box
from vibro_sweep.tables.outcomes import NOT_COMPUTED


class Statuses:
    """Of a sweep that is being computed."""

    status: np.ndarray  # of all orbits, of the shape of the sweep

    def missing(self, box: Box) -> bool:
        """Whether an orbit in a box of the sweep is not computed yet."""
        return bool((self.status[box] == NOT_COMPUTED).any())

    def done(self) -> int:
        """Orbits computed so far."""
        return int(np.count_nonzero(self.status != NOT_COMPUTED))
