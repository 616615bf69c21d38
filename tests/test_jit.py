"""Kernels compiled as one with all that they call are the kernels that numba compiles by itself."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from vibro_sweep import blocks, compute
from vibro_sweep.kernels import jit
from vibro_sweep.scene import parse_scene

SCENE = """
system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8}
sweep:
  b: {values: [0.4, 1, 3, 6.68, 6.69, 6.8]}
start: {random: 3, seed: 1}
orbit: {transient: 100, record: 50}
observe: [section, lyapunov, impacts, attractors]
"""
PLAIN = "import sys; sys.modules['vibro_sweep.kernels.compiler'] = None; import test_jit; test_jit.save(sys.argv[1])"


def arrays():
    (block,) = blocks.blocks(parse_scene(SCENE), points_per_block=100)
    return compute.compute(block)[1]


def save(path):
    assert jit.WholeCompiler is None
    np.savez(path, **arrays())


def test_this_numba_is_known():
    """Else a first run would take twice as long, and nobody would know why."""
    assert jit.WholeCompiler is not None


@pytest.mark.slow
def test_numba_by_itself_gives_the_same_bits(tmp_path):
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": str(Path(__file__).parent)}
    subprocess.run([sys.executable, "-c", PLAIN, tmp_path / "plain.npz"], env=environment, check=True)
    plain, whole = np.load(tmp_path / "plain.npz"), arrays()
    assert set(plain) == set(whole)
    for name, values in whole.items():
        assert plain[name].tobytes() == np.ascontiguousarray(values).tobytes(), name
