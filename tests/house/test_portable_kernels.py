"""What the kernels of sweeps call: of a C library six functions, so that they can run where there is no other.

What Python's wrapper of a kernel calls is not counted; nor is what a linker fills in or moves memory with, which every
compiler brings. Symbols are those of the machine code in the cache of kernels.
"""

import re
import struct
from pathlib import Path

import pytest

import vibro_sweep as vs
from vibro_sweep.engine.simd import kernel_cache

SIX = {"sin", "cos", "exp", "log", "expm1", "hypot"}
COMPILERS = {"sincos", "memset", "memcpy", "memmove"}  # sincos is sin and cos of one angle
WRAPPER = re.compile(r"_?Py|numba_")
RIGID = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=3)
SOFT = vs.Oscillator([[1, 0], [0, 2]], [[2, -1], [-1, 2]], [[0.2, 0], [0, 0.1]], contact_normal=[1, 0], force=[1, 0],
                     omega=0.8, b=0.5, k_stop=50.0, c_stop=1.0, release="force")  # fmt: skip


def undefined(code: bytes) -> set[str]:
    """Symbols that an object file (ELF, 64 bits) asks for."""
    (headers,), (size, count) = struct.unpack_from("<Q", code, 0x28), struct.unpack_from("<HH", code, 0x3A)
    sections = [struct.unpack_from("<IIQQQQIIQQ", code, headers + i * size) for i in range(count)]
    found = set()
    for _, kind, _, _, begin, length, names, *_ in sections:
        for place in range(begin, begin + length if kind == 2 else begin, 24):
            name, _, _, section, _, _ = struct.unpack_from("<IBBHQQ", code, place)
            if name and section == 0:
                first = sections[names][4] + name
                found.add(code[first : code.index(b"\0", first)].decode())
    return found


@pytest.mark.parametrize("kernel", ["run_points", "set_plain_points"])
def test_they_call_few_functions_of_the_c_library(kernel):
    for system in (RIGID, SOFT):
        vs.sweep(system, {"b": [3.0, 3.1]}, transient=20, record=20, observe=["section", "lyapunov", "impacts"])
    files = [path for path in Path(kernel_cache.FOLDER).rglob("*.nbc") if f".{kernel}-" in path.name]
    assert len(files) >= (2 if kernel == "run_points" else 1)
    for path in files:
        data = path.read_bytes()
        asked = {name for name in undefined(data[data.index(b"\x7fELF") :]) if not WRAPPER.match(name)}
        assert asked >= {"sin"} or asked >= {"sincos"}, "the symbols of another file"
        assert asked - COMPILERS <= SIX, path.name
