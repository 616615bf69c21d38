"""Ctrl-C during long computations.

Python answers it in the main thread, and not while compiled code runs there. So what takes long runs in another thread,
for which the main thread waits. Kernels look at a number now and then (`motion/ensemble.py`), as the compiler does, and
end where it is not 0: their results are `not_computed` then.
"""

import contextlib
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor, wait
from typing import TypeVar

import numpy as np

LONG = 10**6  # cells, in which orbits strike about once: less than half a second, for which a thread is not worth it
PATIENCE = 0.1  # seconds after which Python sees a signal in any case: not all systems wake a thread that waits

T = TypeVar("T")
_thread = threading.local()


def new_halt() -> np.ndarray:
    """(1,): the number that kernels look at."""
    return np.zeros(1, np.int64)


def heed(halt: np.ndarray) -> None:
    """Let this thread's kernels, and the compiler, end where `halt` (1,) is not 0."""
    _thread.halt = halt


def halt_of_thread() -> np.ndarray:
    """(1,): the one that it heeds, or a new one."""
    return getattr(_thread, "halt", new_halt())


def interruptible(function: Callable[..., T], *arguments, halt: np.ndarray | None = None, cells: float = np.inf) -> T:
    """The result of a function, which ends soon when Ctrl-C, or another exception, ends the wait for it.

    halt : (1,), of workspaces that it uses and were made before. cells : over how many it carries orbits; a function
        with few is simply called
    """
    if cells < LONG or threading.current_thread() is not threading.main_thread():
        return function(*arguments)
    halt = new_halt() if halt is None else halt
    pool = ThreadPoolExecutor(1, initializer=heed, initargs=(halt,))
    try:
        future = pool.submit(function, *arguments)
        while not future.done():
            wait([future], timeout=PATIENCE)
        return future.result()
    except BaseException:
        halt[0] = 1
        raise
    finally:
        pool.shutdown(wait=False)


class _Interrupt:
    """Answers Ctrl-C as Python does, and knows that it came."""

    came = False

    def __call__(self, *_) -> None:
        self.came = True
        raise KeyboardInterrupt


@contextlib.contextmanager
def heard() -> Iterator[None]:
    """While something is compiled: LLVM calls Python back, where exceptions are lost, that of Ctrl-C too."""
    if getattr(_thread, "halt", (0,))[0] != 0:
        raise KeyboardInterrupt
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.getsignal(signal.SIGINT)
    handler = before if isinstance(before, _Interrupt) else _Interrupt()
    if before is signal.default_int_handler:
        signal.signal(signal.SIGINT, handler)
    try:
        yield
    finally:
        if before is signal.default_int_handler:
            signal.signal(signal.SIGINT, before)
    if handler.came:
        raise KeyboardInterrupt
