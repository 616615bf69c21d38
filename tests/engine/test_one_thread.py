"""Linear algebra on one thread, as long as anyone asks for it."""

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from vibro_sweep.analysis.periodic.one_thread import one_thread


def threads() -> list[int]:
    return [one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"]


def test_threads_come_back_when_the_last_caller_has_left():
    """Also by an exception."""
    np.ones((2, 2)) @ np.ones((2, 2))
    with threadpool_limits(2, "blas"):
        before = threads()
        with one_thread():
            with pytest.raises(ZeroDivisionError), one_thread():
                assert set(threads()) == {1}
                raise ZeroDivisionError
            assert set(threads()) == {1}
        assert threads() == before and 2 in before
