"""pytest for mutations.py, in a process of its own: all tests, to see what each calls, or chosen ones up to a failure.

python chosen_tests.py ORDER OUT: ORDER is a file with the names of tests, the minutes for them and their mark; OUT gets
the last that was begun, and whether it fails. Without names all of that mark are run, and OUT gets what they call.
"""

import json
import math
import signal
import sys
import threading
import time
from pathlib import Path

import pytest

LONGEST = 200, 900  # seconds of a test: of computing, and in all


class Tests:
    """Of pytest: runs the chosen tests in their order, and writes which is run and which failed; or what all call."""

    def __init__(self, chosen: list[str] | None, minutes: float, out: Path):
        self.chosen, self.out, self.end = chosen, out, time.time() + 60 * (minutes or math.inf)
        self.calls, self.tests, self.failed = set(), {}, set()

    @pytest.hookimpl(hookwrapper=True, tryfirst=True)
    def pytest_collection_modifyitems(self, items):
        yield
        if self.chosen is not None:
            found = {item.nodeid: item for item in items}
            items[:] = [found[name] for name in self.chosen if name in found]

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_protocol(self, item):
        signal.setitimer(signal.ITIMER_PROF, LONGEST[0])
        signal.alarm(LONGEST[1])
        if self.chosen is not None:
            self.out.write_text(f"runs {item.nodeid}")
            item.session.shouldstop = time.time() > self.end and "no more time"
        self.calls.clear()
        trace, begun = self.called if self.chosen is None else None, time.perf_counter()
        sys.settrace(trace)
        threading.settrace(trace)
        yield
        sys.settrace(None)
        own, calls = (
            f"{Path.cwd()}/vibro_sweep/",
            {(code.co_filename, code.co_firstlineno, k) for code, k in self.calls},
        )
        calls = [f"vibro_sweep/{file[len(own) :]}:{row}{k}" for file, row, k in sorted(calls) if file.startswith(own)]
        self.tests[item.nodeid] = {"seconds": round(time.perf_counter() - begun, 3), "calls": calls}

    def called(self, frame, event, argument):
        """Of `sys.settrace`. A kernel is called by `exported.__call__`."""
        own = frame.f_locals.get("self") if frame.f_code.co_name == "__call__" else None
        self.calls.add(
            (own.__wrapped__.__code__, " kernel") if type(own).__name__ == "exported" else (frame.f_code, "")
        )

    def pytest_runtest_logreport(self, report):
        if report.failed and self.chosen is not None:
            self.out.write_text(f"fails {report.nodeid}")
        elif report.failed:
            self.failed.add(report.nodeid)

    def pytest_sessionfinish(self):
        if self.chosen is None:
            self.out.write_text(json.dumps({name: t for name, t in self.tests.items() if name not in self.failed}))


if __name__ == "__main__":
    order, out = map(Path, sys.argv[1:])
    chosen, minutes, mark = json.loads(order.read_text())
    files = sorted({name.partition("::")[0] for name in chosen or ["tests"]})
    common = ["-q", "-n", "0", "-m", mark, "-p", "no:cacheprovider", *["-x"] * (chosen is not None)]
    sys.exit(pytest.main([*common, *files], [Tests(chosen, minutes, out)]))
