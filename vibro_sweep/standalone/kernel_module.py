"""The page's kernel as a WebAssembly module: numba's LLVM compiles it, LLD of the package ziglang links it.

A published wheel has those of `SHIPPED` (tools/page_modules.py). Others are made in a process of their own
(`python -m vibro_sweep.standalone.kernel_module`), and kept beside the compiled kernels.
"""

import logging
import lzma
import re
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

import llvmlite.binding as llvm

from vibro_sweep.checks.errors import MachineError, MissingPackageError
from vibro_sweep.engine.records import Kind
from vibro_sweep.engine.simd import kernel_cache

FEATURES = "+simd128,+bulk-memory,+nontrapping-fptoint,+sign-ext"  # in all browsers since March 2023
STACK = 2**20  # bytes
OF_WHEEL = Path(__file__).parent / "modules"  # of a wheel
SHIPPED = ("1c", "2c", "3c", "1ck", "2ck", "3ck")  # kinds, by `kernel_name`
ENTRY = "run_page"
NEEDS = "page needs the package ziglang, which links its module: pip install 'vibro_sweep[page]'"

_log = logging.getLogger("vibro_sweep")


def module_of(kind: Kind) -> bytes:
    """The module for oscillators of this kind. Raises MissingPackageError, and MachineError where it cannot be made."""
    shipped = OF_WHEEL / shipped_name(kernel_name(kind))
    if shipped.exists():
        return lzma.decompress(shipped.read_bytes())
    folder = kernel_cache.FOLDER
    kept = None if folder is None else Path(folder, f"page_{kernel_name(kind)}.wasm")
    if kept is not None and kept.exists():
        return kept.read_bytes()
    if find_spec("ziglang") is None:
        raise MissingPackageError(NEEDS)
    _log.info("making the module of pages for this kind of machine, once: about half a minute of processor time")
    with tempfile.TemporaryDirectory(dir=folder) as space:
        made = Path(space, "page.wasm")
        command = [sys.executable, "-m", __name__, kernel_name(kind), str(made)]
        ended = subprocess.run(command, capture_output=True, text=True)
        if ended.returncode != 0:
            reason = ended.stderr.strip().rpartition("\n")[2] or f"exit status {ended.returncode}"
            raise MachineError(f"the module of a page could not be made here: {reason}")
        data = made.read_bytes()
        if kept is not None:
            made.replace(kept)
    return data


def shipped_name(name: str) -> str:
    """The file of a module in `OF_WHEEL`; the engine's sources are in its name, as another one has other modules."""
    return f"page_{name}_{kernel_cache.source_hash()}.wasm.xz"


def kernel_name(kind: Kind) -> str:
    """A kind as a part of a file's name: masses, then c for a constant force, and k for compliant stops."""
    return f"{kind.masses}{'c' * kind.constant}{'k' * kind.compliant}"


def kind_named(name: str) -> Kind:
    """The kind of which this is the name."""
    masses, rest = re.fullmatch(r"(\d+)(c?k?)", name).groups()
    return Kind(int(masses), "c" in rest, "k" in rest)


def kernel_text(kind: Kind) -> str:
    """The kernel as LLVM's text."""
    from vibro_sweep.engine.page_kernel import run_page
    from vibro_sweep.engine.simd.portable import text_of
    from vibro_sweep.standalone.kernel_arguments import SMALL, arguments_of

    return text_of(run_page, tuple(arguments_of(kind, SMALL).values()))


def object_of(text: str, machine: llvm.TargetMachine) -> tuple[bytes, str]:
    """Machine code, and the name of the entry: all else is internal."""
    text = re.sub(r"^target triple = .*$", f'target triple = "{machine.triple}"', text, flags=re.M)
    text = re.sub(r"^target datalayout = .*$", f'target datalayout = "{machine.target_data}"', text, flags=re.M)
    text = text.replace(" common ", " internal ").replace("@sqrt(", "@llvm.sqrt.f64(")  # a module has no common symbols
    module = llvm.parse_assembly(text)
    made = [function for function in module.functions if not function.is_declaration]
    [entry] = [one.name for one in made if f"{len(ENTRY)}{ENTRY}" in one.name and "7cpython" not in one.name]
    for function in made:
        if function.name != entry:
            function.linkage = "internal"  # and goes where nothing calls it, as the wrapper for Python
    tuning = llvm.create_pipeline_tuning_options(speed_level=2)
    tuning.loop_vectorization = tuning.slp_vectorization = False  # the code is vectors already
    passes = llvm.create_pass_builder(machine, tuning)
    passes.getModulePassManager().run(module, passes)
    return machine.emit_object(module), entry


def link(code: Path, entry: str, module: Path) -> None:
    """The module of an object file, with the functions of a C library that it calls. Its memory comes from the page."""
    flags = [f"--export={entry}", "--export=__heap_base", "--import-memory", "--strip-all", "--gc-sections"]
    flags = [f"-Wl,{flag}" for flag in [*flags, "--stack", str(STACK)]]
    zig = [sys.executable, "-m", "ziglang", "cc", "-target", "wasm32-wasi", "-mexec-model=reactor", "-O2"]
    subprocess.run([*zig, *flags, str(code), "-o", str(module)], check=True, capture_output=True, text=True)


def make(text: str, module: Path) -> None:
    """Write the module of a kernel's text."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    wasm = llvm.Target.from_triple("wasm32-unknown-unknown")
    data, entry = object_of(text, wasm.create_target_machine(features=FEATURES, opt=2, reloc="static"))
    code = module.with_suffix(".o")
    code.write_bytes(data)
    link(code, entry, module)


if __name__ == "__main__":
    make(kernel_text(kind_named(sys.argv[1])), Path(sys.argv[2]))
