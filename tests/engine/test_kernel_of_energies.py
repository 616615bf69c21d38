"""The kernel of energies is compiled once."""

import vibro_sweep as vs
from vibro_sweep.engine.energy import run_energy

PAPER = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=5.0)


def test_sweeps_of_any_kind_are_computed_by_one_kernel():
    """Of contiguous arrays alone: it was compiled anew where the points come in reverse."""
    for start in ((0, 0, 0, 0), {"follow": "both"}, {"random": 2, "seed": 1}):
        vs.sweep(PAPER, {"b": [4.9, 5.0]}, observe=("energy",), start=start, transient=30, record=20)
    assert {kind.layout for kinds in run_energy._whole.signatures for kind in kinds if hasattr(kind, "layout")} == {"C"}
