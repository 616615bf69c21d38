"""The page's kernel called from Python, in a memory that is laid out as a page does it (standalone/parts/kernel.js)."""

import ctypes
import math
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np

from vibro_sweep.standalone.kernel_arguments import layout_of
from vibro_sweep.standalone.kernel_module import object_of

LINE, RETURNED, PAGE = 64, 4096, 65536
C_TYPES = {"i": ctypes.c_int64, "b": ctypes.c_bool, "f": ctypes.c_double, "n": ctypes.c_void_p}


class Memory:
    """Arguments and arrays for so many of each size, from `base` on; `values` are those of scalars, by name."""

    def __init__(self, kind, sizes: dict[str, int], base: int):
        self.layout, self.base = layout_of(kind), base
        self.values, self.shapes, self.place = {}, {}, {}
        at = base + RETURNED
        for name, item, *shape in self.layout["arguments"]:
            if shape:
                lengths = [start + sum(by * sizes[size] for size, by in slope.items()) for start, slope in shape[0]]
                self.shapes[name], self.place[name] = lengths, (at, item)
                at += -(-max(math.prod(lengths) * item, 1) // LINE) * LINE
            else:
                self.values[name] = 0
        self.bytes = np.zeros(at - base, np.uint8)
        orbits, size = self.place["w.ensemble.orbits"]
        for lane in range(8):
            self.bytes[orbits - base + lane * size + self.layout["lane"] :][:8] = np.int64([lane]).view(np.uint8)

    def array(self, name: str, dtype=float, count: int = -1) -> np.ndarray:
        """A view of an array's memory."""
        at, item = self.place[name]
        count = math.prod(self.shapes[name]) * item // np.dtype(dtype).itemsize if count < 0 else count
        return np.frombuffer(self.bytes, dtype, count, at - self.base)

    def arguments(self) -> list[tuple[str, int | float]]:
        """Kind and value of each, pointers as p."""
        result = [("p", self.base), ("p", self.base + RETURNED // 2)]
        for name, item, *shape in self.layout["arguments"]:
            if not shape:
                result.append((item, float(self.values[name]) if item == "f" else int(self.values[name])))
                continue
            lengths = self.shapes[name]
            strides = [item * math.prod(lengths[axis + 1 :]) for axis in range(len(lengths))]
            result += [("n", 0), ("n", 0), ("i", math.prod(lengths)), ("i", item), ("p", self.place[name][0])]
            result += [("i", number) for number in (*lengths, *strides)]
        return result


class Module:
    """The kernel as a WebAssembly module, run by wasmtime."""

    def __init__(self, data: bytes):
        import wasmtime

        self.store = wasmtime.Store()
        module = wasmtime.Module(self.store.engine, data)
        self.memory = wasmtime.Memory(self.store, wasmtime.MemoryType(wasmtime.Limits(64, None)))
        exports = wasmtime.Instance(self.store, module, [self.memory]).exports(self.store)
        self.run = next(exports[name] for name in exports.keys() if name.startswith("_ZN"))
        self.base = -(-exports["__heap_base"].value(self.store) // LINE) * LINE

    def call(self, memory: Memory) -> None:
        missing = memory.base + len(memory.bytes) - self.memory.data_len(self.store)
        if missing > 0:
            self.memory.grow(self.store, -(-missing // PAGE))
        self.memory.write(self.store, memory.bytes.tobytes(), memory.base)
        assert self.run(self.store, *(value for _, value in memory.arguments())) == 0
        end = memory.base + len(memory.bytes)
        memory.bytes[:] = np.frombuffer(self.memory.read(self.store, memory.base, end), np.uint8)


class Native:
    """The same text as code of this machine, without fused multiply-adds and with the same library of functions."""

    base = 0

    def __init__(self, text: str, folder: Path):
        import llvmlite.binding as llvm

        llvm.initialize_all_targets()
        llvm.initialize_all_asmprinters()
        text = re.sub(r"\b(f(?:add|sub|mul|div|neg)) contract ", r"\1 ", text)
        here = llvm.Target.from_triple("x86_64-unknown-linux-musl")
        features = llvm.get_host_cpu_features().flatten()
        machine = here.create_target_machine(llvm.get_host_cpu_name(), features, 2, "pic", "small")
        code, entry = object_of(text, machine)
        (folder / "native.o").write_bytes(code)
        # Zig makes its static libraries when something is linked with them; sin and hypot lie in different ones
        call = "int main(int n, char **v) { return (int)(sin(n) + expm1(n) + hypot(n, n)); }\n"
        (folder / "main.c").write_text("#include <math.h>\n" + call)
        zig, cache = [sys.executable, "-m", "ziglang"], folder / "zig"
        environment = os.environ | {"ZIG_GLOBAL_CACHE_DIR": str(cache)}
        make = ["cc", "-target", "x86_64-linux-musl", "-static", "-fPIC", folder / "main.c", "-o", folder / "main"]
        subprocess.run([*zig, *make], check=True, env=environment, capture_output=True)
        libraries = [file for name in ("libc", "libzigc", "libcompiler_rt") for file in cache.rglob(f"{name}.a")]
        link = ["ld.lld", "-shared", "-Bsymbolic", folder / "native.o", "--start-group", *libraries, "--end-group"]
        link += ["--exclude-libs", "ALL", "-o", folder / "native.so"]
        subprocess.run([*zig, *link], check=True, env=environment, capture_output=True)
        self.run = ctypes.CDLL(str(folder.resolve() / "native.so"))[entry]

    def call(self, memory: Memory) -> None:
        room = np.zeros(len(memory.bytes) + LINE, np.uint8)
        room = room[-room.ctypes.data % LINE :][: len(memory.bytes)]
        room[:] = memory.bytes
        here = room.ctypes.data - memory.base
        values = [
            ctypes.c_void_p(value + here) if kind == "p" else C_TYPES[kind](value or None if kind == "n" else value)
            for kind, value in memory.arguments()
        ]
        assert self.run(*values) == 0
        memory.bytes[:] = room
