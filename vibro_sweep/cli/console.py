"""What holds for every command: its streams, messages of the package, and how the program ends."""

import contextlib
import gc
import logging
import os
import re
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from vibro_sweep.engine import simd
from vibro_sweep.tables.outcomes import Outcome

LONGEST_WORD = 300  # letters of what stands on a command line, in a message

BAD_POINTS, BAD_INPUT, INTERNAL, INTERRUPTED = 1, 2, 70, 130

EXIT_STATUSES = (
    Outcome("0", "done"),
    Outcome(
        f"{BAD_POINTS}",
        "done, but some points have a bad status",
        "The summary counts them by status and says what to do. The other points are valid.",
    ),
    Outcome(
        f"{BAD_INPUT}",
        "the input is wrong, or the machine cannot do what is needed",
        "The message names the key or the file, the value and what is allowed.",
    ),
    Outcome(f"{INTERNAL}", "an internal error, which is a bug", "Please report the traceback below the message."),
    Outcome(
        f"{INTERRUPTED}",
        "interrupted, also while the program is still loading or compiling",
        "`--resume` continues. A second Ctrl-C changes nothing.",
    ),
)


class InputError(ValueError):
    """The command line asks for something that cannot be done."""


def prepare_process() -> None:
    """Streams that exist and take any text, before anything else is done.

    A closed stream becomes one that nobody reads: its descriptor would else go to the next file that is opened, and
    messages of C libraries into that file.
    """
    for descriptor in (0, 1, 2):
        try:
            os.fstat(descriptor)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free
    sys.stdout = sys.stdout or open(1, "w", closefd=False)  # for as long as the process lasts
    sys.stderr = sys.stderr or open(2, "w", closefd=False)
    sys.stdout.reconfigure(errors="backslashreplace")  # names of files need not be UTF-8


def all_is_imported() -> None:
    """The search for garbage begins, and leaves out what is there already: modules stay as long as the process.

    `program` puts it off until then: while hundreds of thousands of objects are imported, of which none is garbage,
    Python would look through all of them several times, which takes a tenth of a start.
    """
    if not gc.isenabled():
        simd.OWN_PROCESS = True
        gc.freeze()
        gc.enable()


def ended(command: Callable[[], None]) -> int:
    """The exit status of a command, which ends itself or is ended by an error."""
    try:
        command()
    except SystemExit as stop:
        return stop.code or 0
    except (OSError, InputError) as error:
        return _refused(error)
    except Exception as error:
        print_error(f"internal error, a bug of this program; please report it: {type(error).__name__}: {error}")
        with contextlib.suppress(OSError):
            traceback.print_exc()
        return INTERNAL
    return 0


@contextlib.contextmanager
def input_errors(*kinds: type[Exception]) -> Iterator[None]:
    """End errors that the user can mend in one message and status 2; others are bugs."""
    try:
        yield
    except (InputError, OSError, MemoryError, *kinds) as error:
        if getattr(error, "internal", False):
            raise
        raise SystemExit(_refused(error)) from None


def each_of(files: Iterable[Path], command: Callable[[Path], None]) -> None:
    """Run a command of each file, also after one that it has refused, which is the status of all then."""
    refused = False
    for file in files:
        try:
            command(file)
        except SystemExit as end:
            if end.code != BAD_INPUT:  # as after Ctrl-C
                raise
            refused = True
    if refused:
        raise SystemExit(BAD_INPUT)


def _refused(error: Exception) -> int:
    from vibro_sweep.checks.refusals import cut  # `--help` must not wait for numpy

    text = str(error) or ("not enough memory" if isinstance(error, MemoryError) else type(error).__name__)
    if isinstance(error, OSError) and error.filename is not None and error.strerror:
        text = f"{error.filename}: {error.strerror}"
    for name in ("output", "resume", "overwrite"):  # in Python an argument, here an option
        text = text.replace(f"`{name}`", f"--{name}")
    text = re.sub(rf"\S{{{LONGEST_WORD},}}", lambda word: cut(word[0]), text)
    print_error(f"error: {text}")
    return BAD_INPUT


def print_error(text: str) -> None:
    """A message on stderr, which need not take it."""
    with contextlib.suppress(OSError):
        print(f"vibro-sweep: {text}", file=sys.stderr, flush=True)


def say(text: str) -> None:
    """Print a result. Raises InputError where it cannot be written; whoever closes a pipe has read enough."""
    try:
        print(text, flush=True)
    except BrokenPipeError:
        _stop_writing()
    except OSError as error:
        _stop_writing()
        raise InputError(f"the standard output: {error.strerror}") from None


def _stop_writing() -> None:
    """What is left in the buffer would fail again at the end of the process."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@contextlib.contextmanager
def messages(quiet: bool) -> Iterator[None]:
    """Show what the package has to say meanwhile: warnings, and unless quiet what it is about to do."""
    logger, handler = logging.getLogger("vibro_sweep"), _Printer()
    before, propagate = logger.level, logger.propagate
    logger.setLevel(logging.WARNING if quiet else logging.INFO)
    logger.propagate = False
    logger.addHandler(handler)
    try:
        yield
    finally:
        logger.removeHandler(handler)
        logger.setLevel(before)
        logger.propagate = propagate


class _Printer(logging.Handler):
    def emit(self, record: logging.LogRecord) -> None:
        level = "" if record.levelno < logging.WARNING else f"{record.levelname.lower()}: "
        print_error(level + record.getMessage())
