"""What holds for all tests."""

import os
import signal

import pytest

pytest.register_assert_rewrite("support")

from support.branches import one_sided_branch, symmetric_branch  # noqa: E402, F401
from support.cli import scene_folder  # noqa: E402, F401
from support.files import files, folder  # noqa: E402, F401
from support.pictures import branches, plane, sweep, trajectory  # noqa: E402, F401

# Programs that tests start import the package that is tested, and not one in the current folder.
os.environ["PYTHONSAFEPATH"] = "1"

# A job in the background is born deaf to Ctrl-C, and so would be the programs that tests start and interrupt.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def path(tmp_path):
    """Of the file that a run is to make."""
    return tmp_path / "out.h5"
