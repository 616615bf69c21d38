"""What commands that compute a file have in common: where it may go, how to continue it, progress, what is printed."""

import shlex
import threading
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from vibro_sweep.engine import simd
from vibro_sweep.tables.units import Display

from . import interrupt
from .console import InputError, all_is_imported, input_errors, messages, say
from .options import executor_of

FIRST, LAST = 40, 12  # lines that are printed of a long table


@dataclass(frozen=True)
class Computation:
    """A file to be computed, and how the command line says that it should be."""

    output: Path
    workers: int | None
    scheduler: str | None
    resume: bool
    overwrite: bool
    plot: bool
    quiet: bool
    command: tuple[str, ...]  # its own words: name, source, options that no other command has

    @property
    def mode(self) -> str:
        return "resume" if self.resume else "overwrite" if self.overwrite else "new"

    @cached_property
    def picture(self) -> Path | None:
        """Drawn at the end, next to the file."""
        if not self.plot:
            return None
        from vibro_sweep.plotting.picture_files import default_name

        return self.output.with_name(default_name(self.output))

    def advice(self, option: str) -> str:
        """The advice on what to type after an interruption."""
        again = ["vibro-sweep", *self.command, "-o", str(self.output)]
        again += ["--scheduler", self.scheduler] if self.scheduler else []
        again += ["--workers", str(self.workers)] if self.workers and not self.scheduler else []
        return f"to continue: {shlex.join([*again, *(['--plot'] if self.plot else []), option])}"

    def announce(self) -> None:
        """Say from now on how to continue. Raises InputError where options exclude each other."""
        if self.resume and self.overwrite:
            raise InputError("--resume and --overwrite exclude each other: continue the old file or replace it")
        # until the run has begun, what is to be overwritten is there, and would be taken for its result
        interrupt.advise(self.advice("--overwrite" if self.overwrite else "--resume"))

    def check_outputs(self, inputs: Collection[Path]) -> None:
        """Raises InputError where something is in the way. inputs : files that are read, and must not be written."""
        from vibro_sweep.files.file_errors import StoreError

        from .outputs import check_output

        with input_errors(StoreError):
            check_output(self.output, inputs, self.picture, self.mode)

    @contextmanager
    def under_way(self, *errors: type[Exception]) -> Iterator[tuple]:
        """Executor and progress, while the file is computed; what fails then has a message of its own."""
        from vibro_sweep.driver.compute import RunError
        from vibro_sweep.driver.progress import progress_bar
        from vibro_sweep.files.file_errors import StoreError

        workers_of_a_cluster = executor_of(self.scheduler)
        with input_errors(StoreError, *errors), interrupt.tidied_up():
            to_continue = self.advice("--resume")
            interrupt.advise(to_continue)
            try:
                if self.plot:
                    threading.Thread(target=_import_drawing).start()
                else:
                    all_is_imported()
                bar = progress_bar(self.quiet)
                with messages(self.quiet), workers_of_a_cluster as executor, bar as progress:
                    if executor is not None:
                        simd.FREE.set()  # others compile and compute
                    yield executor, progress
            except RunError as error:
                if error.internal:
                    raise
                raise InputError(f"{error}. Nothing that was computed is lost; {to_continue}") from None
            finally:
                simd.FREE.set()


def _import_drawing() -> None:
    """Import what draws while LLVM optimises kernels, or these run: both leave the interpreter free, and numba, which
    takes as long, does not."""
    simd.FREE.wait()
    with suppress(Exception):  # the import by the thread that draws says what is wrong
        from vibro_sweep.plotting import plot  # noqa: F401
    all_is_imported()


def compute(computation: Computation, scene) -> bool:
    """Compute a scene and print what its file holds. Returns whether some points have a bad status."""
    from vibro_sweep.driver import run
    from vibro_sweep.scene import Scene

    of_sweep = isinstance(scene, Scene)
    with computation.under_way(ValueError) as (executor, progress):
        tell = progress and _described_first(scene, progress)
        report = run.run(scene, computation.output, computation.workers, executor, tell, computation.mode)
    if of_sweep and not computation.quiet:
        from .summaries import advice_on, summary

        say(summary(computation.output, report, scene.settle))
        if advice := advice_on(scene):
            say(advice)
    elif not computation.quiet:
        say_tables(computation.output)
    return of_sweep and bool(report.bad)


def _described_first(scene, progress: Callable[[int, int], None]) -> Callable[[int, int], None]:
    """The progress of a run, before which it says what machine it computes; not where all is computed already."""
    said = False

    def tell(done: int, total: int) -> None:
        nonlocal said
        if not said and done < total:
            from .described_machine import description

            say("\n".join(description(scene)))
        said = True
        progress(done, total)

    return tell


def compute_windows(
    computation: Computation, file: Path, parameter: str | None, display: Display | None, as_json: bool
) -> None:
    """Compute the windows of a sweep's file and print their table."""
    from vibro_sweep.driver.windows import run_windows

    with computation.under_way(ValueError) as (executor, progress):
        run_windows(file, computation.output, parameter, computation.workers, executor, progress, computation.mode)
    if as_json:
        from vibro_sweep.files.file_errors import StoreError

        from .as_json import description_of

        with input_errors(StoreError):
            say(description_of(computation.output)[0])
    elif not computation.quiet:
        say_tables(computation.output, display)


def say_tables(output: Path, display: Display | None = None) -> None:
    """Print what a file of branches, curves or windows holds; of a long table the beginning and the end."""
    from .info import tables

    lines = tables(output, display)
    left_out = len(lines) - FIRST - LAST
    if left_out > 0:
        lines[FIRST:-LAST] = [f"  ... {left_out:,} lines more: vibro-sweep info {shlex.quote(str(output))}"]
    say("\n".join([f"{output}", *lines]))
