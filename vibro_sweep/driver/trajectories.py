"""The motion of a block's orbits after their last section point."""

import numpy as np

from vibro_sweep.driver.blocks import Block
from vibro_sweep.driver.energy_columns import at_contact
from vibro_sweep.engine.orbit_block import Workspace
from vibro_sweep.tables.coordinates import state
from vibro_sweep.tables.observables import of_an_impact

ROOM = 4096  # impacts there is room for at first


def trajectories_of(
    block: Block,
    table: np.ndarray,
    results: np.ndarray,
    workspace: Workspace,
    lead: tuple[int, ...],
    starts: np.ndarray | None = None,
) -> dict[str, np.ndarray]:
    """The trajectories by dataset name; compiled only for scenes that ask for them.

    table, results : as of `_compute`; starts : (points, starts, 2 N) of trajectories from t = 0, else they begin where
    the orbits ended
    """
    from vibro_sweep.engine.trajectory import new_trajectories, run_trajectories

    states, shape = 2 * block.system.masses, results.shape
    kept = new_trajectories(shape, block.samples, block.plan.periods, block.samples, block.system.masses)
    room, most, begins = 0, ROOM, results.copy()
    if starts is not None:
        begins["end"], begins["resting"], begins["relaxed"] = starts, 0, 0
    begins["end"] = at_contact(table.reshape(-1, 1), begins["end"], begins["resting"])
    while most > room:
        room = most
        run_trajectories(table.reshape(-1), begins, np.empty((1, room, states + 3)), kept, workspace, block.plan)
        most = kept.counts.max()
    results["status"] = begins["status"]
    samples, sections, impacts = _of_the_masses(block, table.reshape(-1), kept)
    gap = not block.system.gap_is_x1
    named = dict(zip(of_an_impact(states // 2, gap), np.moveaxis(impacts, -1, 0), strict=True))
    named["trajectory_impact_side"] = np.nan_to_num(named["trajectory_impact_side"]).astype(np.int8)
    named |= {f"trajectory_{name}": samples[..., i] for i, name in enumerate(state(states // 2))}
    named |= {f"trajectory_section_{name}": sections[..., i] for i, name in enumerate(state(states // 2))}
    named["trajectory_impacts"] = kept.counts
    return {name: values.reshape(lead + values.shape[2:]) for name, values in named.items()}


def _of_the_masses(block: Block, points: np.ndarray, kept) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Samples, sections and impacts of the masses, from those in contact coordinates.

    Of an impact: time, side, velocity of the gap before and after; then the state before, without x1 and v1 where these
    are the gap and its velocity.
    """
    back = points["back"]  # (p, N, N)

    def turned(values):  # (p, s, n, 2 N)
        pairs = values.reshape(*values.shape[:-1], -1, 2)
        masses = np.einsum("pij,psnjk->psnik", back, pairs)
        masses[..., 0] += points["origin"][:, None, None]
        return masses.reshape(values.shape)

    side = kept.impacts[..., 1]
    stops = points["stops"][:, None, None]
    stop = np.where(side > 0, stops[..., 1], stops[..., 0])
    before = np.concatenate([stop[..., None], kept.impacts[..., 2:3], kept.impacts[..., 4:]], axis=-1)
    velocities = turned(before)[..., 2 if block.system.gap_is_x1 else 0 :]
    return turned(kept.samples), turned(kept.sections), np.concatenate([kept.impacts[..., :4], velocities], axis=-1)
