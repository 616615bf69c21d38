"""`observe: [energy]`: the orbits of a block over their records once more (engine/energy.py)."""

import numpy as np

from vibro_sweep.driver.blocks import Block
from vibro_sweep.engine import orbit_block
from vibro_sweep.engine.records import Kind
from vibro_sweep.oscillator.grid import linears
from vibro_sweep.oscillator.stacks import dot, solved
from vibro_sweep.tables import outcomes as status
from vibro_sweep.tables.coordinates import state


def energies_of(block: Block, steps: np.ndarray, kind: Kind, results: np.ndarray) -> dict[str, np.ndarray]:
    """The energies by dataset name, each of the shape of `steps` (n, m)."""
    from vibro_sweep.engine.energy import run_energy
    from vibro_sweep.engine.motion.energy_sums import sums_of

    shape, states = steps.shape, 2 * kind.masses
    systems = steps.reshape(-1)
    begins, resting, relaxed = (
        np.ascontiguousarray(results[name].reshape(len(systems), *results[name].shape[2:]))
        for name in ("begin", "begin_resting", "begin_relaxed")
    )
    begins = at_contact(systems, begins, resting)
    outcome = np.where(status.is_valid(results["status"]), status.NOT_COMPUTED, results["status"]).reshape(-1)
    plan = block.plan._replace(states=False, lyapunov=False, impacts=False, attractors=False, section_side=0.0)
    plan = plan._replace(warm_up=0, parts=0, periods=0, record=1, settle=0)
    workspace = orbit_block.new_workspace(plan, int(steps["cells"].max()), 0, kind)
    wanted = {
        "loss": np.zeros(len(systems)),
        "squares": np.zeros((len(systems), states)),
        "peaks": np.zeros((len(systems), states)),
    }
    sums = np.zeros(len(systems), sums_of(kind.masses))
    sums["back"], sums["origin"] = systems["back"], systems["origin"]
    run_energy(
        systems, begins, resting, relaxed, block.plan.record, workspace, plan, sums, wanted["loss"],
        wanted["squares"], wanted["peaks"], outcome,
    )  # fmt: skip
    known = np.where(status.is_valid(outcome), 1.0, np.nan)
    time = block.plan.record * 2 * np.pi / systems["omega"]
    named = {"impact_power": known * _contact_masses(block, shape).reshape(-1) * wanted["loss"] / time}
    for i, name in enumerate(state(kind.masses)):
        named[f"rms_{name}"] = known * np.sqrt(wanted["squares"][:, i] / time)
        named[f"peak_{name}"] = known * wanted["peaks"][:, i]
    return {name: values.reshape(shape) for name, values in named.items()}


def _contact_masses(block: Block, shape: tuple[int, int]) -> np.ndarray:
    """1/(n^T M^-1 n) of each point, of the shape of the steps."""
    q = linears(block.system, block.axes)
    masses = 1 / dot(q.contact.normal, solved(q.M, q.contact.normal))
    if block.follow:
        return masses.reshape(len(masses), -1)[:: -1 if block.reverse else 1]
    return np.repeat(masses.reshape(1, -1), shape[1] // masses.size, axis=1)


def at_contact(table: np.ndarray, ends: np.ndarray, resting: np.ndarray) -> np.ndarray:
    """States (..., 2 N) of the masses in contact coordinates, none behind a rigid stop, and at one where they rest."""
    ends = np.array(ends)
    ends[..., 0::2] -= table["origin"]
    pairs = ends.reshape(*ends.shape[:-1], -1, 2)
    ends = np.einsum("...ij,...jk->...ik", table["P"], pairs).reshape(ends.shape)
    low, high = table["stops"][..., 0], table["stops"][..., 1]
    if "contact_law" in table.dtype.names:
        low, high = (
            np.where(table["contact_law"][..., n, 0] > 0, np.inf * (2 * n - 1), wall)
            for n, wall in enumerate((low, high))
        )
        resting = np.where(np.isinf(np.where(resting > 0, high, low)), 0, resting)
    ends[..., 0] = np.where(resting > 0, high, np.where(resting < 0, low, np.clip(ends[..., 0], low, high)))
    ends[..., 1] = np.where(resting == 0, ends[..., 1], 0.0)
    return ends
