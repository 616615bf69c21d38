"""What holds for all tests."""

import signal

import pytest

pytest.register_assert_rewrite("support")

from support.files import files, folder  # noqa: E402, F401

# A job in the background is born deaf to Ctrl-C, and so would be the programs that tests start and interrupt.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
