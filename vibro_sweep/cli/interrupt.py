"""Ctrl-C: the program ends at once, or puts things in order first; the message and the status are the same.

Python makes of it an exception wherever the main thread is. In the middle of an import, or of a destructor, such an
exception may be lost, or come out as another one. So the program ends on the spot, which does no harm, as no kill does
(docs/development/stored_results.md). Only where something is left to be tidied up (a hidden file, the workers of a
cluster, the cursor of the terminal) there is the exception, once; where it is lost, the program still ends.
"""

import contextlib
import os
import signal
import sys
import threading
from collections.abc import Iterator

from .console import INTERRUPTED, print_error

TIDYING = 10.0  # seconds after which it is given up; LLVM may be in one call for half as long


class _Handler:
    def __init__(self):
        self.text = "interrupted"
        self.tidy = False  # whether something is to be tidied up
        self.came = False  # a second one would only disturb that

    def __call__(self, *_) -> None:
        if not (self.tidy or self.came):
            self.end()
        if not self.came:
            self.came = True
            watch = threading.Timer(TIDYING, self.end)
            watch.daemon = True
            watch.start()
            raise KeyboardInterrupt

    def end(self) -> None:
        with contextlib.suppress(OSError):  # Python's streams may be in the middle of a line
            os.write(2, f"vibro-sweep: {self.text}\n".encode(errors="backslashreplace"))
        os._exit(INTERRUPTED)

    def lost(self, raised) -> None:
        """For exceptions in destructors, which Python otherwise reports and forgets."""
        if issubclass(raised.exc_type, KeyboardInterrupt):
            self.end()
        sys.__unraisablehook__(raised)


_handler = _Handler()


def install() -> None:
    """Unless Ctrl-C is ignored, as in a job in the background of a shell."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _handler)
        sys.unraisablehook = _handler.lost


def advise(advice: str) -> None:
    """Set the advice that an interrupt prints from now on."""
    _handler.text = f"interrupted; {advice}"


@contextlib.contextmanager
def tidied_up() -> Iterator[None]:
    """Within, Ctrl-C unwinds; it ends the program when this is left."""
    try:
        _handler.tidy = True
        yield
    except KeyboardInterrupt:
        print_error(_handler.text)
        raise SystemExit(INTERRUPTED) from None
    finally:
        _handler.tidy = False
