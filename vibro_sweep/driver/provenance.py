"""By what a file was made: versions and the processor, as one JSON record."""

import platform
from importlib.metadata import version
from pathlib import Path

from vibro_sweep import __version__
from vibro_sweep.driver import code_hash

PACKAGES = ("numpy", "numba", "llvmlite", "h5py")


def provenance() -> dict:
    """The record; runs with equal `code` give equal numbers."""
    return {
        "vibro_sweep": __version__,
        "code": code_hash.code_hash(),
        "python": platform.python_version(),
        **{name: version(name) for name in PACKAGES},
        "cpu": _cpu_name(),
    }


def _cpu_name() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()
