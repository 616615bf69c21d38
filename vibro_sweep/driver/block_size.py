"""How many points a block has: few at first, and more by what the last ones took."""

import math

from vibro_sweep.driver.blocks import Block
from vibro_sweep.driver.memory_needed import orbits_per_block
from vibro_sweep.engine.simd.lanes import LANES
from vibro_sweep.scene import Scene

GROWTH = 4  # times as many points as the last block has the next one at most
PER_WORKER = 8  # blocks at least, so that workers end together


class BlockSize:
    """A number of points that is called for each block, and learns from those that are computed."""

    def __init__(self, scene: Scene, missing: int, workers: int, seconds: float, fixed: int | None):
        """missing : orbits. seconds : that a block takes at most, but the first ones. asked : a fixed number instead;
        fewer where memory is short."""
        starts = 1 if scene.start.kind == "follow" else scene.n_starts  # orbits of a point in one block
        by_memory, fair = orbits_per_block(scene, workers) / starts, missing / starts / (PER_WORKER * workers)
        self.most = max(1, int(min(by_memory, fixed or fair)))
        self.least = self.most if fixed else min(self.most, max(1, LANES // starts))
        self.points, self.seconds = self.least, seconds

    def __call__(self) -> int:
        return self.points - (self.points % LANES if self.points > LANES else 0)  # so many orbits are computed at once

    def learn(self, block: Block, seconds: float) -> None:
        """A block has taken so many seconds."""
        points = math.prod(len(values) for values in block.axes.values())
        by_time = int(points * self.seconds / max(seconds, 1e-9))
        self.points = max(self.least, min(by_time, GROWTH * self.points, self.most))
