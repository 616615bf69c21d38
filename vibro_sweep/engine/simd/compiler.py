"""numba's compiler, changed so that a first run takes half as long.

By itself numba optimises each kernel, turns it into machine code, and does all of that again with what it calls, in
every kernel that calls it. Here that is done once: for an exported kernel, together with all that it reaches.

This depends on internals of numba 0.68; the import fails where they are missing.
"""

import gc

import numba
from llvmlite.binding import Linkage, parse_assembly, set_option
from numba.core.codegen import CPUCodegen, JITCodeLibrary
from numba.core.compiler import Compiler, Flags

from vibro_sweep.engine import simd
from vibro_sweep.engine.halting import heard
from vibro_sweep.engine.simd import kernel_cache

NEEDED = {JITCodeLibrary: "_optimize_functions", CPUCodegen: "_module_pass_manager", Flags(): "_values"}
if not all(hasattr(where, name) for where, name in NEEDED.items()):
    raise ImportError(f"numba {numba.__version__} lacks internals that compiler.py needs")

# Passes for what kernels do not hold: closures, array expressions, literal arguments; and inlining, which LLVM does.
SPARED = frozenset(
    "with_lifting inline_closure_likes inline_inlinables find_literally literal_unroll LiteralPropagation "
    "inline_overloads nopython_rewrites annotate_types".split()
)


def _patches():
    """The patches of numba (numba_patches.py), imported when there is something to compile: it takes 0.1 s."""
    from vibro_sweep.engine.simd import numba_patches

    return numba_patches


class LinkError(RuntimeError):
    """A kernel that another one calls was not linked with it."""


class _Part(JITCodeLibrary):
    """A kernel that only kernels call: code to be linked, and not yet optimised."""

    def _optimize_functions(self, ll_module):
        ll_module.data_layout = self._codegen._data_layout
        for function in ll_module.functions:
            if not function.is_declaration:
                passes, builder = self._codegen._function_pass_manager(opt=1)
                passes.run(function, builder)

    def finalize(self):
        self._finalized = True

    def _get_module_for_linking(self):
        """Weak, where numba itself has `linkonce_odr`: of such LLVM links only what is referred to at that moment."""
        if self._shared_module is None:
            self._shared_module = _relinked(self._final_module.clone(), Linkage.external, "weak_odr")
        return self._shared_module


def _relinked(module, before, after):
    """The module, whose functions of the one linkage get the other."""
    for function in module.functions:
        if not function.is_declaration and function.linkage == before:
            function.linkage = after
    return module


class _Marked(_Part):
    """A part whose functions have an attribute of LLVM's."""

    attribute: str

    def add_ir_module(self, ir_module):
        for function in ir_module.functions:
            if not function.is_declaration:
                function.attributes.add(self.attribute)
        super().add_ir_module(ir_module)


class _NoInline(_Marked):
    """A part that stays a call: inlined, it would take registers and room from the hot path."""

    attribute = "noinline"


class _Small(_Marked):
    """A part that is compiled for its size: loops stay loops, of which LLVM makes half as much code."""

    attribute = "optsize"


class _Whole(JITCodeLibrary):
    """An exported kernel, with all parts that it reaches."""

    level = 2  # of LLVM's passes

    def add_linking_library(self, library):
        if library not in self._linking_libraries:
            super().add_linking_library(library)
            for other in library._linking_libraries:
                self.add_linking_library(other)

    def _optimize_final_module(self):
        """Optimise the module without functions that are unused, or used only where they were inlined."""
        _relinked(self._final_module, Linkage.weak_odr, "linkonce_odr")
        self._optimize()
        lost = [f.name for f in self._final_module.functions if f.is_declaration and f.name.startswith("_ZN")]
        if lost:  # a call of it would go nowhere
            raise LinkError(f"{self.name} refers to {', '.join(lost)}")

    def _optimize(self):
        """Once, and without LLVM's vectorisers: kernels are vectors already."""
        if self.name in kernel_cache.PURPOSES:
            simd.FREE.set()
        options = {"opt": self.level, "loop_vectorize": False, "slp_vectorize": False}
        passes, builder = self._codegen._module_pass_manager(**options)
        passes.run(self._final_module, builder)

    def _get_module_for_linking(self):
        """The names alone: an exported kernel is linked with nothing, and reading its code again takes 30 ms."""
        if self._shared_module is None:
            functions = (f for f in self._final_module.functions if not f.is_declaration)
            names = (f'define void @"{f.name}"() {{ ret void }}' for f in functions if f.linkage == Linkage.external)
            self._shared_module = parse_assembly("\n".join(names))
        return self._shared_module

    def _finalize_specific(self):
        """Machine code. Where a loop lies across the lines that are fetched depends on all before it, and takes 5 %."""
        set_option("vibro_sweep", "-align-loops=64")
        set_option("vibro_sweep", "-align-all-functions=6")
        try:
            super()._finalize_specific()
        finally:
            set_option("vibro_sweep", "-align-loops=0")
            set_option("vibro_sweep", "-align-all-functions=0")


class _Quick(_Whole):
    """An exported kernel of hundreds of parts: with fewer passes that of all continuation is as fast, and a first orbit
    waits an eighth less for it."""

    level = 1


class CapturedTextError(Exception):
    """A kernel with all parts that it reaches, as LLVM's text (portable.py)."""

    def __init__(self, text: str):
        super().__init__("a kernel as text")
        self.text = text


class _AsText(_Whole):
    """An exported kernel that becomes text in place of machine code."""

    def _optimize(self):
        raise CapturedTextError(str(self._final_module))


def leave_functions_as_they_are() -> None:
    """From here on no pass computes with the sizes of this machine's pointers before a kernel is linked."""
    _Part._optimize_functions = _Whole._optimize_functions = lambda self, ll_module: None


def _keep_what_is_there() -> None:
    """Move what compiling leaves to where the garbage collector looks last or never; else collecting takes as long
    again."""
    if simd.OWN_PROCESS:
        gc.freeze()
    elif gc.get_freeze_count() == 0:  # else what others have frozen would be so no more
        gc.freeze()
        gc.unfreeze()


ROOM = 2**16  # words


def _with_room(function):
    """The function, below whose frame there is room for those of all that it calls.

    CPython keeps frames in pieces of 16 kB, and gives the last one back whenever its only frame ends: a loop that calls
    from the end of a piece asks for memory in each turn. Numba's compiler did so 10^5 times, which took a tenth of its
    time. A frame that is said to need half a megabyte gets a piece of twice that.
    """
    function.__code__ = function.__code__.replace(co_stacksize=ROOM)
    return function


class _Flags(Flags):
    """Compared as a whole: numba goes through them whenever it looks for a function, tens of thousands of times."""

    __slots__ = ()

    def __eq__(self, other):
        return isinstance(other, _Flags) and self._values == other._values

    def __hash__(self):
        return len(self._values)


_pipelines: list = []


def _passes_needed(passes):
    """The passes but those spared, and but the search for dead branches in what a spared one would have inlined."""
    spared = False
    for step, why in passes:
        name = step.name()
        if name not in SPARED and not (spared and name == "dead_branch_prune"):
            yield step, why
        spared = name in SPARED


class WholeCompiler(Compiler):
    """The compiler of an exported kernel."""

    library = _Whole

    def __init__(self, typingctx, targetctx, library, args, return_type, flags, locals):
        targetctx.load_additional_registries()  # once: for kernels that this one calls, a patched compiler does not
        with _patches().patched():
            super().__init__(typingctx, targetctx, library, args, return_type, _Flags(flags), locals)
        # Wherever an array is used, numba asks for a function "__array__" that there is not, and loads all registries
        # to ask once more.
        context = self.state.targetctx
        ask = context.get_function
        context.get_function = lambda fn, sig, _firstcall=True: ask(fn, sig, _firstcall and not isinstance(fn, str))
        _patches().remember_sizes(context)

    def define_pipelines(self):
        """The passes, chosen once for all kernels."""
        if not _pipelines:
            [pipeline] = super().define_pipelines()
            pipeline.passes = list(_passes_needed(pipeline.passes))
            pipeline.finalize()
            _pipelines.append(pipeline)
        return _pipelines

    @_with_room
    def compile_extra(self, func):
        self.state.library = self.library(self.state.targetctx.codegen(), func.__qualname__)
        self.state.library.enable_object_caching()
        collecting = gc.isenabled()
        gc.disable()  # a tenth of the time, and there is little to collect
        try:
            with _patches().patched(), heard():
                return super().compile_extra(func)
        finally:
            if collecting:
                _keep_what_is_there()
                gc.enable()


class QuickCompiler(WholeCompiler):
    """The compiler of an exported kernel with hundreds of parts."""

    library = _Quick


class TextCompiler(WholeCompiler):
    """The compiler of a kernel that is wanted as text: it raises `CapturedText`."""

    library = _AsText


class PartCompiler(WholeCompiler):
    """The compiler of a kernel that only kernels call."""

    library = _Part

    def __init__(self, *args):
        super().__init__(*args)
        # There is nothing for Python to call; numba still wants something callable to know the kernel by.
        self.state.targetctx.get_executable = lambda library, fndesc, env: [].append


class NoInlineCompiler(PartCompiler):
    """The compiler of a kernel that only kernels call and that is never inlined."""

    library = _NoInline


class SmallCompiler(PartCompiler):
    """The compiler of a kernel that only kernels call and in which they spend little time."""

    library = _Small
