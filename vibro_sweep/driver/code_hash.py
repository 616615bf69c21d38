"""A hash of all that numbers depend on: equal hashes give equal numbers.

Files and workers are compared by it. The folder of compiled kernels is named by the engine's sources alone
(engine/simd/kernel_cache.py), so that other edits compile nothing anew.
"""

import functools
import hashlib
import platform
from importlib.metadata import version
from pathlib import Path

from numba.core import config
from numba.core.codegen import get_host_cpu_features
from threadpoolctl import threadpool_info

from vibro_sweep.engine.simd import jit

HOME = Path(__file__).parents[1]

# All modules that a scene's text passes through to become numbers; what moves, stores or shows these is left out.
SOURCES = (
    "checks",
    "tables",
    "oscillator",
    "engine",
    "analysis",
    "scene",
    "results",
    "driver/blocks.py",
    "driver/compute.py",
    "driver/energy_columns.py",
    "driver/drawn_starts.py",
    "driver/trajectories.py",
    "driver/attractor_ids.py",
)
LIBRARIES = ("numpy", "numba", "llvmlite")


def sources() -> list[Path]:
    """The modules that numbers depend on."""
    entries = (HOME / name for name in SOURCES)
    return sorted(path for entry in entries for path in (entry.rglob("*.py") if entry.is_dir() else [entry]))


@functools.cache  # of the sources as they were imported
def code_hash() -> str:
    """A hash of the sources that numbers depend on, of the libraries that compute them and of how kernels compile.

    The processor is part of it where last digits depend on it: a product and a sum are rounded once where it has fused
    multiply-adds, twice elsewhere, and BLAS, which makes the tables of general oscillators, adds in another order.
    """
    digest = hashlib.sha256()
    for path in sources():
        digest.update(path.relative_to(HOME).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    digest.update(
        repr([*(version(name) for name in LIBRARIES), jit.AS_ONE, has_fused_multiply_add(), blas_kernels()]).encode()
    )
    return digest.hexdigest()[:16]


def has_fused_multiply_add() -> bool:
    """Whether kernels are compiled with fused multiply-adds; what `NUMBA_CPU_FEATURES` says counts."""
    if platform.machine().lower() in ("aarch64", "arm64"):
        return True
    features = get_host_cpu_features() if config.CPU_FEATURES is None else config.CPU_FEATURES
    return "+fma" in features.split(",")


def blas_kernels() -> list[str]:
    """The processors that NumPy's BLAS computes for, as "Haswell"; the variable OPENBLAS_CORETYPE chooses another."""
    libraries = threadpool_info()
    return sorted({x["architecture"] for x in libraries if x["user_api"] == "blas" and "architecture" in x})
