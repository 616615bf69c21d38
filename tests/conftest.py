"""What holds for all tests."""

import gc
import logging
import os
import re
import signal
import sys
from collections import Counter

import pytest

# Each of several workers has a core of its own: threads of numpy's BLAS would take it from the others. It is read when
# numpy is loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

pytest.register_assert_rewrite("support")

from support.branches import one_sided_branch, symmetric_branch  # noqa: E402, F401
from support.cli import scene_folder  # noqa: E402, F401
from support.files import files, folder  # noqa: E402, F401
from support.kinds_of_files import kinds  # noqa: E402, F401

# Programs that tests start import the package that is tested, and not one in the current folder.
os.environ["PYTHONSAFEPATH"] = "1"

# They keep the package's bytecode, and so do workers, or each of them would compile it again.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

# A job in the background is born deaf to Ctrl-C, and so would be the programs that tests start and interrupt.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# Two workers begin with these. One compiles the kernels of any oscillator of two masses and of the paper's, then those
# of orbits and branches of one mass; the other those of compliant stops, then those of branches of two masses. With the
# same kernels to compile, both would do so at the same moment.
FIRST = [
    f"test_{name}.py"
    for name in (
        *("any_oscillator", "compliant_stops", "compliant_orbits", "system", "continuation", "discontinuity", "models"),
        *("energy", "energy_of_stops", "from_python"),
    )
]


EXPECTED_SKIPS = (
    "no chromium here",
    "no firefox here",
    "no network namespace here",
    "cannot be mounted here",
)  # of a machine for tests


class KernelLog(logging.Handler):
    """Which test has compiled which kernel, in how many seconds."""

    def __init__(self):
        super().__init__(logging.INFO)
        self.compiled: list[tuple[str, str, float]] = []

    def emit(self, record: logging.LogRecord) -> None:
        if isinstance(record.msg, str) and record.msg.startswith("compiled "):
            test = os.environ.get("PYTEST_CURRENT_TEST", "collection").partition(" (")[0]
            self.compiled.append((test, *record.args))


KERNELS = KernelLog()


def pytest_configure(config):
    """pytest-xdist takes the files in the order below, and not in one of its own."""
    config.option.loadscopereorder = False
    logging.getLogger("vibro_sweep").addHandler(KERNELS)


def pytest_sessionfinish(session):
    """A worker of pytest-xdist hands its kernels on to the process that prints them. Under CI a skip that is not
    expected fails."""
    if hasattr(session.config, "workeroutput"):
        session.config.workeroutput["kernels"] = KERNELS.compiled
    elif os.environ.get("CI") and unexpected_skips(session.config):
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node):
    KERNELS.compiled += getattr(node, "workeroutput", {}).get("kernels", [])


def pytest_terminal_summary(terminalreporter):
    """The kernels that tests have compiled, and skips that are not expected."""
    if KERNELS.compiled:
        total = sum(kernel[2] for kernel in KERNELS.compiled)
        terminalreporter.section(f"{len(KERNELS.compiled)} kernels compiled in {total:.0f} s")
        for test, kernel, seconds in sorted(KERNELS.compiled, key=lambda kernel: -kernel[2]):
            terminalreporter.write_line(f"{seconds:5.0f} s {kernel}, {test}")
    for line in unexpected_skips(terminalreporter.config):
        terminalreporter.write_line(line, red=True)


def unexpected_skips(config) -> list[str]:
    """Tests that were skipped for another reason than those of a machine without a browser or mounts."""
    reporter = config.pluginmanager.get_plugin("terminalreporter")
    skipped = [(report.nodeid, str(report.longrepr[-1])) for report in reporter.stats.get("skipped", [])]
    expected = re.compile("|".join(EXPECTED_SKIPS))
    return [f"not expected to be skipped: {test}: {why}" for test, why in skipped if not expected.search(why)]


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_collection_modifyitems(items):
    """Without slow tests: the files above come first, and then those with most tests, so that no worker is left with
    many in the end."""
    result, tests = (yield), Counter(item.path for item in items)

    def place(item):
        name = item.path.name
        return (FIRST.index(name), 0) if name in FIRST else (len(FIRST), -tests[item.path])

    items.sort(key=place)
    return result


def pytest_collection_finish():
    """Looking for garbage among all modules and tests each time would take some per cent of the time."""
    gc.freeze()


@pytest.fixture
def path(tmp_path):
    """Of the file that a run is to make."""
    return tmp_path / "out.h5"
