"""Linear algebra of small matrices on one thread: several take many times longer beside other work."""

import functools
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from threadpoolctl import ThreadpoolController

_lock = threading.Lock()
_inside, _limit = 0, None  # callers within, and what gives the threads back


@contextmanager
def one_thread() -> Iterator[None]:
    """One thread for BLAS in this process as long as any caller is within; also as a decorator."""
    global _inside, _limit
    with _lock:
        if _inside == 0:
            _limit = _libraries().limit(limits=1, user_api="blas")
        _inside += 1
    try:
        yield
    finally:
        with _lock:
            _inside -= 1
            if _inside == 0:
                _limit.restore_original_limits()


@functools.cache
def _libraries() -> ThreadpoolController:
    return ThreadpoolController()
