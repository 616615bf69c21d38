"""Kernels compiled as one with all that they call are the kernels that numba compiles by itself."""

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from support import path_with, small_kernel
from support.scene_texts import parsed

from vibro_sweep.driver import blocks, code_hash, compute
from vibro_sweep.engine.simd import jit

SCENE = """
system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8}
sweep:
  b: {values: [0.4, 1, 3, 6.68, 6.69, 6.8]}
start: {random: 3, seed: 1}
orbit: {transient: 2, record: 4}  # too short for chaos to enlarge what rounding does
observe: [section, lyapunov, impacts, attractors]
"""
UNTESTED = "import numba; numba.version_info = numba.version_info._replace(short=(0, 99));"
PLAIN = UNTESTED + "import sys, test_jit; test_jit.save(sys.argv[1])"
HERE = Path(__file__).parent


def arrays():
    (block,) = blocks.blocks(parsed(SCENE), lambda: 100)
    return compute.compute(block)[1]


def save(path):
    assert not jit.AS_ONE
    np.savez(path, **arrays(), code_hash=code_hash.code_hash())


known = pytest.mark.skipif(not jit.IS_TESTED, reason="this numba compiles kernel by kernel, which takes longer")


def test_this_numba_is_known():
    """Else a first run would take five times as long, and nobody would know why: a new version of numba is to be tried,
    and then stands in TESTED."""
    assert jit.IS_TESTED and jit.AS_ONE


@known
def test_a_compilation_within_another_one_leaves_it_lean():
    """Callees compile while their callers do; else all kernels but the innermost would take a tenth longer."""
    from numba.core.postproc import PostProcessor

    from vibro_sweep.engine.simd.numba_patches import patched

    own = PostProcessor.run
    with patched():
        instead = PostProcessor.run
        with patched():
            pass
        assert PostProcessor.run is instead is not own
    assert PostProcessor.run is own


@known
def test_a_small_kernel_with_all_that_large_ones_use():
    assert small_kernel.works(jit.kernel_of(small_kernel.kernel, jit.WholeCompiler))


@pytest.mark.slow
def test_an_untested_numba_compiles_plainly_and_says_so(tmp_path):
    program = UNTESTED + "import logging; logging.basicConfig(level=logging.INFO);"
    program += "from support import small_kernel; from vibro_sweep.engine.simd import jit;"
    program += "k = jit.exported(small_kernel.kernel); print(small_kernel.works(k), jit.AS_ONE, jit.IS_TESTED)"
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": path_with(HERE.parent)}
    done = subprocess.run([sys.executable, "-c", program], env=environment, check=True, capture_output=True, text=True)
    assert done.stdout.split() == ["True", "False", "False"]
    assert done.stderr.count("as long: tried were 0.62") == 1


@known
@pytest.mark.slow
def test_numba_by_itself_gives_the_same_numbers_but_for_rounding(tmp_path):
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "PYTHONPATH": path_with(HERE)}
    subprocess.run([sys.executable, "-c", PLAIN, tmp_path / "plain.npz"], env=environment, check=True)
    plain, whole = np.load(tmp_path / "plain.npz"), arrays()
    assert set(plain) == set(whole) | {"code_hash"}
    for name, values in whole.items():
        np.testing.assert_allclose(plain[name], values, rtol=1e-9, atol=1e-9, err_msg=name)
    assert str(plain["code_hash"]) != code_hash.code_hash()


def wander(records, times):
    """Fields, items, views and tuples that are made in one block and used in others, as kernels do it."""
    found, last, pair = 0.0, records[0].rows[-1], (0.0, 1.0)
    for i in range(times):
        o = records[i % len(records)]
        row = o.rows[i % 2]
        if i % 3 == 0:
            last, pair = row, (pair[1], found)
        for j in range(-1, 2):
            if row[j] > 4.0:
                break
            row[j] += 0.5
            found += o.rows[j % 2, j] * last[j] - pair[j % 2]
        o.total = found
    return found, records[-1].total, last[0], pair


@known
def test_values_that_are_kept_out_of_memory_are_those_of_python():
    dtype = np.dtype([("rows", float, (2, 3)), ("total", float)])
    one, other = (np.zeros(3, dtype).view(np.recarray) for _ in range(2))
    one.rows[:] = other.rows[:] = np.arange(18).reshape(3, 2, 3) / 4
    compiled = jit.kernel_of(wander, jit.WholeCompiler)(one, 20)
    assert compiled == wander(other, 20)
    assert one.tobytes() == other.tobytes()


@known
def test_names_of_kernels_do_not_hold_all_that_their_arguments_hold():
    """They stand wherever a kernel is called, and were most of what was compiled and kept."""

    def area(e):
        return e.sides[0].width * e.sides[0].height

    class Sides(NamedTuple):
        sides: np.ndarray

    others = [(f"a_number_that_is_not_needed_{i}", float) for i in range(99)]
    dtype = np.dtype([("width", float), ("height", float), *others])
    kernel = jit.kernel_of(area, jit.WholeCompiler)
    kernel(Sides(np.zeros(1, dtype)))
    assert max(map(len, re.findall(r"_ZN\w+", kernel.inspect_llvm(kernel.signatures[0])))) < 300
