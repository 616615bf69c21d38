"""The command line, called within this process: what it prints, and its exit status."""

import gc
import io
import signal
import sys
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from unittest.mock import patch

from vibro_sweep.__main__ import program


def called(*arguments) -> tuple[int, str, str]:
    """Exit status, and what goes to stdout and stderr."""
    out, errors = (io.TextIOWrapper(io.BytesIO(), encoding="utf-8", write_through=True) for _ in range(2))
    words = ["vibro-sweep", *map(str, arguments)]
    with _restored(), patch.object(sys, "argv", words), redirect_stdout(out), redirect_stderr(errors):
        try:
            program()
        except SystemExit as end:
            status = end.code or 0
    return status, *(stream.buffer.getvalue().decode() for stream in (out, errors))


@contextmanager
def _restored():
    """What a program changes of its process is as it was."""
    interrupt, collects = signal.getsignal(signal.SIGINT), gc.isenabled()
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, interrupt)
        (gc.enable if collects else gc.disable)()
