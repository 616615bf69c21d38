"""A trajectory that fails."""

import numpy as np
from support.oscillators import PAPER_NUMBERS
from support.scene_texts import parsed

from vibro_sweep.analysis.single.tables import table_of
from vibro_sweep.driver import blocks
from vibro_sweep.engine import orbit_block
from vibro_sweep.engine.records import new_results
from vibro_sweep.engine.trajectory import new_trajectories, run_trajectories


def test_it_says_nothing():
    """Its status says what went wrong; neither zeros nor what came before look like results."""
    text = f"system: {{{PAPER_NUMBERS}, b: 6.6}}\norbit: {{transient: 0, record: 1}}\n"
    text += "trajectory: {periods: 2, samples: 5}"
    (block,) = blocks.blocks(parsed(text), lambda: 1)
    table, kind, _ = table_of(block.system, block.axes, frames=False)
    results, kept = new_results((1, 1)), new_trajectories((1, 1), 5, 2, 5)
    results["status"], results["end"], results["resting"] = 0, (0.0, np.inf, 0.0, 0.0), 0.0
    workspace = orbit_block.new_workspace(block.plan, int(table["cells"]), 5, kind)
    run_trajectories(table.reshape(1), results, np.empty((1, 5, 7)), kept, workspace, block.plan)
    assert results["status"] > 0 and kept.counts == -1
    for values in kept[:3]:
        assert np.isnan(values).all()
