"""The program `vibro-sweep` in this process, and any program of Python on a terminal."""

import contextlib
import gc
import io
import os
import pty
import signal
import subprocess
import sys
from typing import NamedTuple
from unittest import mock

from vibro_sweep.__main__ import program


class Ended(NamedTuple):
    """The exit status of a program, and what it printed."""

    status: int
    out: str
    err: str


def main(arguments) -> int:
    """Run the program, which prints as it does; its exit status."""
    end = ended(*arguments)
    sys.stdout.write(end.out)
    sys.stderr.write(end.err)
    return end.status


def ended(*arguments) -> Ended:
    """Run the program with these arguments."""
    out, err = _stream(), _stream()
    with contextlib.ExitStack() as stack:
        stack.enter_context(mock.patch.object(sys, "argv", ["vibro-sweep", *map(str, arguments)]))
        stack.enter_context(contextlib.redirect_stdout(out))
        stack.enter_context(contextlib.redirect_stderr(err))
        # What the program does to a process of its own would last: garbage that is kept, and another answer to Ctrl-C.
        for name in ("disable", "freeze"):
            stack.enter_context(mock.patch.object(gc, name))
        stack.enter_context(mock.patch.object(sys, "unraisablehook"))
        stack.enter_context(mock.patch.object(os, "_exit", sys.exit))  # after Ctrl-C
        stack.callback(signal.signal, signal.SIGINT, signal.getsignal(signal.SIGINT))
        try:
            program()
        except SystemExit as end:
            return Ended(end.code or 0, _text(out), _text(err))
    raise AssertionError("the program did not end")


def on_a_terminal(*arguments) -> bytes:
    """What Python with these arguments shows where its errors are a terminal; it ends well."""
    ours, theirs = pty.openpty()
    command, shown = [sys.executable, *arguments], b""
    with subprocess.Popen(
        command, stdin=theirs, stdout=subprocess.DEVNULL, stderr=theirs, env=os.environ | {"TERM": "xterm"}
    ) as process:
        os.close(theirs)
        with contextlib.suppress(OSError):  # when the other end is closed
            while read := os.read(ours, 4096):
                shown += read
    os.close(ours)
    assert process.returncode == 0, shown
    return shown


def _stream() -> io.TextIOWrapper:
    return io.TextIOWrapper(io.BytesIO(), encoding="utf-8", write_through=True)


def _text(stream: io.TextIOWrapper) -> str:
    return stream.buffer.getvalue().decode()
